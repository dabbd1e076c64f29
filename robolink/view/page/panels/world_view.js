// Camera of the world panel: metres to pixels and back, moved by pointer, wheel, two fingers and keys.

import { isTyping } from "../dom.js";

const CLOSEST = 5000, FARTHEST = 0.05; // pixels a metre
const WIDE = 1e6; // metres from the origin: what is farther away, or no number, is not looked at
const LEAST = 1; // metres that are shown at least
const CLICK = 5; // pixels that a click may move

/** Rectangle around points, or null; those that are nowhere do not count. */
export function around(points) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  for (const { x, y } of points) {
    if (!(Math.abs(x) <= WIDE && Math.abs(y) <= WIDE)) continue;
    box[0] = Math.min(box[0], x); box[1] = Math.min(box[1], y); box[2] = Math.max(box[2], x); box[3] = Math.max(box[3], y);
  }
  return box[0] <= box[2] ? box : null;
}

export class View {
  /** @param canvas that is looked at  @param tool {active, begin, drag, end}: gets the pointer while it is active */
  constructor(canvas, tool) {
    this.canvas = canvas;
    this.tool = tool;
    this.x = 0;
    this.y = 0;
    this.scale = 50 * this.ratio;
    this.auto = true; // fits by itself until somebody moves it
    this.changed = true;
    this.covered = 0; // pixels at the right side that something lies upon
    this.pointer = null; // place of the mouse in metres
    this._held = new Map();
    for (const name of ["pointerdown", "pointermove", "pointerup", "pointercancel", "pointerleave"]) canvas.addEventListener(name, (event) => this[`_${name}`](event));
    canvas.addEventListener("wheel", (event) => this._wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this._key(event));
    new ResizeObserver(() => this._resize()).observe(canvas);
    this._resize();
  }

  get ratio() { return Math.min(2, devicePixelRatio || 1); }

  toX(x) { return this.canvas.width / 2 + (x - this.x) * this.scale; }

  toY(y) { return this.canvas.height / 2 - (y - this.y) * this.scale; }

  toWorld(px, py) {
    return [(px * this.ratio - this.canvas.width / 2) / this.scale + this.x, (this.canvas.height / 2 - py * this.ratio) / this.scale + this.y];
  }

  look(x, y, scale = this.scale) {
    if (!(Math.abs(x) <= WIDE && Math.abs(y) <= WIDE && scale > 0)) return;
    if (x === this.x && y === this.y && scale === this.scale) return;
    this.x = x;
    this.y = y;
    this.scale = Math.min(CLOSEST, Math.max(FARTHEST, scale));
    this.changed = true;
  }

  fit([left, bottom, right, top]) {
    const { width, height } = this.canvas, edge = Math.min(20 * this.ratio, width / 20, height / 20), side = this.covered * this.ratio;
    const scale = Math.min((width - side - 2 * edge) / Math.max(right - left, LEAST), (height - 2 * edge) / Math.max(top - bottom, LEAST));
    this.look((left + right) / 2 + side / 2 / scale, (bottom + top) / 2, scale);
  }

  /** Come nearer by a factor around a point of the canvas, by default its middle. */
  zoom(factor, px = this.canvas.width / 2 / this.ratio, py = this.canvas.height / 2 / this.ratio) {
    this.auto = false;
    const before = this.toWorld(px, py), scale = Math.min(CLOSEST, Math.max(FARTHEST, this.scale * factor));
    const rest = this.scale / scale;
    this.look(before[0] + (this.x - before[0]) * rest, before[1] + (this.y - before[1]) * rest, scale);
  }

  _resize() {
    const { clientWidth, clientHeight } = this.canvas;
    this.canvas.width = Math.max(1, Math.round(clientWidth * this.ratio));
    this.canvas.height = Math.max(1, Math.round(clientHeight * this.ratio));
    this.changed = true;
  }

  _pointerdown(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this._held.set(event.pointerId, { x: event.offsetX, y: event.offsetY, startX: event.offsetX, startY: event.offsetY });
    if (this.tool.active && this._held.size === 1) this.tool.begin(this.toWorld(event.offsetX, event.offsetY));
  }

  _pointermove(event) {
    this.pointer = this.toWorld(event.offsetX, event.offsetY);
    const held = this._held.get(event.pointerId);
    if (!held) return;
    if (this.tool.active) {
      const far = Math.hypot(event.offsetX - held.startX, event.offsetY - held.startY) > CLICK;
      return this.tool.drag(this.pointer, far);
    }
    const others = [...this._held].filter(([id]) => id !== event.pointerId).map(([, each]) => each);
    if (others.length) this._pinch(held, others[0], event);
    this._pan((event.offsetX - held.x) / (others.length + 1), (event.offsetY - held.y) / (others.length + 1));
    held.x = event.offsetX;
    held.y = event.offsetY;
  }

  _pointerup(event) {
    if (this._held.delete(event.pointerId) && this.tool.active) this.tool.end();
  }

  _pointercancel(event) { this._held.delete(event.pointerId); }

  _pointerleave() { this.pointer = null; }

  _pan(dx, dy) {
    if (!dx && !dy) return;
    this.auto = false;
    this.onpan?.();
    this.look(this.x - (dx * this.ratio) / this.scale, this.y + (dy * this.ratio) / this.scale);
  }

  _pinch(held, other, event) {
    const before = Math.hypot(held.x - other.x, held.y - other.y), after = Math.hypot(event.offsetX - other.x, event.offsetY - other.y);
    if (before > 10 && after > 10) this.zoom(after / before, (event.offsetX + other.x) / 2, (event.offsetY + other.y) / 2);
  }

  _wheel(event) {
    event.preventDefault();
    this.zoom(Math.exp(-event.deltaY * (event.deltaMode ? 0.03 : 0.0015)), event.offsetX, event.offsetY);
  }

  _key(event) {
    if (this.tool.active || isTyping(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = 60;
    const acts = {
      ArrowLeft: () => this._pan(step, 0), ArrowRight: () => this._pan(-step, 0), ArrowUp: () => this._pan(0, step), ArrowDown: () => this._pan(0, -step),
      "+": () => this.zoom(1.25), "=": () => this.zoom(1.25), "-": () => this.zoom(0.8),
    };
    if (!acts[event.key]) return;
    event.preventDefault();
    acts[event.key]();
  }
}
