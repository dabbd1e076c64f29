// Layout of the page: panels in columns, remembered by the browser; one panel at a time on a phone.
//
// The model is {columns: [{width, cells: [{id, height, options}]}]}; widths and heights are shares.

import { button, h } from "./dom.js";
import { words } from "./words.js";

/** Panels by name, in the order of the menu: the file is panels/NAME.js, its title the word "panel.NAME". */
export const PANELS = ["world", "topics", "plot", "log", "teleop", "services", "parameters", "images", "graph", "actions", "turtlesim", "learn"];

const DEFAULT = { columns: [{ width: 65, cells: [["world", 100]] }, { width: 35, cells: [["topics", 100]] }] };
const KEY = "robolink.layout";

function initial() {
  return { columns: DEFAULT.columns.map(({ width, cells }) => ({ width, cells: cells.map(([id, height]) => ({ id, height, options: {} })) })) };
}

/**
 * Layout with the panels that an address asks for by "#NAME+NAME:TOPIC": theirs alone if there is no other, else what
 * lacks comes first. A panel of one topic shows the one that is named.
 */
export function withAsked(model, hash) {
  const asked = hash.slice(1).split("+").map((each) => each.split(":")).filter(([id]) => PANELS.includes(id));
  const cells = (model ?? { columns: [] }).columns.flatMap((column) => column.cells), columns = [];
  for (const [id, topic] of asked) {
    let cell = cells.find((each) => each.id === id);
    if (!cell) columns.push({ width: columns.length ? 50 : 100, cells: [cell = { id, height: 100, options: {} }] });
    if (topic) cell.options = { ...cell.options, topic };
  }
  return { columns: [...columns, ...(model ?? (asked.length ? { columns: [] } : initial())).columns] };
}

/** Layout of text from the browser's memory; the default if there is none or it is nonsense. */
export function restored(text) {
  try {
    const { columns } = JSON.parse(text);
    const known = columns.map(({ width, cells }) => ({
      width: Number(width) || 50,
      cells: cells.filter(({ id }) => PANELS.includes(id)).map(({ id, height, options }) => ({ id, height: Number(height) || 50, options: options ?? {} })),
    }));
    return { columns: known.filter(({ cells }) => cells.length) };
  } catch {
    return initial();
  }
}

export class Layout {
  /** @param main element that holds the panels  @param app given to each panel */
  constructor(main, app) {
    this.main = main;
    this.app = app;
    const kept = localStorage.getItem(KEY);
    this.model = withAsked(kept ? restored(kept) : null, location.hash);
    this.shown = new Map(); // cell -> {element, panel}
    this.current = 0;
    this.tabs = h("nav", { class: "tabs", "aria-label": words("add") });
    this._build();
  }

  /** Let each panel draw what is new. */
  frame(now) {
    for (const { panel } of this.shown.values()) {
      try {
        panel?.frame?.(now);
      } catch (error) { // one panel's mistake is not the others'
        console.error(error);
      }
    }
  }

  /** True once all panels have been loaded. */
  get isReady() { return [...this.shown.values()].every(({ panel, failed }) => panel || failed); }

  /** The first panel of a name, or undefined. */
  panel(id) { return [...this.shown].find(([cell]) => cell.id === id)?.[1].panel; }

  /** True if a panel of a name is there, loaded or not. */
  has(id) { return this._cells().some((cell) => cell.id === id); }

  /** Remember the layout and the panels' options. */
  save() {
    for (const [cell, { panel }] of this.shown) cell.options = panel?.save?.() ?? cell.options;
    localStorage.setItem(KEY, JSON.stringify(this.model));
  }

  /** Add a panel: below the last one of the right column. */
  add(id, options = {}) {
    const { columns } = this.model;
    if (!columns.length) columns.push({ width: 100, cells: [] });
    const cells = columns[columns.length - 1].cells;
    const cell = { id, height: cells.length ? cells.reduce((sum, each) => sum + each.height, 0) / cells.length : 100, options };
    cells.push(cell);
    this.current = this._cells().length - 1;
    this._build();
    this.focus(this.current);
  }

  reset() {
    localStorage.removeItem(KEY);
    for (const shown of this.shown.values()) this._close(shown);
    this.shown.clear();
    this.model = initial();
    this.current = 0;
    this._build();
  }

  focus(index) {
    const cell = this._cells()[index];
    if (!cell) return;
    this._choose(index);
    this.shown.get(cell).element.focus();
  }

  rebuild() {
    this.save();
    for (const shown of this.shown.values()) this._close(shown);
    this.shown.clear();
    this._build();
  }

  _cells() { return this.model.columns.flatMap(({ cells }) => cells); }

  _build() {
    this.main.replaceChildren();
    this.model.columns.forEach((column, i) => {
      if (i) this.main.append(this._splitter(column, i));
      const element = h("div", { class: "column" });
      element.style.flexGrow = column.width;
      column.cells.forEach((cell, k) => {
        if (k) element.append(this._divider(column, k, element));
        element.append(this._cell(cell));
      });
      this.main.append(element);
    });
    if (!this.model.columns.length) this.main.append(h("p", { class: "empty" }, words("empty")));
    this._tabs();
    localStorage.setItem(KEY, JSON.stringify(this.model));
  }

  _tabs() {
    const cells = this._cells();
    this.tabs.replaceChildren(...cells.map((cell, i) => button(words(`panel.${cell.id}`), null, () => this._choose(i))));
    this.main.append(this.tabs);
    this._choose(Math.min(this.current, cells.length - 1));
  }

  _choose(index) {
    this.current = Math.max(0, index);
    this._cells().forEach((cell, i) => {
      this.shown.get(cell)?.element.classList.toggle("current", i === this.current);
      this.tabs.children[i]?.setAttribute("aria-pressed", i === this.current);
    });
  }

  _cell(cell) {
    let shown = this.shown.get(cell);
    if (!shown) {
      shown = this._open(cell);
      this.shown.set(cell, shown);
    }
    shown.element.style.flexGrow = cell.height;
    return shown.element;
  }

  _open(cell) {
    const title = words(`panel.${cell.id}`);
    const body = h("div", { class: "body" }, h("p", { class: "dim" }, words("loading")));
    const element = h("section", { class: `panel panel-${cell.id}`, tabIndex: -1, "aria-label": title, "data-panel": cell.id },
      h("div", { class: "bar" }, h("h2", {}, title), h("span", { class: "tools" }),
        button("⤢", words("panel.bigger"), () => this._bigger(element)),
        button("⇄", words("panel.move"), () => this._move(cell)),
        button("✕", words("panel.remove"), () => this._remove(cell))),
      body);
    const shown = { element, panel: null, closed: false };
    import(`./panels/${cell.id}.js`).then(({ panel }) => {
      if (shown.closed) return;
      body.replaceChildren();
      shown.panel = panel.create(body, this.app, cell.options);
    }).catch((error) => {
      shown.failed = true;
      console.error(error);
      body.replaceChildren(h("p", { class: "error" }, `${error}`));
    });
    return shown;
  }

  _close(shown) {
    shown.closed = true;
    shown.panel?.close();
  }

  _remove(cell) {
    this._close(this.shown.get(cell));
    this.shown.delete(cell);
    for (const column of this.model.columns) column.cells = column.cells.filter((each) => each !== cell);
    this._tidied();
  }

  /** Move a panel to the next column; from the last one into a column of its own, or to the first. */
  _move(cell) {
    const { columns } = this.model;
    const at = columns.findIndex(({ cells }) => cells.includes(cell));
    const alone = columns[at].cells.length === 1;
    columns[at].cells = columns[at].cells.filter((each) => each !== cell);
    if (at + 1 < columns.length) columns[at + 1].cells.push(cell);
    else if (!alone) columns.push({ width: columns[at].width, cells: [cell] });
    else columns[0].cells.push(cell);
    this._tidied();
  }

  _tidied() {
    this.model.columns = this.model.columns.filter(({ cells }) => cells.length);
    this._build();
  }

  _bigger(element) {
    this.main.classList.toggle("single");
    element.classList.toggle("bigger");
    if (!this.main.classList.contains("single")) for (const each of this.shown.values()) each.element.classList.remove("bigger");
  }

  _splitter(column, i) {
    return splitter("vertical", (share) => {
      const before = this.model.columns[i - 1], sum = before.width + column.width;
      before.width = Math.min(Math.max(share(before.width, sum), sum * 0.1), sum * 0.9);
      column.width = sum - before.width;
      [...this.main.querySelectorAll(".column")].forEach((each, k) => { each.style.flexGrow = this.model.columns[k].width; });
    }, () => this.main.clientWidth / this.model.columns.reduce((sum, each) => sum + each.width, 0), () => this.save());
  }

  _divider(column, k, element) {
    return splitter("horizontal", (share) => {
      const [before, after] = [column.cells[k - 1], column.cells[k]], sum = before.height + after.height;
      before.height = Math.min(Math.max(share(before.height, sum), sum * 0.1), sum * 0.9);
      after.height = sum - before.height;
      for (const each of [before, after]) this.shown.get(each).element.style.flexGrow = each.height;
    }, () => element.clientHeight / column.cells.reduce((sum, each) => sum + each.height, 0), () => this.save());
  }
}

/** Bar between two parts: dragged by a pointer, or moved by arrow keys. */
function splitter(orientation, change, pixels, done) {
  const upright = orientation === "vertical";
  const element = h("div", { class: `splitter ${orientation}`, role: "separator", tabIndex: 0, "aria-orientation": orientation });
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  element.addEventListener("pointermove", (event) => {
    if (!element.hasPointerCapture(event.pointerId)) return;
    const moved = (upright ? event.movementX : event.movementY) / pixels();
    change((share) => share + moved);
  });
  element.addEventListener("pointerup", done);
  element.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!steps) return;
    event.preventDefault();
    change((share, sum) => share + steps * sum * 0.05);
    done();
  });
  return element;
}
