// Graph panel: nodes and topics of the running system in layers, as SVG; a click tells the ends of one.

import { button, h } from "../dom.js";
import { addPairs } from "../words.js";

addPairs("graph", {
  filter: ["filter", "filtrar"], quiet: ["hide /rosout and such", "ocultar /rosout e outros"], fit: ["fit", "tudo"], none: ["nobody runs", "nada em execução"],
  publishes: ["publishes", "publica"], subscribes: ["subscribes", "assina"], publishers: ["publishers", "publishers"], subscribers: ["subscribers", "subscribers"], services: ["services", "services"],
});

const WIDTH = 190, HEIGHT = 24, COLUMN = 270, ROW = 34, LETTERS = 27;
const QUIET = /^\/(rosout|parameter_events|clock|diagnostics)$|\/_|^\/tf(_static)?$/;

function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

class Graph {
  constructor(element, app, options) {
    Object.assign(this, { element, app, filter: "", quiet: true, stale: true }, options);
    this._build();
    this.off = app.connection.on("graph", () => { this.stale = true; });
  }

  save() { return { filter: this.filter, quiet: this.quiet }; }

  close() { this.off(); }

  _build() {
    const { words } = this.app;
    const search = h("input", { type: "search", value: this.filter, placeholder: words("graph.filter"), "aria-label": words("graph.filter"), oninput: () => this._set({ filter: search.value }) });
    const quiet = h("input", { type: "checkbox", checked: this.quiet, onchange: () => this._set({ quiet: quiet.checked }) });
    this.picture = svg("svg", { class: "graph", role: "group" });
    this.detail = h("div", { class: "ends padded", role: "status" });
    this.element.append(h("div", { class: "row" }, search, h("label", {}, quiet, " ", words("graph.quiet")), button(words("graph.fit"), null, () => this._set({}))), this.picture, this.detail);
    this._pointers();
  }

  _set(options) {
    Object.assign(this, options, { view: null, stale: true });
    this.app.remember();
  }

  frame() {
    if (!this.stale) return;
    this.stale = false;
    this._draw(layered(this._items()));
    if (this.chosen) this._choose(this.chosen);
  }

  /** Nodes and topics by key, with what each leads to. */
  _items() {
    const { graph } = this.app.connection, items = new Map(), wanted = this.filter.toLowerCase();
    const item = (kind, name) => {
      const key = kind + name;
      if (!items.has(key)) items.set(key, { key, kind, name, from: new Set(), to: new Set() });
      return items.get(key);
    };
    const link = (a, b) => { a.to.add(b); b.from.add(a); };
    for (const name of graph.nodes) item("node", name);
    for (const [ends, out] of [[graph.published, true], [graph.subscribed, false]]) {
      for (const [topic, nodes] of ends) {
        if (this.quiet && QUIET.test(topic)) continue;
        for (const node of nodes) link(...(out ? [item("node", node), item("topic", topic)] : [item("topic", topic), item("node", node)]));
      }
    }
    const hit = ({ name }) => name.toLowerCase().includes(wanted);
    const shown = [...items.values()].filter((each) => hit(each) || [...each.from, ...each.to].some(hit));
    for (const each of shown) for (const side of ["from", "to"]) each[side] = [...each[side]].filter((other) => shown.includes(other));
    return shown;
  }

  _draw(columns) {
    const high = Math.max(1, ...columns.map(({ length }) => length)) * ROW, boxes = columns.flat();
    columns.forEach((column, i) => column.forEach((each, k) => { each.x = i * COLUMN; each.y = (high - column.length * ROW) / 2 + k * ROW; }));
    const edges = boxes.flatMap((a) => a.to.map((b) => {
      const x = a.x + WIDTH, y = a.y + HEIGHT / 2, bend = b.x > a.x ? (b.x - x) / 2 : 90, end = b.y + HEIGHT / 2;
      return svg("path", { d: `M${x} ${y}C${x + bend} ${y} ${b.x - bend} ${end} ${b.x} ${end}`, "data-ends": `${a.key} ${b.key}` });
    }));
    this.picture.replaceChildren(...edges, ...boxes.map((each) => this._box(each)));
    this.all = [-10, -10, Math.max(1, columns.length) * COLUMN - COLUMN + WIDTH + 20, high + 20];
    if (!boxes.length) this.detail.textContent = this.app.words("graph.none");
    this._look(this.view ?? this.all);
  }

  _box({ key, kind, name, x, y }) {
    const short = name.length > LETTERS ? `…${name.slice(1 - LETTERS)}` : name;
    const box = svg("g", { class: kind, transform: `translate(${x},${y})`, tabindex: 0, role: "button", "aria-label": `${kind} ${name}`, "data-key": key },
      svg("title", {}, name), svg("rect", { width: WIDTH, height: HEIGHT, rx: kind === "node" ? 12 : 2 }), svg("text", { x: WIDTH / 2, y: 16 }, short));
    box.addEventListener("click", () => this._choose(key));
    box.addEventListener("keydown", (event) => { if (event.key === "Enter") this._choose(key); });
    return box;
  }

  /** Show the ends of a node or topic. */
  _choose(key) {
    const { words, connection: { graph } } = this.app, isNode = key.startsWith("node"), name = key.slice(isNode ? 4 : 5);
    const of = (ends) => (isNode ? [...ends].filter(([, nodes]) => nodes.includes(name)).map(([each]) => each) : (ends.get(name) ?? []));
    const lists = isNode ? { publishes: of(graph.published), subscribes: of(graph.subscribed), services: of(graph.services) } : { publishers: of(graph.published), subscribers: of(graph.subscribed) };
    this.chosen = key;
    for (const each of this.picture.children) each.classList.toggle("chosen", each.dataset.key === key || (each.dataset.ends ?? "").split(" ").includes(key));
    this.detail.replaceChildren(h("b", {}, name), ` ${isNode ? "" : (graph.types.get(name) ?? "")}`,
      ...Object.entries(lists).map(([title, names]) => h("p", {}, h("span", { class: "dim" }, `${words(`graph.${title}`)} (${names.length}): `), names.join(", "))));
  }

  _look(view) {
    this.shown = view;
    this.picture.setAttribute("viewBox", view.join(" "));
  }

  _pointers() {
    const { picture } = this, scale = () => 1 / picture.getScreenCTM().a;
    picture.addEventListener("pointermove", (event) => {
      if (!event.buttons) return;
      const [x, y, width, height] = this.shown, k = scale();
      this._look(this.view = [x - event.movementX * k, y - event.movementY * k, width, height]);
    });
    picture.addEventListener("wheel", (event) => {
      event.preventDefault();
      const by = event.deltaY > 0 ? 1.2 : 1 / 1.2, [x, y, width, height] = this.shown, at = new DOMPoint(event.clientX, event.clientY).matrixTransform(picture.getScreenCTM().inverse());
      this._look(this.view = [at.x - (at.x - x) * by, at.y - (at.y - y) * by, width * by, height * by]);
    }, { passive: false });
  }
}

/** Columns: each stands right of what leads to it, where there is no circle, and near its neighbours. */
function layered(items) {
  const visit = (each) => {
    if (each.layer !== undefined) return each.layer;
    each.layer = -1; // on the way: an edge from here closes a circle
    each.layer = Math.max(0, ...each.from.map((other) => visit(other) + 1));
    return each.layer;
  };
  items.sort((a, b) => (a.name < b.name ? -1 : 1)).forEach(visit);
  const columns = [];
  for (const each of items) (columns[each.layer] ??= []).push(each);
  const found = columns.filter(Boolean), number = () => { for (const column of found) column.forEach((each, i) => { each.place = (i + 0.5) / column.length; }); };
  const mean = (others) => others.reduce((sum, { place }) => sum + place, 0) / others.length;
  for (let round = 0; round < 6; round++) {
    number();
    for (const column of found) {
      for (const each of column) each.wish = mean(each[round % 2 ? "to" : "from"]);
      column.sort((a, b) => (Number.isNaN(a.wish) ? a.place : a.wish) - (Number.isNaN(b.wish) ? b.place : b.wish));
    }
  }
  return found;
}

export const panel = { id: "graph", create: (element, app, options) => new Graph(element, app, options) };
