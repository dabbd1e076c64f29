// Layout of the page: cells of panels in columns, which follow the kind of system until the person changes them.
//
// layouts.js has the model, and what each kind opens with. On a phone one column is shown at a time, chosen at the bottom.

import { button, h, recall, remember } from "./dom.js";
import { emptyPage } from "./empty.js";
import { asked, facts, KINDS, kindOf, layoutOf, recalled, tabsOf } from "./layouts.js";
import { words } from "./words.js";

/** Drawings of a phone's pages, in a square of 24. */
const ICONS = {
  drive: "M12 3a9 9 0 1 0 0 18a9 9 0 1 0 0-18M12 7v10M7 12h10", world: "M4 20V8l8-5l8 5v12zM9 20v-6h6v6", topics: "M5 6h14M5 12h14M5 18h9", plot: "M4 4v16h16M7 15l4-5l3 3l5-7",
  log: "M4 5h16v14H4zM7 9l3 3l-3 3M13 15h4", images: "M4 6h16v13H4zM7 16l4-5l3 3l2-2l3 4M15 9h1", graph: "M4 9h5v6H4zM15 4h5v5h-5zM15 15h5v5h-5zM9 12h3M12 7v10M12 7h3M12 17h3",
};

const KEY = "robolink.layouts"; // what is remembered: layouts by kind, those of a phone below "phone.KIND"
const PHONE = "(max-width: 700px), (max-height: 480px)"; // as in style.css
const FIRST = 100, LOOK = 200, LOSS = 3000; // ms: until the first layout; how often the system is looked at; how long it must have less before panels go
const NARROWEST = 260, LOWEST = 150; // pixels: less is a strip
const ROOMY = 240, WIDE = 380; // pixels of the cell, and of the column, that a new panel is given

export class Layout {
  /** @param main element that holds the panels  @param app given to each panel */
  constructor(main, app) {
    Object.assign(this, { main, app, shown: new Map(), elements: new Map(), page: 0, key: "", own: "", changed: false });
    this.model = { columns: [] };
    this.pages = h("nav", { class: "tabs", "aria-label": words("pages") });
    this.small = matchMedia(PHONE);
    import("./panels/world.js").catch(() => {}); // most systems open with it: its files come while the kind is found out
    this.small.addEventListener("change", () => this._follow(performance.now(), 0));
  }

  /** Let each panel that is seen draw what is new. */
  frame(now) {
    if (!(now - this._looked < (this.key ? LOOK : 0))) {
      this._looked = now;
      this._follow(now);
    }
    for (const { panel, element } of this.shown.values()) {
      if (element.hidden) continue;
      try {
        panel?.frame?.(now);
      } catch (error) { // one panel's mistake is not the others'
        console.error(error);
      }
    }
  }

  get isPhone() { return this.small.matches; }

  /** True once all panels that are seen have been loaded. */
  get isReady() { return this.key !== "" && [...this.shown.values()].every(({ panel, failed }) => panel || failed); }

  /** Kind of system whose layout is shown; "#..." where the address asks for panels. */
  get kind() { return kindOnly(this.key); }

  /** The first panel of a name, or undefined. */
  panel(id) { return [...this.shown].find(([tab]) => tab.id === id)?.[1].panel; }

  /** True if a panel of a name is there, loaded or not. */
  has(id) { return tabsOf(this.model).some((tab) => tab.id === id); }

  /** Remember the layout and the panels' options. */
  save() {
    if (!this.key) return;
    for (const [tab, { panel }] of this.shown) tab.options = { ...tab.options, ...panel?.save?.() };
    remember(KEY, { ...recall(KEY), [this.key]: { changed: this.changed, ...this.model } });
  }

  /**
   * Show the first panel of a name; it is added if there is none. One that was never seen gets its options through
   * `change`. Returns its element, and a promise of its panel.
   */
  open(id, change = (options) => options, withKeyboard = true) {
    const find = () => tabsOf(this.model).find((each) => each.id === id), tab = find() ?? (this.add(id, change({})), find());
    if (!this.shown.has(tab)) tab.options = change(tab.options);
    this._reveal(tab, withKeyboard);
    return this.shown.get(tab);
  }

  /** Add a panel: as a column or a cell of its own where there is room, else as a tab. */
  add(id, options = {}) {
    const tab = { id, options };
    this._place(tab);
    this._build();
    this._reveal(tab);
    this._changed();
  }

  /** Go back to what the kind of system opens with. */
  reset() {
    const { [this.key]: _, ...others } = recall(KEY);
    remember(KEY, others);
    for (const tab of [...this.shown.keys()]) this._close(tab);
    this.key = "";
    this.model = { columns: [] };
    this._follow(performance.now(), 0);
  }

  /** Remove what a phone's page has below. */
  removeLast() {
    const { tabs, current } = this.model.columns[this.page].cells.at(-1);
    this._remove(tabs[current]);
  }

  /** Go to a panel by its number. */
  focus(index) { if (tabsOf(this.model)[index]) this._reveal(tabsOf(this.model)[index]); }

  /** Build all panels anew: the language is another. */
  rebuild() {
    this.save();
    for (const tab of [...this.shown.keys()]) this._close(tab);
    this._build();
  }

  /** Look which kind of system runs; change the layout when another has been there for some time: at once if it has more. */
  _follow(now, patience = this.key ? LOOK : FIRST) {
    if (!this.app.connection.isOpen) return;
    const found = facts(this.app), model = asked(location.hash), kind = model ? location.hash : kindOf(found);
    const own = model ?? layoutOf(kind, found, this.isPhone), key = (this.isPhone ? "phone." : "") + kind, text = key + JSON.stringify(own);
    if (text === this.own) this._next = text;
    else if (text !== this._next) Object.assign(this, { _next: text, _since: now });
    const less = KINDS.indexOf(kind) < KINDS.indexOf(this.kind) || (kind === this.kind && text.length < this.own.length);
    const stays = this.touched && key.startsWith("phone.") === this.key.startsWith("phone.") && (kind !== "empty" || this.kind === "empty");
    if (this.key && (text === this.own || stays)) return; // what the person has just changed stays until all has gone
    if (now - this._since < (patience && less && this.key ? LOSS : patience)) return;
    this.own = text;
    if (key !== this.key || !this.changed) this._change(key, own);
  }

  /** Change to the layout of another kind: panels that it has, too, stay as they are. */
  _change(key, own) {
    this.save();
    const kept = recall(KEY)[key], model = recalled(kept, own), left = [...this.shown.keys()];
    Object.assign(this, { key, changed: Boolean(kept?.changed), touched: false, page: 0 });
    for (const column of model.columns) {
      for (const cell of column.cells) {
        cell.tabs = cell.tabs.map((tab) => {
          const options = JSON.stringify(tab.options), isPlain = options === (tab.given ?? "{}");
          const fits = (each) => isPlain || options === this.shown.get(each).began || options === JSON.stringify(each.options);
          const at = left.findIndex((each) => each.id === tab.id && each.given === tab.given && fits(each));
          return at < 0 ? tab : left.splice(at, 1)[0];
        });
      }
    }
    for (const tab of left) this._close(tab);
    document.body.dataset.kind = kindOnly(key);
    if (!this.main.children.length || JSON.stringify(model) !== JSON.stringify(this.model)) { // else what one is in the middle of goes on
      this.model = model;
      this._build();
    }
    this.save();
  }

  _changed() {
    this.changed = this.touched = true;
    this.save();
  }

  _place(tab) {
    const { columns } = this.model, cell = { height: 50, current: 0, tabs: [tab] }, last = columns.at(-1);
    const sum = columns.reduce((total, { width }) => total + width, 0), fits = this.main.clientWidth / (columns.length + 1) >= WIDE;
    if (!last || this.isPhone) columns.push({ width: sum || 100, cells: [cell] });
    else if (columns.length === 1 && fits) columns.push({ width: sum * 0.6, cells: [cell] });
    else if (this.main.clientHeight / (last.cells.length + 1) >= ROOMY) {
      cell.height = last.cells.reduce((total, { height }) => total + height, 0) / last.cells.length;
      last.cells.push(cell);
    } else last.cells.at(-1).tabs.push(tab);
  }

  _build() {
    const { columns } = this.model, held = document.activeElement;
    this.elements.clear();
    this.main.replaceChildren();
    this.main.classList.remove("single");
    columns.forEach((column, i) => {
      if (i) this.main.append(this._splitter(column, i));
      const element = h("div", { class: "column" });
      element.style.flexGrow = column.width;
      column.cells.forEach((cell, k) => {
        if (k) element.append(this._divider(column, k, element));
        element.append(this._cell(cell));
      });
      this.main.append(element);
    });
    if (!columns.length) this.main.append(this.kind === "empty" ? emptyPage(this.app) : h("p", { class: "empty" }, words("empty")));
    this._pages();
    if (this.main.contains(held)) held.focus();
  }

  /** Buttons of a phone: one for each column. */
  _pages() {
    const { columns } = this.model;
    this.pages.replaceChildren(...columns.map((column, i) => {
      const name = pageName(column), element = button("", words(`panel.${name}`), () => this._turn(i));
      element.append(icon(ICONS[name] ?? "M5 5h14v14H5z"), words(`panel.${name}`));
      return element;
    }));
    this.main.append(this.pages);
    this._turn(Math.min(this.page, columns.length - 1));
  }

  _turn(page) {
    this.page = Math.max(0, page);
    [...this.main.querySelectorAll(":scope > .column")].forEach((each, i) => each.classList.toggle("current", i === this.page));
    [...this.pages.children].forEach((each, i) => { each.ariaPressed = String(i === this.page); });
  }

  _cellOf(tab) { return this.model.columns.flatMap(({ cells }) => cells).find(({ tabs }) => tabs.includes(tab)); }

  /** Show a tab, and by default give it the keyboard. */
  _reveal(tab, withKeyboard = true) {
    const cell = this._cellOf(tab);
    this._turn(this.model.columns.findIndex(({ cells }) => cells.includes(cell)));
    this._select(cell, cell.tabs.indexOf(tab));
    if (withKeyboard) this.shown.get(tab).element.focus();
  }

  _cell(cell) {
    const element = h("div", { class: cell.tabs.length > 1 ? "cell many" : "cell" }), now = () => cell.tabs[cell.current];
    element.style.flexGrow = cell.height;
    const tabs = cell.tabs.map((tab, i) => h("button", { type: "button", role: "tab", draggable: true, "data-tab": tab.id,
      onclick: () => this._select(cell, i), ondragstart: () => { this.dragged = tab; }, ondragend: () => { this.dragged = null; } }, words(`panel.${tab.id}`)));
    element.append(h("div", { class: "bar" }, h("div", { role: "tablist", onkeydown: (event) => this._key(event, cell) }, ...tabs), h("span", { class: "gap" }),
      button("⤢", words("panel.bigger"), () => this._bigger(element)), button("⇄", words("panel.move"), () => this._move(now())), button("✕", words("panel.remove"), () => this._remove(now()))));
    element.addEventListener("dragover", (event) => { if (this.dragged) event.preventDefault(); });
    element.addEventListener("drop", () => this._drop(cell));
    this.elements.set(cell, element);
    this._select(cell, Math.min(cell.current, cell.tabs.length - 1));
    return element;
  }

  /** Show a tab of a cell. A panel is loaded when it is first seen. */
  _select(cell, current) {
    const element = this.elements.get(cell);
    cell.current = current;
    element.querySelectorAll("[role=tab]").forEach((each, i) => {
      each.ariaSelected = String(i === current);
      each.tabIndex = i === current ? 0 : -1;
      if (i === current) each.scrollIntoView({ block: "nearest", inline: "nearest" });
    });
    cell.tabs.forEach((tab, i) => {
      if (i === current && !this.shown.has(tab)) this.shown.set(tab, this._open(tab));
      const panel = this.shown.get(tab)?.element;
      if (!panel) return;
      panel.hidden = i !== current;
      if (panel.parentElement !== element) element.append(panel);
    });
  }

  _key(event, cell) {
    const count = cell.tabs.length, step = { ArrowRight: 1, ArrowLeft: count - 1 }[event.key];
    if (event.key === "Delete") this._remove(cell.tabs[cell.current]);
    else if (step) this._select(cell, (cell.current + step) % count);
    else return;
    event.preventDefault();
    this.elements.get(cell)?.querySelector("[aria-selected=true]").focus();
  }

  _open(tab) {
    const title = words(`panel.${tab.id}`), body = h("div", { class: "body" }, h("p", { class: "dim" }, words("loading")));
    const element = h("section", { class: `panel panel-${tab.id}`, tabIndex: -1, role: "tabpanel", "aria-label": title, "data-panel": tab.id }, body);
    const shown = { element, panel: null, closed: false, began: JSON.stringify(tab.options) };
    shown.loaded = import(`./panels/${tab.id}.js`).then(({ panel }) => {
      if (shown.closed) return;
      body.replaceChildren();
      shown.panel = panel.create(body, this.app, tab.options);
    }).catch((error) => {
      shown.failed = true;
      console.error(error);
      body.replaceChildren(h("p", { class: "error" }, `${error}`));
    });
    return shown;
  }

  _close(tab) {
    const shown = this.shown.get(tab);
    if (!shown) return;
    shown.closed = true;
    shown.panel?.close();
    shown.element.remove();
    this.shown.delete(tab);
  }

  _remove(tab) {
    this._take(tab);
    this._close(tab);
    this._tidied();
  }

  /** Move a panel to the next column; from the last one into a column of its own, or to the first. */
  _move(tab) {
    const { columns } = this.model, at = columns.findIndex(({ cells }) => cells.some(({ tabs }) => tabs.includes(tab)));
    const isAlone = tabsOf({ columns: [columns[at]] }).length === 1, made = { height: 50, current: 0, tabs: [tab] };
    this._take(tab);
    if (at + 1 < columns.length) columns[at + 1].cells.push(made);
    else if (!isAlone) columns.push({ width: columns[at].width, cells: [made] });
    else columns[0].cells.push(made);
    this._tidied();
  }

  /** Put the tab that is dragged into a cell. */
  _drop(cell) {
    if (!this.dragged || cell.tabs.includes(this.dragged)) return;
    this._take(this.dragged);
    cell.current = cell.tabs.push(this.dragged) - 1;
    this._tidied();
  }

  _take(tab) {
    const cell = this._cellOf(tab);
    cell.tabs = cell.tabs.filter((each) => each !== tab);
    cell.current = Math.max(0, Math.min(cell.current, cell.tabs.length - 1));
  }

  _tidied() {
    for (const column of this.model.columns) column.cells = column.cells.filter(({ tabs }) => tabs.length);
    this.model.columns = this.model.columns.filter(({ cells }) => cells.length);
    this._changed();
    this._build();
  }

  _bigger(element) {
    const isSingle = this.main.classList.toggle("single");
    for (const each of this.elements.values()) each.classList.toggle("bigger", isSingle && each === element);
  }

  _splitter(column, i) {
    const { columns } = this.model, scale = () => this.main.clientWidth / columns.reduce((sum, each) => sum + each.width, 0);
    return splitter("vertical", NARROWEST, scale, () => [columns[i - 1].width, column.width], (before, after) => {
      [columns[i - 1].width, column.width] = [before, after];
      [...this.main.querySelectorAll(":scope > .column")].forEach((each, k) => { each.style.flexGrow = columns[k].width; });
    }, () => this._changed());
  }

  _divider({ cells }, k, element) {
    const scale = () => element.clientHeight / cells.reduce((sum, each) => sum + each.height, 0);
    return splitter("horizontal", LOWEST, scale, () => [cells[k - 1].height, cells[k].height], (before, after) => {
      [cells[k - 1].height, cells[k].height] = [before, after];
      for (const each of cells) this.elements.get(each).style.flexGrow = each.height;
    }, () => this._changed());
  }
}

function kindOnly(key) { return key.replace("phone.", ""); }

/** Name of a phone's page: that of its first panel, or "drive". */
function pageName({ cells }) {
  const ids = cells.flatMap(({ tabs }) => tabs.map(({ id }) => id));
  return ids.length > 1 && ids.includes("teleop") ? "drive" : ids[0];
}

function icon(d) {
  const [svg, path] = ["svg", "path"].map((tag) => document.createElementNS("http://www.w3.org/2000/svg", tag));
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.ariaHidden = "true";
  path.setAttribute("d", d);
  svg.append(path);
  return svg;
}

/** Bar between two parts: dragged by a pointer, or moved by arrow keys. `scale` is the pixels of a share, `least` those that each keeps. */
function splitter(orientation, least, scale, shares, change, done) {
  const element = h("div", { class: `splitter ${orientation}`, role: "separator", tabIndex: 0, "aria-orientation": orientation, "aria-label": words("layout.split") });
  const move = (pixels) => {
    const [before, after] = shares(), sum = before + after, edge = Math.min(least / scale(), sum / 2);
    const now = Math.min(Math.max(before + pixels / scale(), edge), sum - edge);
    change(now, sum - now);
  };
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  element.addEventListener("pointermove", (event) => {
    if (element.hasPointerCapture(event.pointerId)) move(orientation === "vertical" ? event.movementX : event.movementY);
  });
  element.addEventListener("pointerup", done);
  element.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -40, ArrowRight: 40, ArrowUp: -40, ArrowDown: 40 }[event.key];
    if (!step) return;
    event.preventDefault();
    move(step);
    done();
  });
  return element;
}
