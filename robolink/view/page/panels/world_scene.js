// Scene of the world panel: its layers, the robots, and one picture of them a frame.

import { compose, poseOf, yawOf, IDENTITY } from "../tf.js";
import { arrow, degrees, KINDS } from "./world_layers.js";
import { Pixels, pixel } from "./world_pixels.js";
import { around } from "./world_view.js";

const COLOURS = ["#ffb300", "#29b6f6", "#66bb6a", "#ef5350", "#ab47bc", "#26c6da", "#d4e157", "#ff7043", "#ec407a"];
const MOST_NAMES = 40, MOST_SMOOTH = 30; // names that are written; robots that are drawn by smooth paths
const AXES = [pixel("#ef5350"), pixel("#43a047")]; // x and y of a frame
const ROBOT = /(^|\/)(base_link|base_footprint)$/;
const BODY = 0.15; // metres: radius of a robot whose shape nobody tells

export class Scene {
  /** @param view camera  @param off names of layers that are switched off */
  constructor(app, view, off) {
    this.app = app;
    this.view = view;
    this.off = off;
    this.frames = app.tf;
    this.layers = new Map(); // by topic name: {layer, kind, seen, shown, handle}
    this.odometry = new Map();
    this.pixels = new Pixels(view);
    this.context = view.canvas.getContext("2d", { alpha: false });
    this.loose = new Set(); // frames that are not connected to the fixed one
    this.groundChanged = true;
    this.now = 0;
    this.wanted = null; // a pose that is being set
    this.theme();
  }

  theme() {
    const { colour } = this.app;
    this.colours = { back: colour("ground"), line: colour("line"), text: colour("fg"), robot: colour("accent"), dim: colour("dim") };
    const grey = (value) => (0xff000000 | (value << 16) | (value << 8) | value) >>> 0;
    const [free, wall] = this.app.isLight() ? [250, 40] : [44, 225];
    this.occupancy = new Uint32Array(256).map((_, i) => (i <= 100 ? grey(Math.round(free + ((wall - free) * i) / 100)) : 0));
    this.costs = new Uint32Array(256).map((_, i) => cost(i));
    for (const entry of this.layers.values()) if (entry.seen && entry.layer.ground) this._update(entry, entry.layer.message);
    this.groundChanged = true;
  }

  /** Follow the topics that exist: a layer for each that can be drawn. */
  follow() {
    for (const topic of this.app.topics.values()) {
      const kind = topic.channel && !topic.channel.hidden && KINDS[topic.type];
      if (kind && !this.layers.has(topic.name)) this._open(topic, kind);
    }
  }

  _open(topic, kind) {
    const layer = new kind.make(topic, COLOURS[this.layers.size % COLOURS.length]);
    const entry = { layer, kind, topic, seen: null, handle: null };
    this.layers.set(topic.name, entry);
    if (!this.off.has(topic.name)) this._listen(entry);
  }

  _listen(entry) {
    const every = entry.kind.every && ((view) => {
      const message = entry.topic.decode(view);
      if (message) entry.layer.update(message, this);
      this.dirty = true;
    });
    entry.handle = this.app.listen(entry.topic.name, { rate: entry.kind.rate, every });
  }

  show(name, wanted) {
    if (wanted) this.off.delete(name);
    else this.off.add(name);
    const entry = this.layers.get(name);
    if (entry && wanted !== Boolean(entry.handle)) {
      if (wanted) this._listen(entry);
      else {
        entry.handle.close();
        entry.handle = entry.seen = null;
      }
    }
    this.groundChanged = this.dirty = true;
  }

  /** Forget what layers have gathered of messages before. */
  forget() {
    this.odometry.clear();
    for (const { layer } of this.layers.values()) layer.forget?.();
    this.groundChanged = this.dirty = true;
  }

  /** True if a layer, or one of tf, trails, grid and names, is shown. */
  shows(name) { return !this.off.has(name); }

  close() { for (const { handle } of this.layers.values()) handle?.close(); }

  /** Pose of a frame in the fixed one; where they are not connected, the origin, and the note says so. */
  pose(frame) { return this.known(frame) ?? IDENTITY; }

  /** Pose of a frame in the fixed one, or null. */
  known(frame) {
    const found = this.frames.lookup(frame);
    if (found) return found;
    const root = this.frames.root(frame);
    if (this.loose.size < 5) this.loose.add(root);
    return root === frame ? null : this._loosely(frame, root);
  }

  _loosely(frame, root) { // from its own root, as if that stood at the origin
    const { fixed } = this.frames;
    this.frames.fixed = root;
    this.frames.clearCache();
    const found = this.frames.lookup(frame);
    this.frames.fixed = fixed;
    this.frames.clearCache();
    return found;
  }

  /** Layers that have something to show; those of topics that are gone have not. */
  _visible() {
    const { connection } = this.app;
    return [...this.layers.values()].filter(({ handle, layer, seen, topic }) => handle && (seen || layer.shown?.size) && (topic.channel || !connection.isOpen));
  }

  /** Look whether maps have moved in the fixed frame: seldom, since the ground is drawn anew then. */
  settle() {
    const places = this._visible().filter(({ layer }) => layer.ground).map(({ layer }) => Object.values(layer.frame(this)).join());
    const key = `${this.frames.fixed} ${places.join(" ")}`;
    this.groundChanged ||= key !== this.groundKey;
    this.groundKey = key;
  }

  /** Take what is new; true if anything was. */
  take() {
    let any = this.dirty;
    this.dirty = false;
    this.trailStep = Math.max(0.02, 2 / this.view.scale);
    for (const entry of this.layers.values()) {
      if (!entry.handle || entry.kind.every) continue;
      const { view } = entry.topic;
      if (view === entry.seen || view === entry.failed || !view) continue;
      const message = entry.topic.latest;
      entry.seen = message && view;
      if (message && this._update(entry, message)) any = entry.fresh = true;
    }
    if (this.tfVersion !== this.frames.version) any = true;
    return any;
  }

  _update(entry, message) {
    try {
      entry.layer.update(message, this);
      return true;
    } catch (error) {
      this._fail(entry, error);
      return false;
    }
  }

  /** Leave a layer out until its next message: this one cannot be drawn. */
  _fail(entry, error) {
    entry.topic.error = `${error}`;
    entry.failed = entry.topic.view;
    entry.seen = null;
    entry.layer.shown?.clear();
  }

  /** Let each layer do its part of a picture. */
  _parts(entries, part, ...given) {
    for (const entry of entries) {
      try {
        entry.layer[part]?.(...given);
      } catch (error) {
        this._fail(entry, error);
      }
    }
  }

  draw(now) {
    this.now = this.app.now;
    this.loose.clear();
    this.tfVersion = this.frames.version;
    this.trails = this.shows("trails");
    const visible = this._visible().sort((a, b) => a.kind.order - b.kind.order), { pixels, context } = this;
    if (pixels.resize() || this.view.changed || this.groundChanged) this._ground(visible);
    pixels.begin();
    pixels.bold = visible.length < MOST_SMOOTH;
    this._parts(visible, "pixels", this);
    const robots = this.robots(), many = robots.length > MOST_SMOOTH;
    if (this.shows("tf")) this._frames();
    if (many) this._smallRobots(robots);
    context.putImageData(pixels.image, 0, 0);
    this._parts(visible.filter(({ seen, layer }) => seen || layer.shown), "draw", context, this);
    if (!many) this._robots(context, robots);
    if (this.shows("tf") && !many) this._frameNames(context, robots);
    if (this.wanted) this._wanted(context);
    if (this.app.painted) this._measure(visible);
  }

  _measure(visible) { // stamps of what became visible in this frame, for benchmarks
    const at = performance.timeOrigin + performance.now();
    for (const entry of visible) {
      const stamp = entry.fresh && entry.layer.message?.header?.stamp;
      if (stamp) this.app.painted.push([entry.topic.type, at - stamp.sec * 1000 - stamp.nanosec / 1e6]);
      entry.fresh = false;
    }
  }

  _ground(visible) {
    const { context } = this.pixels;
    this.view.changed = this.groundChanged = false;
    context.fillStyle = this.colours.back;
    context.fillRect(0, 0, this.pixels.width, this.pixels.height);
    this._parts(visible, "ground", context, this);
    if (this.shows("grid")) this._grid(context);
    this.pixels.keepGround();
    this._parts(visible, "groundPixels", this);
  }

  _grid(context) {
    const { view } = this, { width, height } = this.pixels;
    let step = 1;
    for (let i = 0; step * view.scale < 24 || step * view.scale > 240; i++) step = step * view.scale < 24 ? step * (i % 2 ? 2 : 5) : step / (i % 2 ? 2 : 5);
    context.strokeStyle = this.colours.line;
    context.lineWidth = 1;
    context.beginPath();
    const left = view.x - width / 2 / view.scale, bottom = view.y - height / 2 / view.scale;
    for (let x = Math.ceil(left / step) * step; view.toX(x) < width; x += step) {
      context.moveTo(Math.round(view.toX(x)) + 0.5, 0);
      context.lineTo(Math.round(view.toX(x)) + 0.5, height);
    }
    for (let y = Math.ceil(bottom / step) * step; view.toY(y) > 0; y += step) {
      context.moveTo(0, Math.round(view.toY(y)) + 0.5);
      context.lineTo(width, Math.round(view.toY(y)) + 0.5);
    }
    context.stroke();
    context.fillStyle = this.colours.dim;
    context.font = `${11 * view.ratio}px system-ui`;
    context.fillText(`${Number(step.toPrecision(2))} m`, 8, height - 8);
  }

  /** Robots: frames named base_link or base_footprint, and odometry whose frame tf does not know. {name, pose}. */
  robots() {
    const found = new Map();
    for (const name of this.frames.nodes.keys()) {
      if (!ROBOT.test(name)) continue;
      const robot = name.replace(ROBOT, "") || "robot";
      if (!found.has(robot) || name.endsWith("base_link")) found.set(robot, { name: robot, pose: this.pose(name) });
    }
    for (const [child, { message, topic }] of this.odometry) {
      if (this.frames.nodes.has(child) || !topic.channel) continue;
      const name = child.replace(ROBOT, "") || topic.name.replace(/^\/|\/[^/]*$/g, "") || "robot";
      if (!found.has(name)) found.set(name, { name, pose: compose(this.pose(message.header.frame_id), poseOf(message.pose.pose)) });
    }
    return [...found.values()];
  }

  _robots(context, robots) {
    const { view } = this, radius = this._radius();
    context.strokeStyle = context.fillStyle = this.colours.robot;
    context.beginPath();
    for (const { pose } of robots) {
      this._nose(pose, radius).forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
      context.closePath();
    }
    context.fill();
    if (!this.shows("names")) return;
    context.font = `${12 * view.ratio}px system-ui`;
    context.textAlign = "left";
    context.textBaseline = "alphabetic";
    context.fillStyle = this.colours.text;
    for (const { name, pose } of robots) context.fillText(name, view.toX(pose.x) + radius + 4, view.toY(pose.y) - radius);
  }

  _radius() { return Math.max(BODY * this.view.scale, 5 * this.view.ratio); }

  /** Corners of the triangle that shows where a robot is and where it looks. */
  _nose(pose, radius) {
    const x = this.view.toX(pose.x), y = this.view.toY(pose.y), yaw = yawOf(pose);
    return [[radius, 0], [0.8 * radius, 2.5], [0.8 * radius, -2.5]].map(([far, turn]) => [x + far * Math.cos(yaw + turn), y - far * Math.sin(yaw + turn)]);
  }

  /** Many robots are drawn by pixels: smooth paths would take longer than all the rest. */
  _smallRobots(robots) {
    const radius = this._radius(), colour = pixel(this.colours.robot);
    for (const { pose } of robots) {
      const [a, b, c] = this._nose(pose, radius);
      for (const [[x0, y0], [x1, y1]] of [[a, b], [b, c], [c, a]]) this.pixels.line(x0, y0, x1, y1, colour);
    }
  }

  _frames() {
    const { view, pixels } = this, length = Math.max(0.25 * view.scale, 10 * view.ratio);
    for (const name of this.frames.names()) {
      const pose = this.frames.lookup(name);
      if (!pose) continue;
      const x = view.toX(pose.x), y = view.toY(pose.y), yaw = yawOf(pose), cos = length * Math.cos(yaw), sin = length * Math.sin(yaw);
      pixels.line(x, y, x + cos, y - sin, AXES[0]);
      pixels.line(x, y, x - sin, y - cos, AXES[1]);
    }
  }

  /** Names of frames; those of a robot's parts can be read once they are apart. */
  _frameNames(context, robots) {
    const { view } = this, apart = 40 * view.ratio / view.scale, near = (a, b) => Math.hypot(a.x - b.x, a.y - b.y) < apart;
    const poses = this.frames.names().map((name) => [name, this.frames.lookup(name)]).filter(([, pose]) => pose && !robots.some((each) => near(each.pose, pose)));
    if (!this.shows("names") || poses.length > MOST_NAMES) return;
    context.font = `${10 * view.ratio}px system-ui`;
    context.textAlign = "left";
    context.fillStyle = this.colours.dim;
    const rows = new Map(); // names of frames at one place go below each other
    for (const [name, pose] of poses) {
      const x = Math.round(view.toX(pose.x)), y = Math.round(view.toY(pose.y)), key = `${x >> 4},${y >> 4}`, row = rows.get(key) ?? 1;
      rows.set(key, row + 1);
      context.fillText(name, x + 6, y + row * 12 * view.ratio);
    }
  }

  _wanted(context) {
    const { view } = this, { x, y, yaw } = this.wanted;
    context.strokeStyle = "#ec407a";
    context.lineWidth = 3;
    context.beginPath();
    arrow(context, view.toX(x), view.toY(y), yaw, 40 * view.ratio);
    context.stroke();
  }

  /** Rectangle around all that is shown, or null. */
  bounds() {
    const boxes = this._visible().map(({ layer }) => layer.bounds(this)).filter(Boolean);
    return around([...boxes.flatMap(([left, bottom, right, top]) => [{ x: left, y: bottom }, { x: right, y: top }]), ...this.robots().map(({ pose }) => pose)]);
  }

  /** What is at a place: texts with the topic's name. */
  hover([x, y]) {
    const reach = (8 * this.view.ratio) / this.view.scale, found = [];
    for (const { name, pose } of this.robots()) {
      if (Math.hypot(pose.x - x, pose.y - y) < Math.max(reach, BODY)) found.push(`${name} (${pose.x.toFixed(2)}, ${pose.y.toFixed(2)}, ${degrees(yawOf(pose))})`);
    }
    for (const { layer, topic } of this._visible()) {
      const text = found.length < 6 && layer.hover(x, y, reach, this);
      if (text) found.push(`${topic.name} ${text}`);
    }
    return found;
  }
}

/** Colour of a cost as rviz has it: nothing at 0, from blue to red, cyan at 99, magenta at 100. */
function cost(value) {
  if (value === 0 || value > 100) return 0;
  if (value === 100) return 0xb0ff00ff;
  if (value === 99) return 0xb0ffff00;
  return ((0x90000000 | (Math.round(255 - 2.55 * value) << 16) | Math.round(2.55 * value)) >>> 0);
}
