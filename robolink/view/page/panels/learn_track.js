// Player of the path that robots took in a check: the world seen from above, in motion.

import { button, h } from "../dom.js";

const LONGEST = 8; // seconds that playing takes at most
const MARGIN = 0.3; // metres around the world
const STILL = "(prefers-reduced-motion: reduce)";

export class Film {
  /** @param app of the page  @param words(key, values) texts of the panel */
  constructor(app, words) {
    this.app = app;
    this.words = words;
    this.canvas = h("canvas", { role: "img" });
    this.button = button("▶", words("play"), () => this._turn());
    this.slider = h("input", { type: "range", min: 0, step: 0.05, "aria-label": words("time"), oninput: () => { this.playing = false; this._go(Number(this.slider.value)); } });
    this.clock = h("output");
    this.element = h("div", { class: "film", hidden: true }, this.canvas, h("div", { class: "row" }, this.button, this.slider, this.clock));
    this.observer = new ResizeObserver(() => this._resize());
    this.observer.observe(this.canvas);
    this.off = app.on("theme", () => { this.changed = true; });
  }

  close() {
    this.observer.disconnect();
    this.off();
  }

  /** Show a track from its beginning; null hides the player. */
  show(track) {
    this.element.hidden = !track;
    this.track = track;
    if (!track) return;
    this.bodies = track.bodies.map((body) => ({ ...body, count: body.path.length / 3 }));
    const looks = this.bodies.reduce((most, { first, count }) => Math.max(most, first + count - 1), 1);
    this.end = Number((looks * track.period).toFixed(2)); // as the slider has it
    this.speed = Math.max(1, this.end / LONGEST);
    this.slider.max = this.end;
    this.box = boxOf(track);
    this.canvas.style.aspectRatio = (this.box[2] - this.box[0]) / (this.box[3] - this.box[1]);
    this.canvas.ariaLabel = this.words("track", { seconds: this.end.toFixed(0), contacts: track.contacts.length });
    this.playing = !matchMedia(STILL).matches;
    this._go(this.playing ? 0 : this.end);
  }

  _turn() {
    if (!this.playing && this.at >= this.end) this.at = 0;
    this.playing = !this.playing;
    this._go(this.at);
  }

  _go(at) {
    this.at = Math.min(at, this.end);
    if (at >= this.end) this.playing = false;
    this.slider.value = this.at;
    this.clock.textContent = `${this.at.toFixed(1)} / ${this.end.toFixed(1)} s`;
    this.button.textContent = this.playing ? "❚❚" : "▶";
    this.changed = true;
  }

  _resize() {
    const ratio = Math.min(2, devicePixelRatio || 1);
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    this.ratio = ratio;
    this.changed = true;
  }

  frame(now) {
    if (!this.track || !this.ratio) return;
    if (this.playing) this._go(this.at + (Math.min(now - (this.then ?? now), 100) / 1000) * this.speed);
    this.then = now;
    if (!this.changed) return;
    this.changed = false;
    this._draw();
  }

  _draw() {
    const { canvas, track, app, at } = this, g = canvas.getContext("2d"), [left, bottom, right, top] = this.box;
    const scale = Math.min(canvas.width / (right - left), canvas.height / (top - bottom)), pixel = this.ratio / scale;
    const colour = Object.fromEntries(["fg", "dim", "line", "accent", "bad", "panel"].map((name) => [name, app.colour(name)]));
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, canvas.width, canvas.height);
    g.setTransform(scale, 0, 0, -scale, canvas.width / 2 - (scale * (left + right)) / 2, canvas.height / 2 + (scale * (bottom + top)) / 2);
    g.lineCap = g.lineJoin = "round";
    const stroke = (name, width, draw) => { g.strokeStyle = colour[name]; g.lineWidth = width * pixel; g.beginPath(); draw(); g.stroke(); };
    stroke("fg", 2, () => track.walls.forEach(([x, y, toX, toY]) => { g.moveTo(x, y); g.lineTo(toX, toY); }));
    const robots = this.bodies.filter((each) => each.is_robot);
    for (const each of this.bodies) if (!each.is_robot) this._body(g, each, colour.line, colour.dim, pixel);
    for (const each of robots) {
      g.globalAlpha = 0.3;
      stroke("accent", 1.5, () => trace(g, each, this._index(each, this.end)));
      g.globalAlpha = 1;
      stroke("accent", 2.5, () => trace(g, each, this._index(each, at)));
    }
    for (const each of robots) this._body(g, each, colour.accent, colour.fg, pixel);
    const size = 7 * pixel;
    const cross = ({ x, y }) => [1, -1].forEach((sign) => { g.moveTo(x - size, y - sign * size); g.lineTo(x + size, y + sign * size); });
    for (const each of track.contacts.filter((one) => one.at <= at + 1e-6)) for (const [name, width] of [["panel", 7], ["bad", 3.5]]) stroke(name, width, () => cross(each));
    if (robots.length > 1) this._names(g, robots, scale, colour.fg);
  }

  /** Number of a body's pose at a time, with its fraction. */
  _index({ first, count }, at) { return Math.min(Math.max(at / this.track.period - first, 0), count - 1); }

  _body(g, body, fill, line, pixel) {
    const [x, y, theta] = poseAt(body, this._index(body, this.at)), { circle, corners } = body;
    g.save();
    g.translate(x, y);
    g.rotate(theta);
    g.beginPath();
    if (circle) g.arc(0, 0, circle, 0, 7);
    else corners.forEach(([a, b]) => g.lineTo(a, b));
    g.closePath();
    g.fillStyle = fill;
    g.fill();
    g.strokeStyle = line;
    g.lineWidth = pixel;
    g.stroke();
    if (body.is_robot) { // its nose
      g.beginPath();
      g.moveTo(0, 0);
      g.lineTo(circle || Math.max(...corners.map(([a]) => a)), 0);
      g.lineWidth = 2 * pixel;
      g.stroke();
    }
    g.restore();
  }

  _names(g, robots, scale, colour) {
    g.font = `${12 * this.ratio}px system-ui`;
    g.fillStyle = colour;
    const { e, f } = g.getTransform();
    g.setTransform(1, 0, 0, 1, 0, 0);
    const { width } = this.canvas;
    for (const each of robots) {
      const [x, y] = poseAt(each, this._index(each, this.at)), beside = 0.8 * scale * (each.circle || Math.max(...each.corners.flat())) + 4 * this.ratio;
      const at = e + scale * x, side = at > width * 0.7 ? -1 : 1; // near the edge it stands at the left
      g.textAlign = side < 0 ? "right" : "left";
      g.fillText(each.name, at + side * beside, f - scale * y - beside);
    }
  }
}

function poseAt({ path }, index) {
  const at = 3 * Math.floor(index), rest = index % 1, [x, y, theta] = path.slice(at, at + 3);
  if (!rest || at + 3 >= path.length) return [x, y, theta];
  const turn = Math.atan2(Math.sin(path[at + 5] - theta), Math.cos(path[at + 5] - theta));
  return [x + rest * (path[at + 3] - x), y + rest * (path[at + 4] - y), theta + rest * turn];
}

function trace(g, body, index) {
  for (let i = 0; i <= index; i++) g.lineTo(body.path[3 * i], body.path[3 * i + 1]);
  g.lineTo(...poseAt(body, index).slice(0, 2));
}

/** Box around all walls and poses, with a margin. */
function boxOf({ walls, bodies }) {
  const xs = [], ys = [];
  for (const [x, y, toX, toY] of walls) { xs.push(x, toX); ys.push(y, toY); }
  for (const { path } of bodies) path.forEach((value, i) => [xs, ys, []][i % 3].push(value));
  const [left, bottom] = [xs, ys].map((each) => each.reduce((a, b) => Math.min(a, b), Infinity) - MARGIN);
  const [right, top] = [xs, ys].map((each) => each.reduce((a, b) => Math.max(a, b), -Infinity) + MARGIN);
  return [left, bottom, right, top];
}
