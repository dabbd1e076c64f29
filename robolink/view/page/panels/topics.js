// Topics panel: type, rate, bandwidth, age and ends of each topic, and the tree of the latest message of one.

import { brief, button, fitted, h, widthOf } from "../dom.js";
import { short } from "../cdr.js";
import { Tree } from "./tree.js";

const COLUMNS = ["topic", "type", "rate", "bandwidth", "age", "publishers"];
const ROWS = 12; // rows that are written in one frame
const FIGURE = 50, PADDING = 12; // widths in pixels: of a column of figures, and beside a text
const NARROW = 440; // width in pixels below which names and types need the place of some figures
const TREE_RATE = 10; // Hz at which the latest message is read

class Topics {
  constructor(element, app, options) {
    this.app = app;
    this.filter = options.filter ?? "";
    this.sort = options.sort ?? "topic";
    this.down = options.down ?? false;
    this.rows = new Map();
    this.waiting = []; // topics whose rows are to be written
    this.element = element;
    this._build();
    this.offs = [app.store.on("change", () => { this.stale = true; }), app.store.on("statistics", () => { this.stale = true; })];
    this.stale = true;
    if (options.topic) this._choose(options.topic, options.open);
  }

  /** Options: the topic whose message is shown, and what of it is unfolded, as paths or true for all of it. */
  save() {
    const { filter, sort, down, tree } = this, topic = this.chosen?.topic.name;
    return { filter, sort, down, topic, open: topic && (tree.unfolds || [...tree.open]) };
  }

  close() {
    for (const off of this.offs) off();
    this.observer.disconnect();
    this.chosen?.close();
  }

  frame(now) {
    if (this.stale && this.width && !(now - this.listed < 200)) {
      this.listed = now;
      this.stale = false;
      this._list();
    }
    if (this.waiting.length) this._refresh();
    if (this.chosen && !(now - this.read < 1000 / TREE_RATE)) {
      this.read = now;
      this._show();
    }
  }

  _build() {
    const { words } = this.app;
    const search = h("input", { type: "search", placeholder: words("topics.filter"), "aria-label": words("topics.filter"), value: this.filter, oninput: () => { this.filter = search.value; this.stale = true; } });
    this.count = h("span", { class: "dim" });
    this.body = h("tbody");
    this.heads = COLUMNS.map((name) => h("th", { class: name }, button(words(`topics.${name}`), null, () => this._sort(name))));
    this.table = h("table", { class: "topics" }, h("thead", {}, h("tr", {}, ...this.heads)), this.body);
    const scroll = this.scroll = h("div", { class: "scroll", onscroll: () => { this.stale = true; } }, this.table);
    this.observer = new ResizeObserver(([{ contentRect }]) => { this.width = contentRect.width; this.stale = true; });
    this.observer.observe(scroll);
    this.tree = new Tree(words, (topic, path) => this.app.emit("pick", topic, path));
    this.tree.onchange = () => { this.seen = undefined; this.read = undefined; this.app.remember(); };
    this.title = h("h3");
    this.hint = h("p", { class: "dim" });
    this.detail = h("div", { class: "detail", hidden: true }, h("div", { class: "row" }, button("✕", words("topics.back"), () => this._choose(null)), this.title, this.hint), this.tree.element);
    this.element.append(h("div", { class: "row" }, search, this.count), scroll, this.detail);
  }

  _sort(name) {
    this.down = this.sort === name && !this.down;
    this.sort = name;
    this.stale = true;
    this.app.remember();
  }

  _list() {
    const wanted = this.filter.toLowerCase(), sign = this.down ? -1 : 1;
    const topics = this.app.store.list().filter(({ name, type }) => `${name} ${type}`.toLowerCase().includes(wanted));
    const key = (topic) => (this.sort === "topic" ? topic.name : this.sort === "type" ? topic.type : (topic.statistics?.[this.sort] ?? -1));
    topics.sort((a, b) => sign * (key(a) < key(b) ? -1 : key(a) > key(b) ? 1 : 0));
    this.heads.forEach((head, i) => { head.ariaSort = COLUMNS[i] !== this.sort ? "none" : this.down ? "descending" : "ascending"; });
    this.count.textContent = topics.length ? this.app.words("topics.count", { count: topics.length }) : this.app.words("topics.none");
    this._columns(topics);
    const present = new Set(topics.map(({ name }) => name));
    for (const [name, row] of this.rows) if (!present.has(name)) { row.remove(); this.rows.delete(name); }
    let before = null;
    for (const topic of topics) {
      const row = this.rows.get(topic.name) ?? this._row(topic), place = before ? before.nextSibling : this.body.firstChild;
      if (row !== place) this.body.insertBefore(row, place);
      before = row;
    }
    // Rows out of sight are written when they are scrolled to: the figures of hundreds would cost frames each second.
    const { scrollTop, clientHeight } = this.scroll, height = this.body.firstChild?.offsetHeight || 20, first = Math.max(0, Math.floor(scrollTop / height) - 2);
    this.waiting = topics.slice(first, first + Math.ceil(clientHeight / height) + 5);
  }

  /** Share the width among the columns, so that names and types are whole where there is room. */
  _columns(topics) {
    const isBag = Boolean(this.app.connection.info?.robolink?.bag), figures = isBag ? 3 : 4;
    const longest = (name) => Math.max(60, ...topics.map((topic) => widthOf(topic[name]))) + PADDING, name = longest("name"), type = longest("type");
    const fits = (count) => name + type <= this.width - FIGURE * count, isNarrow = this.width < NARROW || (!fits(figures) && fits(2));
    const room = this.width - FIGURE * (isNarrow ? 2 : figures);
    this.table.classList.toggle("bag", isBag); // nobody publishes there
    this.table.classList.toggle("narrow", isNarrow);
    this.rooms = [Math.min(name, room - Math.min(type, Math.max(room - name, room * 0.45)))];
    this.rooms.push(room - this.rooms[0]);
    this.heads[0].style.width = `${this.rooms[0]}px`;
  }

  /** Write the figures of some rows: all of two hundred at once would hold a frame up. */
  _refresh() {
    for (const topic of this.waiting.splice(0, ROWS)) this._row(topic);
  }

  _row(topic) {
    let row = this.rows.get(topic.name);
    if (!row) {
      row = h("tr", { "data-topic": topic.name, onclick: () => this._choose(topic.name) }, ...COLUMNS.map((name) => h("td", { class: name })));
      row.cells[0].append(button("", topic.name, () => {}));
      row.texts = [];
      this.rows.set(topic.name, row);
    }
    const told = topic.statistics ?? {}, { type } = topic, [name, room] = this.rooms.map((each) => each - PADDING);
    const texts = [fitted(topic.name, name), fitted(widthOf(type) <= room ? type : short(type), room), told.rate === undefined ? "" : told.rate.toFixed(1), brief(told.bandwidth), age(told.age), brief(told.publishers)];
    texts.forEach((text, i) => { if (row.texts[i] !== text) (i ? row.cells[i] : row.cells[0].firstChild).textContent = row.texts[i] = text; });
    row.cells[1].title = type;
    row.classList.toggle("chosen", this.chosen?.topic === topic);
    return row;
  }

  /** Show a topic's messages, all of them unfolded. */
  find(name) { if (this.chosen?.topic.name !== name) this._choose(name, true); }

  /** Show the messages of a topic, with `open` what of them is unfolded; of the chosen one, or of null, none. */
  _choose(name, open = []) {
    const before = this.chosen;
    before?.close();
    this.chosen = name && before?.topic.name !== name ? this.app.listen(name, { rate: TREE_RATE }) : null;
    this.detail.hidden = !this.chosen;
    this.title.textContent = name ?? "";
    this.tree.forget(open);
    this.seen = undefined;
    this.stale = true;
    this.app.remember?.();
  }

  _show() {
    const { topic } = this.chosen, { view } = topic;
    if (view === this.seen) return;
    this.seen = view;
    const message = topic.latest;
    this.hint.textContent = topic.error || `${topic.type}${message ? "" : ` · ${this.app.words("topics.waiting")}`}`;
    if (message) this.tree.show(topic.name, message);
  }
}

/** Age in seconds as a text. */
function age(seconds) {
  if (seconds === null || seconds === undefined) return "–";
  return seconds < 100 ? `${seconds.toFixed(1)} s` : seconds < 6000 ? `${Math.round(seconds / 60)} min` : `${brief(seconds / 3600, 2)} h`;
}

export const panel = { id: "topics", create: (element, app, options) => new Topics(element, app, options) };
