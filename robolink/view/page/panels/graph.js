// Graph panel: nodes and topics of the running system in layers, as SVG; a click tells the ends of one.

import { button, fitted, h, widthOf } from "../dom.js";
import { addPairs } from "../words.js";
import { arrange, HEIGHT } from "./graph_layout.js";

addPairs("graph", {
  filter: ["filter", "filtrar"], quiet: ["hide /rosout and such", "ocultar /rosout e outros"], fit: ["fit", "tudo"],
  none: ["No node runs in domain {domain}. Start one, such as: robolink launch wander", "Nenhum node em execução no domínio {domain}. Inicie um, por exemplo: robolink launch wander"],
  unmatched: ["no name has '{filter}' in it", "nenhum nome contém '{filter}'"],
  bag: ["A bag tells what was sent, but not which nodes sent it: there is no graph of it. The panel Topics lists its topics.", "Um bag diz o que foi enviado, mas não quais nodes enviaram: não há grafo dele. O painel Topics lista os seus topics."],
  publishes: ["publishes", "publica"], subscribes: ["subscribes to", "assina"], publishers: ["publishers", "publishers"], subscribers: ["subscribers", "subscribers"], services: ["services", "services"],
});

const WIDEST = 330, MARGIN = 20; // pixels of a name, and beside it
const LEAST = 0.65, MOST = 1.2; // scales at which a graph opens, so that it can be read
const PERIOD = 200; // milliseconds at least between two drawings, as a large system comes up
const QUIET = /^\/(rosout|parameter_events|clock|diagnostics)$|\/_|^\/tf(_static)?$/;

let count = 0; // of graphs, whose arrowheads have names

function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

class Graph {
  constructor(element, app, options) {
    Object.assign(this, { element, app, filter: "", quiet: true, stale: true }, options);
    this.name = `arrow${++count}`;
    this._build();
    this.offs = [app.connection.on("graph", () => { this.stale = true; }), app.connection.on("info", () => { this.stale = true; })];
    this.observer = new ResizeObserver(() => { if (!this.view) this._open(); });
    this.observer.observe(this.picture);
  }

  save() { return { filter: this.filter, quiet: this.quiet }; }

  close() {
    for (const off of this.offs) off();
    this.observer.disconnect();
  }

  _build() {
    const { words } = this.app;
    const search = h("input", { type: "search", value: this.filter, placeholder: words("graph.filter"), "aria-label": words("graph.filter"), oninput: () => this._set({ filter: search.value }) });
    const quiet = h("input", { type: "checkbox", checked: this.quiet, onchange: () => this._set({ quiet: quiet.checked }) });
    this.picture = svg("svg", { class: "graph", role: "group" });
    this.hint = h("p", { class: "empty" });
    this.detail = h("div", { class: "ends padded", role: "status", hidden: true });
    this.element.append(h("div", { class: "row" }, search, h("label", {}, quiet, " ", words("graph.quiet")),
      button("+", words("world.zoomin"), () => this._zoom(0.8)), button("−", words("world.zoomout"), () => this._zoom(1.25)), button(words("graph.fit"), null, () => this._look(this.view = this.all))),
    this.hint, this.picture, this.detail);
    this._pointers();
  }

  _set(options) {
    Object.assign(this, options, { view: null, stale: true, due: 0 });
    this.app.remember();
  }

  frame(now) {
    if (!this.stale || now < this.due) return;
    const begin = performance.now();
    this.stale = false;
    this._draw(this._items());
    this.due = now + PERIOD + 4 * (performance.now() - begin);
  }

  /** Nodes and topics, with what each leads to and from. */
  _items() {
    const { graph } = this.app.connection, items = new Map(), wanted = this.filter.toLowerCase();
    const item = (kind, name) => {
      const key = kind + name;
      if (!items.has(key)) items.set(key, { key, kind, name, text: fitted(name, WIDEST), from: [], to: [] });
      return items.get(key);
    };
    const link = (a, b) => { a.to.push(b); b.from.push(a); };
    for (const name of graph.nodes) item("node", name);
    for (const [ends, out] of [[graph.published, true], [graph.subscribed, false]]) {
      for (const [topic, nodes] of ends) {
        if (this.quiet && QUIET.test(topic)) continue;
        for (const node of nodes) link(...(out ? [item("node", node), item("topic", topic)] : [item("topic", topic), item("node", node)]));
      }
    }
    const hit = ({ name }) => name.toLowerCase().includes(wanted);
    const shown = new Set([...items.values()].filter((each) => hit(each) || [...each.from, ...each.to].some(hit)));
    for (const each of shown) for (const side of ["from", "to"]) each[side] = each[side].filter((other) => shown.has(other));
    return [...shown].map((each) => Object.assign(each, { width: widthOf(each.text) + MARGIN, closes: /cmd_vel/.test(each.name) })).sort((a, b) => a.name.localeCompare(b.name, "en", { numeric: true }));
  }

  _draw(items) {
    const { app, app: { words } } = this, edges = arrange(items);
    const arrow = (name) => svg("marker", { id: name, class: name === this.name ? "" : "chosen", viewBox: "0 0 10 10", refX: 10, refY: 5, markerWidth: 9, markerHeight: 9, markerUnits: "userSpaceOnUse", orient: "auto" }, svg("path", { d: "M0 0L10 5L0 10z" }));
    this.paths = edges.map(({ from, to, path }) => ({ from, to, element: svg("path", { class: "edge", d: path, "marker-end": `url(#${this.name})`, "data-from": from.key, "data-to": to.key }) }));
    this.picture.replaceChildren(svg("defs", {}, arrow(this.name), arrow(`${this.name}chosen`)), ...this.paths.map(({ element }) => element), ...items.map((each) => this._box(each)));
    this.hint.hidden = items.length > 0;
    this.picture.style.display = items.length ? "" : "none";
    this.hint.textContent = app.isBag ? words("graph.bag") : this.filter ? words("graph.unmatched", { filter: this.filter }) : words("graph.none", { domain: app.connection.info?.robolink?.domain ?? "" });
    if (this.view) this._look(this.view);
    else this._open();
    this._choose(items.some(({ key }) => key === this.chosen) ? this.chosen : null);
  }

  /** Place of all that is drawn. */
  get all() {
    const { x, y, width, height } = this.picture.getBBox();
    return [x - 8, y - 8, width + 16, height + 16];
  }

  /** Look at all, at a scale at which it can be read. */
  _open() {
    const { clientWidth, clientHeight } = this.picture;
    if (!clientWidth) return;
    const [left, top, width, height] = this.all;
    const scale = Math.min(MOST, Math.max(LEAST, Math.min(clientWidth / width, clientHeight / height)));
    const across = clientWidth / scale, down = clientHeight / scale;
    this._look([left + Math.min(0, (width - across) / 2), top + (height - down) / 2, across, down]);
  }

  _box({ key, kind, name, text, width, x, y }) {
    const box = svg("g", { class: kind, transform: `translate(${x},${y})`, tabindex: 0, role: "button", "aria-label": `${kind} ${name}`, "data-key": key },
      svg("title", {}, name), svg("rect", { width, height: HEIGHT, rx: kind === "node" ? 12 : 2 }), svg("text", { x: width / 2, y: 16 }, text));
    box.addEventListener("click", () => this._choose(key));
    box.addEventListener("keydown", (event) => { if (event.key === "Enter") this._choose(key); });
    return box;
  }

  /** Show the ends of a node or topic, by its key; null shows none. */
  _choose(key) {
    this.chosen = key;
    this.picture.classList.toggle("choosing", Boolean(key));
    for (const each of this.picture.querySelectorAll("g")) each.classList.toggle("chosen", each.dataset.key === key);
    for (const { from, to, element } of this.paths) {
      const isOn = from.key === key || to.key === key;
      element.classList.toggle("chosen", isOn);
      element.setAttribute("marker-end", `url(#${this.name}${isOn ? "chosen" : ""})`);
    }
    this.detail.hidden = !key;
    if (key) this.detail.replaceChildren(...this._ends(key));
  }

  /** The ends of a node or topic, with their types or their quality of service. */
  _ends(key) {
    const { words, connection: { graph } } = this.app, isNode = key.startsWith("node"), name = key.slice(isNode ? 4 : 5);
    const of = (side) => (isNode ? [...graph[side]].filter(([, nodes]) => nodes.includes(name)).map(([topic]) => [`topic${topic}`, topic, graph.types.get(topic), graph.qos.get(`${side} ${topic} ${name}`)])
      : (graph[side].get(name) ?? []).map((node) => [`node${node}`, node, "", graph.qos.get(`${side} ${name} ${node}`)]));
    const lists = isNode ? { publishes: of("published"), subscribes: of("subscribed"), services: [...graph.services].filter(([, nodes]) => nodes.includes(name)).map(([service]) => ["", service]) }
      : { publishers: of("published"), subscribers: of("subscribed") };
    return [h("p", {}, h("b", {}, name), h("span", { class: "dim" }, ` ${isNode ? "" : (graph.types.get(name) ?? "")}`)),
      ...Object.entries(lists).map(([title, ends]) => h("div", {}, h("span", { class: "dim" }, `${words(`graph.${title}`)} (${ends.length})`),
        h("ul", {}, ...ends.map(([to, text, type, qos]) => h("li", {}, this.picture.querySelector(`[data-key="${CSS.escape(to)}"]`) ? h("button", { type: "button", onclick: () => this._choose(to) }, text) : text,
          h("span", { class: "dim" }, type), h("span", { class: "dim" }, qos))))))];
  }

  _look(view) {
    this.shown = view;
    this.picture.setAttribute("viewBox", view.join(" "));
  }

  /** Zoom about a place of the picture, by default its middle. */
  _zoom(by, at) {
    const [x, y, width, height] = this.shown, { x: atX, y: atY } = at ?? { x: x + width / 2, y: y + height / 2 };
    this._look(this.view = [atX - (atX - x) * by, atY - (atY - y) * by, width * by, height * by]);
  }

  _pointers() {
    const { picture } = this, fingers = new Map(), place = ({ x, y }) => new DOMPoint(x, y).matrixTransform(picture.getScreenCTM().inverse());
    const apart = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
    const gone = ({ pointerId }) => fingers.delete(pointerId);
    picture.addEventListener("pointerdown", ({ pointerId, x, y }) => { fingers.set(pointerId, { x, y }); this.moved = false; });
    picture.addEventListener("pointermove", ({ pointerId, x, y }) => {
      const before = fingers.get(pointerId);
      if (!before || Math.hypot(x - before.x, y - before.y) < (this.moved ? 1 : 4)) return;
      this.moved = true;
      const far = fingers.size === 2 && apart(), from = place(before), to = place({ x, y }), [left, top, width, height] = this.shown;
      fingers.set(pointerId, { x, y });
      if (far) this._zoom(far / Math.max(1, apart()), to);
      else this._look(this.view = [left + from.x - to.x, top + from.y - to.y, width, height]);
    });
    for (const name of ["pointerup", "pointercancel", "pointerleave"]) picture.addEventListener(name, gone);
    picture.addEventListener("click", (event) => {
      if (event.target === picture && !this.moved) this._choose(null);
    });
    picture.addEventListener("wheel", (event) => {
      event.preventDefault();
      this._zoom(event.deltaY > 0 ? 1.2 : 1 / 1.2, place(event));
    }, { passive: false });
    picture.addEventListener("keydown", ({ key }) => { if (/^[-+]$/.test(key)) this._zoom(key === "+" ? 0.8 : 1.25); });
  }
}

export const panel = { id: "graph", create: (element, app, options) => new Graph(element, app, options) };
