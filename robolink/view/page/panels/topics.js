// Topics panel: type, rate, bandwidth, age and ends of each topic, and the tree of the latest message of one.

import { brief, button, h } from "../dom.js";
import { short } from "../cdr.js";
import { Tree } from "./tree.js";

const COLUMNS = ["topic", "type", "rate", "bandwidth", "age", "publishers"];
const ROWS = 12; // rows that are written in one frame
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
    if (options.topic) this._choose(options.topic);
  }

  save() { return { filter: this.filter, sort: this.sort, down: this.down, topic: this.chosen?.topic.name }; }

  close() {
    for (const off of this.offs) off();
    this.chosen?.close();
  }

  frame(now) {
    if (this.stale && !(now - this.listed < 200)) {
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
    const table = h("table", { class: "topics" }, h("thead", {}, h("tr", {}, ...this.heads)), this.body);
    this.tree = new Tree(words, (topic, path) => this.app.emit("pick", topic, path));
    this.tree.onchange = () => { this.seen = undefined; this.read = undefined; };
    this.title = h("h3");
    this.hint = h("p", { class: "dim" });
    this.detail = h("div", { class: "detail", hidden: true }, h("div", { class: "row" }, button("✕", words("topics.back"), () => this._choose(null)), this.title), this.hint, this.tree.element);
    this.element.append(h("div", { class: "row" }, search, this.count), h("div", { class: "scroll" }, table), this.detail);
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
    const present = new Set(topics.map(({ name }) => name));
    for (const [name, row] of this.rows) if (!present.has(name)) { row.remove(); this.rows.delete(name); }
    let before = null;
    for (const topic of topics) {
      const row = this.rows.get(topic.name) ?? this._row(topic), place = before ? before.nextSibling : this.body.firstChild;
      if (row !== place) this.body.insertBefore(row, place);
      before = row;
    }
    this.waiting = topics;
  }

  /** Write the figures of some rows: all of two hundred at once would hold a frame up. */
  _refresh() {
    for (const topic of this.waiting.splice(0, ROWS)) this._row(topic);
  }

  _row(topic) {
    let row = this.rows.get(topic.name);
    if (!row) {
      row = h("tr", { "data-topic": topic.name, onclick: () => this._choose(topic.name) }, ...COLUMNS.map((name) => h("td", { class: name })));
      row.cells[0].append(button(topic.name, null, () => {}));
      row.texts = [];
      this.rows.set(topic.name, row);
    }
    const told = topic.statistics ?? {}, type = short(topic.type);
    const texts = [null, type, told.rate === undefined ? "" : told.rate.toFixed(1), brief(told.bandwidth), told.age === null || told.age === undefined ? "–" : `${told.age < 100 ? told.age.toFixed(1) : brief(told.age)} s`, brief(told.publishers)];
    texts.forEach((text, i) => { if (text !== null && row.texts[i] !== text) row.cells[i].textContent = row.texts[i] = text; });
    if (row.texts[0] !== topic.type) row.cells[1].title = row.texts[0] = topic.type;
    row.classList.toggle("chosen", this.chosen?.topic === topic);
    return row;
  }

  _choose(name) {
    const before = this.chosen;
    before?.close();
    this.chosen = name && before?.topic.name !== name ? this.app.listen(name, { rate: TREE_RATE }) : null;
    this.detail.hidden = !this.chosen;
    this.title.textContent = name ?? "";
    this.tree.element.replaceChildren();
    this.tree.topic = null;
    this.seen = undefined;
    this.stale = true;
    this.app.remember?.();
  }

  _show() {
    const { topic } = this.chosen, { view } = topic;
    if (view === this.seen) return;
    this.seen = view;
    const message = topic.latest;
    this.hint.textContent = topic.error || (message ? short(topic.type) : this.app.words("topics.waiting"));
    if (message) this.tree.show(topic.name, message);
  }
}

export const panel = { id: "topics", create: (element, app, options) => new Topics(element, app, options) };
