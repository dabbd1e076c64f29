// Plot panel: numeric fields over time on two axes, drawn by hand on a canvas; each frame draws only what can be seen.

import { brief, button, download, h } from "../dom.js";
import { addPairs } from "../words.js";
import { csv, Series, ticks, unitOf } from "./series.js";

addPairs("plot", {
  empty: ["drag a number here from the tree of a topic, or click it there", "arraste um número da árvore de um topic para cá, ou clique nele"],
  seconds: ["seconds shown", "segundos mostrados"], png: ["save as PNG", "salvar como PNG"], csv: ["save as CSV", "salvar como CSV"],
  clear: ["remove all", "remover tudo"], remove: ["remove {name}", "remover {name}"], axis: ["left or right axis", "eixo esquerdo ou direito"],
  pause: ["pause or go on", "pausar ou continuar"], canvas: ["drag: zoom; wheel: zoom; double click: back", "arraste ou roda: zoom; clique duplo: volta"],
});

const COLOURS = ["c1", "c2", "c3", "c4", "c5", "c6", "c7", "c8"]; // of the style sheet
const SPANS = [5, 10, 30, 60, 300];
const LEAST = 5000; // milliseconds that are shown at least
const BOTTOM = 18, SIDE = 48, TOP = 6;

class Plot {
  constructor(element, app, options) {
    Object.assign(this, { element, app });
    this.seconds = SPANS.includes(options.seconds) ? options.seconds : 30;
    this.series = [];
    this.sources = new Map(); // topic -> {handle, series}
    this.view = null; // {start, end} while paused or zoomed
    this.lag = Infinity;
    this._build();
    for (const { topic, path, axis } of options.series ?? []) this.add(topic, path, axis);
    this.offs = [app.on("theme", () => this._colours()), app.on("pick", (topic, path) => app.layout.panel("plot") === this && this.add(topic, path))];
    this._colours();
  }

  save() { return { seconds: this.seconds, series: this.series.map(({ topic, path, axis }) => ({ topic, path, axis })) }; }

  close() {
    for (const off of this.offs) off();
    for (const { handle } of this.sources.values()) handle.close();
  }

  _build() {
    const { words } = this.app;
    this.pauseButton = button("❚❚", words("plot.pause"), () => this._look(this.view ? null : this._range()), { className: "pause" });
    const spans = h("select", { title: words("plot.seconds"), "aria-label": words("plot.seconds"), onchange: () => { this.seconds = Number(spans.value); this._look(null); this.app.remember(); } },
      ...SPANS.map((each) => h("option", { value: each, selected: each === this.seconds }, `${each} s`)));
    this.legend = h("div", { class: "legend" });
    this.canvas = h("canvas", { class: "plot", tabIndex: 0, title: words("plot.canvas"), "aria-label": words("panel.plot") });
    this.hint = h("p", { class: "empty" }, words("plot.empty"));
    this.element.append(h("div", { class: "row" }, this.pauseButton, spans, h("span", { class: "gap" }),
      button("PNG", words("plot.png"), () => this._png()), button("CSV", words("plot.csv"), () => download("plot.csv", csv(this.series), "text/csv")),
      button("✕", words("plot.clear"), () => { for (const each of [...this.series]) this.remove(each); })),
    this.legend, h("div", { class: "paper" }, this.canvas, this.hint));
    this.context = this.canvas.getContext("2d");
    this.element.addEventListener("dragover", (event) => event.preventDefault());
    this.element.addEventListener("drop", (event) => this._drop(event));
    this._pointers();
    this.canvas.addEventListener("keydown", (event) => this._key(event));
    new ResizeObserver(() => { this.stale = true; }).observe(this.canvas);
  }

  _colours() {
    this.ink = Object.fromEntries(["line", "dim", "accent", "panel", ...COLOURS].map((name) => [name, this.app.colour(name)]));
    this.stale = true;
  }

  /** Plot a field of a topic. */
  add(topic, path, axis = 0) {
    if (this.series.some((each) => each.topic === topic && each.path === path)) return;
    const used = new Set(this.series.map(({ colour }) => colour));
    const made = new Series(topic, path, axis, COLOURS.find((each) => !used.has(each)) ?? COLOURS[this.series.length % COLOURS.length]);
    this.series.push(made);
    const { topic: known } = this._source(topic, made).handle;
    for (const { time, view } of known.ring.between(0, Infinity)) made.take(time, known.decode(view));
    this._legend();
    this.app.remember();
  }

  remove(gone) {
    this.series = this.series.filter((each) => each !== gone);
    const source = this.sources.get(gone.topic);
    source.series.delete(gone);
    if (!source.series.size) {
      source.handle.close();
      this.sources.delete(gone.topic);
    }
    this._legend();
    this.app.remember();
  }

  _source(topic, made) {
    let source = this.sources.get(topic);
    if (!source) {
      source = { series: new Set() };
      this.sources.set(topic, source);
      source.handle = this.app.listen(topic, { every: (view, time, known) => this._take(source, known.decode(view), time) });
    }
    source.series.add(made);
    return source;
  }

  _take(source, message, time) {
    if (!message) return;
    this.lag = Math.min(this.lag, this.app.clock() - time);
    for (const each of source.series) each.take(time, message);
    this.stale = true;
  }

  _drop(event) {
    const told = event.dataTransfer.getData("text/robolink-field");
    if (!told) return;
    event.preventDefault();
    const { topic, path } = JSON.parse(told);
    this.add(topic, path);
  }

  _legend() {
    const { words } = this.app;
    this.hint.hidden = this.series.length > 0;
    this.legend.replaceChildren(...this.series.map((each) => {
      const swatch = h("span", { class: "swatch" });
      swatch.style.background = `var(--${each.colour})`;
      each.shown = h("output");
      const axis = button(each.axis ? "→" : "←", words("plot.axis"), () => { each.axis = 1 - each.axis; this._legend(); this.app.remember(); });
      return h("span", { class: "chip", "data-series": each.name }, swatch, each.name, each.shown, axis, button("✕", words("plot.remove", { name: each.name }), () => this.remove(each)));
    }));
    this.stale = true;
  }

  _unit({ topic, path }) { return unitOf(this.app.topics.get(topic)?.type ?? "", path); }

  /** Times that are shown, in milliseconds. */
  _range() {
    if (this.view) return this.view;
    const skew = Math.abs(this.lag) > 1000 && Number.isFinite(this.lag) ? this.lag : 0; // clocks of two machines
    const end = this.app.now - (this.app.time.live ? skew : 0);
    const first = this.series.reduce((least, { count, times }) => (count ? Math.min(least, times[0]) : least), Infinity); // before it there is nothing to see
    return { start: Math.max(end - this.seconds * 1000, Math.min(first, end - LEAST)), end };
  }

  /** Show these times, or follow with null. */
  _look(view) {
    if (view && !(view.end - view.start > 1)) return;
    this.view = view;
    this.pauseButton.ariaPressed = String(Boolean(view));
    this.stale = true;
  }

  _zoom(factor, share = 0.5) {
    const { start, end } = this._range(), at = start + (end - start) * share;
    this._look({ start: at - (at - start) * factor, end: at + (end - at) * factor });
  }

  _key(event) {
    const { start, end } = this._range(), step = (end - start) / 10;
    const pan = (by) => this._look({ start: start + by, end: end + by });
    const acts = { ArrowLeft: () => pan(-step), ArrowRight: () => pan(step), "+": () => this._zoom(0.7), "-": () => this._zoom(1.4), Escape: () => this._look(null), Enter: () => this._look(this.view ? null : this._range()) };
    if (!acts[event.key]) return;
    event.preventDefault();
    acts[event.key]();
  }

  _pointers() {
    const { canvas } = this, share = (event) => {
      const { left, right } = canvas.getBoundingClientRect(), [from, to] = this.edges ?? [0, 0];
      return Math.min(1, Math.max(0, (event.clientX - left - from) / Math.max(1, right - left - from - to)));
    };
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); this.marked = [share(event), share(event)]; });
    canvas.addEventListener("pointermove", (event) => { this.hover = share(event); if (this.marked) this.marked[1] = this.hover; this.stale = true; });
    canvas.addEventListener("pointerleave", () => { this.hover = undefined; this.stale = true; });
    canvas.addEventListener("pointercancel", () => { this.marked = null; });
    canvas.addEventListener("pointerup", () => {
      const [from, to] = (this.marked ?? [0, 0]).toSorted((a, b) => a - b), { start, end } = this._range();
      this.marked = null;
      if (to - from > 0.02) this._look({ start: start + (end - start) * from, end: start + (end - start) * to });
    });
    canvas.addEventListener("dblclick", () => this._look(null));
    canvas.addEventListener("wheel", (event) => { event.preventDefault(); this._zoom(event.deltaY > 0 ? 1.25 : 0.8, share(event)); }, { passive: false });
  }

  _png() {
    this.stale = true;
    this._draw(this.ink.panel);
    this.canvas.toBlob((blob) => download("plot.png", blob));
  }

  frame(now) {
    if (!this.stale && (this.view || !this.series.length || this.app.now === this.drawn)) return;
    this.drawn = this.app.now;
    this._draw();
    if (now - this.told < 100) {
      this.stale = true; // so that a plot that stands still tells its values at last
      return;
    }
    this.told = now;
    const { start, end } = this._range(), at = this.hover === undefined ? end : start + (end - start) * this.hover;
    for (const each of this.series) each.shown.textContent = `${brief(each.at(at), 4)} ${this._unit(each)}`;
  }

  _draw(ground) {
    this.stale = false;
    const { canvas, context } = this, ratio = devicePixelRatio, { clientWidth: width, clientHeight: height } = canvas;
    if (!width || !height) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = "11px system-ui";
    if (ground) {
      context.fillStyle = ground;
      context.fillRect(0, 0, width, height);
      this.series.forEach((each, i) => { context.fillStyle = this.ink[each.colour]; context.textAlign = "left"; context.fillText(each.name, SIDE + 6, TOP + 14 + 14 * i); });
    }
    const { start, end } = this._range(), second = this.series.some(({ axis }) => axis);
    const right = second ? width - SIDE : width - 8, bottom = height - BOTTOM;
    this.edges = [SIDE, width - right];
    const toX = (time) => SIDE + ((time - start) / (end - start)) * (right - SIDE);
    this._times(toX, start, end, bottom, right);
    for (const axis of [0, 1]) this._axis(axis, start, end, right, bottom);
    this._marks(right, bottom);
  }

  _times(toX, start, end, bottom, right) {
    const { context, ink } = this, { step, found } = ticks(start / 1000, end / 1000, (right - SIDE) / 90);
    context.strokeStyle = ink.line;
    context.fillStyle = ink.dim;
    context.lineWidth = 1;
    context.textAlign = "center";
    context.beginPath();
    for (const at of found) {
      const x = Math.round(toX(at * 1000)) + 0.5;
      context.moveTo(x, TOP);
      context.lineTo(x, bottom);
      const text = clock(at, step);
      context.fillText(text, Math.min(x, context.canvas.width / context.getTransform().a - context.measureText(text).width / 2 - 2), bottom + 13);
    }
    context.stroke();
  }

  _axis(axis, start, end, right, bottom) {
    const series = this.series.filter((each) => each.axis === axis), { context, ink } = this;
    if (!series.length) return;
    const range = [Infinity, -Infinity];
    for (const each of series) each.extent(range, start, end);
    let [low, high] = range[0] <= range[1] ? range : [-1, 1];
    const pad = (high - low) * 0.06 || Math.abs(low) * 0.1 || 1;
    low -= pad;
    high += pad;
    const up = (bottom - TOP) / (high - low);
    context.strokeStyle = ink.line;
    context.fillStyle = ink.dim;
    context.lineWidth = 1;
    context.textAlign = axis ? "left" : "right";
    context.beginPath();
    for (const at of ticks(low, high, (bottom - TOP) / 30).found) {
      const y = Math.round(bottom - (at - low) * up) + 0.5;
      if (!axis) { context.moveTo(SIDE, y); context.lineTo(right, y); }
      context.fillText(brief(at, 5), axis ? right + 5 : SIDE - 5, y + 4);
    }
    context.stroke();
    const units = [...new Set(series.map((each) => this._unit(each)))];
    context.textAlign = axis ? "right" : "left";
    context.fillText(units.filter(Boolean).join(", "), axis ? right - 4 : SIDE + 4, TOP + 9);
    context.save();
    context.beginPath();
    context.rect(SIDE, 0, right - SIDE, bottom);
    context.clip();
    context.lineWidth = 1.5;
    context.lineJoin = "round";
    for (const each of series) {
      context.strokeStyle = ink[each.colour];
      context.beginPath();
      each.trace(context, start, end, SIDE, (right - SIDE) / (end - start), bottom + low * up, up);
      context.stroke();
    }
    context.restore();
  }

  _marks(right, bottom) {
    const { context, ink, hover, marked } = this, x = (share) => SIDE + share * (right - SIDE);
    context.fillStyle = ink.accent;
    if (hover !== undefined) context.fillRect(x(hover), TOP, 1, bottom - TOP);
    context.globalAlpha = 0.2;
    if (marked) context.fillRect(x(Math.min(...marked)), TOP, Math.abs(x(marked[1]) - x(marked[0])), bottom - TOP);
    context.globalAlpha = 1;
  }
}

/** Time of an axis: of the day, or seconds where time is a simulation's. */
function clock(seconds, step) {
  const digits = Math.min(3, Math.max(0, -Math.floor(Math.log10(step))));
  if (seconds < 1e8) return `${seconds.toFixed(digits)} s`;
  const date = new Date(seconds * 1000);
  return `${date.toLocaleTimeString("en-GB")}${digits ? (seconds % 1).toFixed(digits).slice(1) : ""}`;
}

export const panel = { id: "plot", create: (element, app, options) => new Plot(element, app, options) };
