// Scene of the world panel: its layers, the robots, and one picture of them a frame.

import { yawOf, IDENTITY } from "../tf.js";
import { cased, degrees, goal, KINDS } from "./world_layers.js";
import { Pixels, pixel } from "./world_pixels.js";
import { drawRobots, reachOf, robotsOf } from "./world_markers.js";
import { around } from "./world_view.js";

const ROBOTS = 5; // between the orders of layers: robots are drawn here
const SERIES = 8; // colours --c1 to --c8
const MOST_NAMES = 40, MOST_SMOOTH = 30; // names that are written; robots whose scans and trails are drawn by smooth paths
const ROLES = { back: "ground", halo: "ground", text: "fg" }, NAMES = ["grid", "dim", "robot", "goal", "scan", "trail", "path", "local", "particles", "camera", "axis-x", "axis-y"];
const QUIET = /(^|\/)(ground_truth|depth\/camera_info|initialpose|global_costmap\/published_footprint|(transformed|received)_global_plan)$/; // shown only where it is switched on: what is like another layer

export class Scene {
  /** @param view camera  @param off, on names of layers that are switched off, and on against the default */
  constructor(app, view, off, on) {
    Object.assign(this, { app, view, off, on });
    this.frames = app.tf;
    this.layers = new Map(); // by topic name: {layer, kind, seen, shown, handle}
    this.odometry = new Map();
    this.bodies = new Map(); // markers of robots by frame
    this.stamps = new Map();
    this.drawn = []; // robots of the last picture
    this.pixels = new Pixels(view);
    this.context = view.canvas.getContext("2d", { alpha: false });
    this.loose = new Set(); // frames that are not connected to the fixed one
    this.groundChanged = true;
    this.now = 0;
    this.wanted = null; // a pose that is being set
    this.many = false;
    this.theme();
  }

  theme() {
    const { colour } = this.app, [free, wall] = this.app.isLight() ? [[255, 150], [40, 255]] : [[255, 26], [225, 255]];
    this.colours = Object.fromEntries([...Object.entries(ROLES), ...NAMES.map((name) => [name, name])].map(([name, variable]) => [name, colour(variable)]));
    this.series = Array.from({ length: SERIES }, (_, i) => colour(`c${i + 1}`));
    const cell = (i) => { // free floor lets see what is below, a wall does not
      const [grey, alpha] = free.map((from, k) => Math.round(from + ((wall[k] - from) * i) / 100));
      return ((alpha << 24) | (grey << 16) | (grey << 8) | grey) >>> 0;
    };
    this.occupancy = new Uint32Array(256).map((_, i) => (i <= 100 ? cell(i) : 0));
    this.costs = new Uint32Array(256).map((_, i) => cost(i));
    for (const entry of this.layers.values()) if (entry.seen && entry.layer.map) this._update(entry, entry.layer.message);
    this.stamps.clear();
    this.pixels.halo = pixel(this.colours.halo);
    this._paint();
  }

  /** Give each layer its colour: its role's, or where there are several robots, that of the robot whose topic it is. */
  _paint() {
    const entries = [...this.layers].sort(([a], [b]) => (a < b ? -1 : 1)), used = new Set();
    const spaces = entries.filter(([, { topic }]) => topic.type === "nav_msgs/msg/Odometry").map(([name]) => name.slice(0, name.lastIndexOf("/") + 1));
    this.spaces = [...new Set(spaces)];
    let next = 1; // the first one is like that of trails
    for (const [name, { layer, kind, topic }] of entries) {
      const role = kind.role === "path" && layer.above ? "local" : kind.role, key = `${topic.type} ${role}`;
      const own = this.spaces.length > 1 && this.spaceColour(name);
      const isFirst = role && !used.has(key) && !QUIET.test(name);
      layer.colour = own || (isFirst ? this.colours[role] : this.series[next++ % SERIES]);
      if (isFirst) used.add(key);
    }
    this.groundChanged = this.dirty = true;
  }

  /** Colour of the robot of a topic, or undefined. */
  spaceColour(name) {
    const at = this.spaces.findIndex((each) => name.startsWith(each));
    return at < 0 ? undefined : this.series[at % SERIES];
  }

  /** Follow the topics that exist: a layer for each that can be drawn. */
  follow() {
    const { size } = this.layers;
    for (const topic of this.app.topics.values()) {
      const kind = topic.channel && !topic.channel.hidden && KINDS[topic.type];
      if (kind && !this.layers.has(topic.name)) this._open(topic, kind);
    }
    if (this.layers.size > size) this._paint();
  }

  _open(topic, kind) {
    const entry = { layer: new kind.make(topic), kind, topic, seen: null, handle: null };
    this.layers.set(topic.name, entry);
    if (this.shows(topic.name)) this._listen(entry);
    return entry;
  }

  /** Show a message that the page itself publishes. */
  sent(name, type, message) {
    const entry = this.layers.get(name) ?? this._open(this.app.store.get(name), KINDS[type]);
    entry.own = true;
    entry.seen = message;
    this._update(entry, message);
    this._paint();
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
    this[wanted ? "off" : "on"].delete(name);
    this[wanted ? "on" : "off"].add(name);
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
    for (const entry of this.layers.values()) {
      entry.layer.forget?.();
      entry.own = false;
    }
    this.groundChanged = this.dirty = true;
  }

  /** True if a layer, or one of tf, trails, grid and names, is shown. */
  shows(name) { return this.on.has(name) || !(this.off.has(name) || QUIET.test(name) || (name === "tf" && this.drawn.length > 0)); }

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
    return [...this.layers.values()].filter(({ handle, layer, seen, topic, own }) => handle && (seen || layer.shown?.size) && (topic.channel || own || !connection.isOpen));
  }

  /** Look whether maps have moved in the fixed frame: seldom, since the ground is drawn anew then. */
  settle() {
    const places = this._visible().map(({ layer }) => layer.groundKey?.(this) ?? "");
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
    const visible = this._visible().sort((a, b) => a.kind.order - b.kind.order || (a.layer.above ?? 0) - (b.layer.above ?? 0)), { pixels, context } = this, { size } = this.bodies;
    this.bodies.clear();
    this._parts(visible, "bodies", this);
    const robots = this.drawn = this.robots();
    this.many = robots.length > MOST_SMOOTH || visible.length > 2 * MOST_SMOOTH;
    if (pixels.resize() || this.view.changed || this.groundChanged || size !== this.bodies.size) this._ground(visible);
    pixels.begin();
    this._parts(visible, "pixels", this);
    if (this.shows("tf")) this._frames();
    context.putImageData(pixels.image, 0, 0);
    this._parts(visible.filter(({ kind }) => kind.order < ROBOTS), "draw", context, this);
    drawRobots(context, this, robots);
    this._parts(visible.filter(({ kind }) => kind.order > ROBOTS), "draw", context, this);
    if (this.shows("names") && !this.many) this._names(context, robots);
    if (this.wanted) goal(context, this, this.wanted, this.colours.goal);
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
    this._parts(visible, "floor", context, this);
    this._parts(visible, "map", context, this);
    if (this.shows("grid")) this._grid(context);
    this._parts(visible, "ground", context, this);
    this.pixels.keepGround();
    this._parts(visible, "groundPixels", this);
  }

  _grid(context) {
    const { view } = this, { width, height } = this.pixels;
    let step = 1;
    for (let i = 0; step * view.scale < 24 || step * view.scale > 240; i++) step = step * view.scale < 24 ? step * (i % 2 ? 2 : 5) : step / (i % 2 ? 2 : 5);
    context.strokeStyle = this.colours.grid;
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
    this._font(context, 11);
    const low = height - 8 * view.ratio, begin = 10 * view.ratio;
    this.write(context, `${Number(step.toPrecision(2))} m`, begin, low - 6 * view.ratio);
    context.beginPath();
    context.moveTo(begin, low);
    context.lineTo(begin + step * view.scale, low);
    cased(context, this.colours, this.colours.text, 2 * view.ratio);
  }

  /** Robots with what is drawn of them: {name, frame, pose, body, colour}. */
  robots() {
    return robotsOf(this).map((robot) => ({ ...robot, body: this.bodies.get(robot.frame), colour: (this.spaces.length > 1 && this.spaceColour(`/${robot.name}/`)) || this.colours.trail }));
  }

  _font(context, size, align = "left") {
    context.font = `${size * this.view.ratio}px system-ui`;
    context.textAlign = align;
    context.textBaseline = "alphabetic";
  }

  /** Write a text that can be read on any floor. */
  write(context, text, x, y, colour = this.colours.text) {
    context.lineJoin = "round";
    context.lineWidth = 3 * this.view.ratio;
    context.strokeStyle = this.colours.halo;
    context.strokeText(text, x, y);
    context.fillStyle = colour;
    context.fillText(text, x, y);
  }

  /** Names: of robots where there are several, and of frames where they are shown. */
  _names(context, robots) {
    const { view } = this;
    this._font(context, 12);
    for (const robot of robots.length > 1 ? robots : []) {
      const radius = Math.max(reachOf(robot) * view.scale, 5 * view.ratio);
      this.write(context, robot.name, view.toX(robot.pose.x) + radius, view.toY(robot.pose.y) - radius);
    }
    if (this.shows("tf")) this._frameNames(context, robots);
  }

  _frames() {
    const { view, pixels } = this, axes = ["axis-x", "axis-y"].map((name) => pixel(this.colours[name])), length = Math.max(0.25 * view.scale, 10 * view.ratio);
    for (const name of this.frames.names()) {
      const pose = this.frames.lookup(name);
      if (!pose) continue;
      const x = view.toX(pose.x), y = view.toY(pose.y), yaw = yawOf(pose), cos = length * Math.cos(yaw), sin = length * Math.sin(yaw);
      pixels.line(x, y, x + cos, y - sin, axes[0]);
      pixels.line(x, y, x - sin, y - cos, axes[1]);
    }
  }

  /** Names of frames; those of a robot's parts can be read once they are apart. */
  _frameNames(context, robots) {
    const { view } = this, apart = 40 * view.ratio / view.scale, near = (a, b) => Math.hypot(a.x - b.x, a.y - b.y) < apart;
    const poses = this.frames.names().map((name) => [name, this.frames.lookup(name)]).filter(([, pose]) => pose && !robots.some((each) => near(each.pose, pose)));
    if (poses.length > MOST_NAMES) return;
    this._font(context, 10);
    const rows = new Map(); // names of frames at one place go below each other
    for (const [name, pose] of poses) {
      const x = Math.round(view.toX(pose.x)), y = Math.round(view.toY(pose.y)), key = `${x >> 4},${y >> 4}`, row = rows.get(key) ?? 1;
      rows.set(key, row + 1);
      this.write(context, name, x + 6, y + row * 12 * view.ratio, this.colours.dim);
    }
  }

  /** Rectangle around all that is shown, or null. */
  bounds() {
    const boxes = this._visible().map(({ layer }) => layer.bounds(this)).filter(Boolean);
    return around([...boxes.flatMap(([left, bottom, right, top]) => [{ x: left, y: bottom }, { x: right, y: top }]), ...this.robots().map(({ pose }) => pose)]);
  }

  /** What is at a place: texts with the topic's name. */
  hover([x, y]) {
    const reach = (8 * this.view.ratio) / this.view.scale, found = [];
    for (const robot of this.drawn) {
      const { name, pose } = robot;
      if (Math.hypot(pose.x - x, pose.y - y) < Math.max(reach, reachOf(robot))) found.push(`${name} (${pose.x.toFixed(2)}, ${pose.y.toFixed(2)}, ${degrees(yawOf(pose))})`);
    }
    for (const { layer, topic } of this._visible()) {
      const text = found.length < 6 && layer.hover(x, y, reach, this);
      if (text) found.push(`${topic.name} ${text}`);
    }
    return found;
  }
}

/** Colour of a cost, of rviz's kind but so that the map is seen through it: nothing at 0, from blue to red, cyan at 99, magenta at 100. */
function cost(value) {
  if (value === 0 || value > 100) return 0;
  if (value === 100) return 0x80ff00ff;
  if (value === 99) return 0x48ffff00;
  return ((Math.round(24 + 0.7 * value) << 24) | (Math.round(255 - 2.55 * value) << 16) | Math.round(2.55 * value)) >>> 0;
}
