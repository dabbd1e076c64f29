// World panel: the world from above, with maps, robots, lidar, paths and markers; goal and initial pose by click.

import { button, h, isTyping } from "../dom.js";
import { compose, IDENTITY, inverse, yawOf } from "../tf.js";
import { arrow, cased, degrees, dots, isGoal } from "./world_layers.js";
import { faint } from "./world_pixels.js";
import { Scene } from "./world_scene.js";
import { View } from "./world_view.js";

/** What is drawn beside the topics, by names. */
const OVERLAYS = ["grid", "trails", "tf", "names"];
const TOOLS = {
  goal: { type: "geometry_msgs/msg/PoseStamped", name: "goal_pose", text: "goal" },
  initial: { type: "geometry_msgs/msg/PoseWithCovarianceStamped", name: "initialpose", text: "pose" },
};
const WIDTH = 44, HEIGHT = 24, MIDDLE = HEIGHT / 2; // of a picture in the list of layers
const ERROR = 40; // level of a log
const COVARIANCE = new Array(36).fill(0);
COVARIANCE[0] = COVARIANCE[7] = 0.25; // as rviz has it
COVARIANCE[35] = 0.0685;

class World {
  constructor(element, app, options) {
    this.app = app;
    this.words = app.words;
    this.followed = options.follow ?? "";
    this.tool = null;
    this.canvas = h("canvas", { class: "world", tabIndex: 0, role: "application", "aria-label": this.words("panel.world") });
    this.status = h("output", { class: "status" });
    this.note = h("p", { class: "hint" });
    element.append(this.canvas, this._toolbar(), this._menu(), this.note, this.status);
    this.view = new View(this.canvas, this._pointerTool());
    this.view.onpan = () => this._follow("");
    if (options.view) {
      this.view.look(...options.view);
      this.view.auto = false;
    }
    this.scene = new Scene(app, this.view, new Set(options.off ?? []), new Set(options.on ?? []));
    this.offs = [app.store.on("change", () => this.scene.follow()), app.on("theme", () => this.scene.theme()), app.store.on("forget", () => this.scene.forget())];
    this.scene.follow();
    this.keys = (event) => this._key(event);
    element.closest(".panel").addEventListener("keydown", this.keys);
    this.element = element;
  }

  /** The fixed frame that was chosen, or "". */
  get fixed() { return this.app.settings.fixed ?? ""; }

  save() {
    const { x, y, scale, auto } = this.view;
    return { follow: this.followed, off: [...this.scene.off], on: [...this.scene.on], view: auto ? undefined : [x, y, scale] };
  }

  close() {
    for (const off of this.offs) off();
    this.element.closest(".panel")?.removeEventListener("keydown", this.keys);
    this.watched?.close();
    this.scene.close();
  }

  frame(now) {
    if (!(now - this.slow < 500)) {
      this.slow = now;
      this._slowly();
    }
    const fresh = this.scene.take();
    const robot = this.followed && this.scene.robots().find(({ name }) => name === this.followed);
    if (robot) this.view.look(robot.pose.x, robot.pose.y);
    if (fresh || this.view.changed || this.scene.groundChanged || this.scene.wanted) this.scene.draw(now);
    if (this.view.pointer && now - (this.hovered ?? 0) > 100) this._hover(now);
  }

  /** What need not be done in each frame: menus, the note, and the fit until somebody moves the view. */
  _slowly() {
    const names = this.app.tf.names(), { scene } = this;
    this._choices(this.fixedMenu, ["", ...names], this.fixed, (name) => name || `(${this.app.tf.fixed})`);
    this._choices(this.followMenu, ["", ...scene.robots().map(({ name }) => name)], this.followed, (name) => name || "–");
    this._chooseFixed(names);
    this._layers();
    scene.settle();
    this.note.textContent = scene.layers.size || names.length
      ? (scene.loose.size ? this.words("world.unconnected", { frame: this.app.tf.fixed, frames: [...scene.loose].map((name) => name || "''").join(", ") }) : "") : this.words("world.none");
    if (!this.view.auto) return;
    this.view.covered = this.bar.offsetHeight > 80 ? this.bar.offsetWidth : 0; // closed, as on a phone, it covers a corner
    const box = scene.bounds(), [left, top] = this.view.toWorld(0, 0), [right, bottom] = this.view.toWorld(this.canvas.clientWidth, this.canvas.clientHeight);
    if (box && (!this.fitted || box[0] < left || box[1] < bottom || box[2] > right || box[3] > top)) this.view.fit(box);
    this.fitted ||= Boolean(box);
  }

  /** The fixed frame: what was chosen, or map, world, odom, or the first root. */
  _chooseFixed(names) {
    const { tf } = this.app;
    const wanted = this.fixed || ["map", "world", "odom"].find((name) => names.includes(name)) || (names.length ? tf.root(names[0]) : "map");
    if (wanted === tf.fixed) return;
    tf.fixed = wanted;
    this.scene.loose.clear(); // of the frame before: no note flashes as the page opens
    tf.clearCache();
    tf.version += 1;
    this.scene.groundChanged = true;
  }

  _choices(menu, names, chosen, text) {
    const key = names.join("\n") + text("");
    if (menu.dataset.key === key || document.activeElement === menu) return;
    menu.dataset.key = key;
    menu.replaceChildren(...names.map((name) => h("option", { value: name, selected: name === chosen }, text(name))));
  }

  _follow(name) {
    if (this.followed === name) return;
    this.followed = name;
    this.followMenu.value = name;
    if (name) this.view.auto = false;
    this.app.remember();
  }

  fit() {
    const box = this.scene.bounds();
    this._follow("");
    this.view.auto = true;
    if (box) this.view.fit(box);
  }

  _toolbar() {
    const { words } = this, tool = (name) => button(words(`world.tool.${TOOLS[name].text}`), words(`world.${name}`), () => this._use(name), { class: `tool-${name}`, ariaPressed: "false" });
    this.toolButtons = { goal: tool("goal"), initial: tool("initial") };
    this.target = h("select", { class: "target", hidden: true, "aria-label": words("panel.topics") });
    this.bar = h("div", { class: "toolbar", role: "toolbar", "aria-label": words("panel.world") },
      button("☰", words("world.layers"), () => this._turnMenu(), { class: "layers-button", ariaExpanded: "false" }),
      button(words("world.tool.fit"), words("world.fit"), () => this.fit(), { class: "fit" }),
      button("+", words("world.zoomin"), () => this.view.zoom(1.25)), button("−", words("world.zoomout"), () => this.view.zoom(0.8)),
      ...(this.app.isBag ? [] : [...Object.values(this.toolButtons), this.target]));
    return this.bar;
  }

  /** What the view follows, its fixed frame, and the layers. */
  _menu() {
    const { words } = this, menu = (name, onchange) => h("select", { "aria-label": words(`world.${name}`), class: name, onchange });
    this.fixedMenu = menu("fixed", () => {
      this.app.settings.fixed = this.fixedMenu.value; // one for all panels: they share the tree of frames
      this.slow = undefined;
      this.app.remember();
    });
    this.followMenu = menu("follow", () => this._follow(this.followMenu.value));
    this.list = h("div", { class: "list", role: "group", "aria-label": words("world.layers") });
    this.menu = h("div", { class: "layers", hidden: true, tabIndex: -1 }, h("label", {}, words("world.follow"), this.followMenu), h("label", {}, words("world.fixed"), this.fixedMenu), this.list);
    return this.menu;
  }

  _turnMenu(isOpen = this.menu.hidden) {
    this.menu.hidden = !isOpen;
    const opener = this.bar.firstChild;
    this.bar.classList.toggle("open", isOpen);
    opener.ariaExpanded = String(isOpen);
    this._layers();
    if (isOpen) this.menu.focus();
    else opener.focus();
  }

  _layers() {
    if (this.menu.hidden) return;
    const { scene } = this, rows = [...OVERLAYS, ...[...scene.layers.keys()].sort()];
    const key = rows.map((name) => `${name} ${scene.shows(name)} ${scene.layers.get(name)?.layer.colour}`).join("\n");
    if (this.list.dataset.key !== key) {
      this.list.dataset.key = key;
      this.list.replaceChildren(...rows.map((name) => this._row(name)));
    }
    for (const each of this.list.querySelectorAll("canvas")) legend(each, scene, each.dataset.name);
  }

  _row(name) {
    const { scene } = this, box = h("input", { type: "checkbox", checked: scene.shows(name), value: name, onchange: () => {
      scene.show(name, box.checked);
      this.app.remember();
    } });
    const swatch = h("canvas", { class: "swatch", width: 44, height: 24, "data-name": name });
    return h("label", { title: scene.layers.get(name)?.topic.type ?? "" }, box, swatch, OVERLAYS.includes(name) ? this.words(`world.${name}`) : name);
  }

  _hover(now) {
    this.hovered = now;
    const [x, y] = this.view.pointer;
    this.status.textContent = [`x ${x.toFixed(2)}  y ${y.toFixed(2)}`, ...this.scene.hover(this.view.pointer)].join("  ·  ");
  }

  _key(event) {
    if (isTyping(event.target) || event.ctrlKey || event.metaKey || event.altKey) return undefined;
    if (this.tool && this._aim(event)) return event.preventDefault();
    const acts = { f: () => this.fit(), g: () => this._use("goal"), i: () => this._use("initial"), m: () => this._turnMenu(),
      Escape: () => (this.menu.hidden ? this._use(null) : this._turnMenu(false)) };
    if (!acts[event.key]) return undefined;
    event.preventDefault();
    acts[event.key]();
    if (this.tool) this.scene.wanted = { x: this.view.x, y: this.view.y, yaw: 0 };
    return undefined;
  }

  /** Move the pose that is being set by arrow keys, turn it with shift, and send it by Enter; false for another key. */
  _aim({ key, shiftKey }) {
    const { wanted } = this.scene, [dx, dy] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key] ?? [];
    if (!wanted || (dx === undefined && key !== "Enter")) return false;
    const step = 12 * this.view.ratio / this.view.scale;
    if (key === "Enter") this._send();
    else if (shiftKey) wanted.yaw -= ((dx || dy) * Math.PI) / 12;
    else Object.assign(wanted, { x: wanted.x + dx * step, y: wanted.y + dy * step });
    return true;
  }

  /** Take a tool in the hand, or put it away. */
  _use(name) {
    const { connection, isBag } = this.app;
    if (isBag) return undefined;
    if (name && connection.isReadOnly) return this.app.tell(this.words("read-only.why"), true);
    this.tool = name === this.tool ? null : name;
    for (const [each, element] of Object.entries(this.toolButtons)) element.ariaPressed = String(each === this.tool);
    this.canvas.classList.toggle("aiming", Boolean(this.tool));
    this.status.textContent = this.tool ? this.words("world.tool") : "";
    this.scene.wanted = null;
    this.scene.dirty = true;
    this._targets();
    return undefined;
  }

  /** Topics that the tool may publish to: those that somebody subscribes to, first. */
  _targets() {
    const tool = TOOLS[this.tool], { types } = this.app.connection.graph;
    const found = tool ? [...types].filter(([name, type]) => type === tool.type && name.split("/").pop() === tool.name).map(([name]) => name) : [];
    const names = found.length ? found.sort() : tool ? [`/${tool.name}`] : [];
    this.target.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
    this.target.hidden = names.length < 2;
  }

  _pointerTool() {
    const world = this;
    return {
      get active() { return world.tool !== null; },
      begin: ([x, y]) => { this.scene.wanted = { x, y, yaw: 0 }; },
      drag: ([x, y], far) => {
        const { wanted } = this.scene;
        if (wanted && far) wanted.yaw = Math.atan2(y - wanted.y, x - wanted.x);
      },
      end: () => this._send(),
    };
  }

  /** A pose of the fixed frame as navigation takes it: in the frame map, where that is connected. */
  _inMap({ x, y, yaw }) {
    const { tf } = this.app, map = tf.names().includes("map") && tf.lookup("map");
    if (!map) return { fixed: tf.fixed, x, y, yaw };
    const pose = compose(inverse(map), { ...IDENTITY, x, y, qz: Math.sin(yaw / 2), qw: Math.cos(yaw / 2) });
    return { fixed: "map", x: pose.x, y: pose.y, yaw: yawOf(pose) };
  }

  /** Show the error that ends a goal, as the node that it was sent to logs it: until a robot has come there. */
  _watch(topic, since) {
    const names = this.app.connection.graph.subscribed.get(topic).map((name) => name.slice(1).replaceAll("/", ".")), { layer } = this.scene.layers.get(topic);
    this.watched?.close();
    this.watched = this.app.listen("/rosout", { every: (view, _, source) => {
      const { level, name, msg, stamp } = source.decode(view) ?? {};
      if (!(level >= ERROR) || !names.includes(name) || stamp.sec + stamp.nanosec / 1e9 < since / 1000 || layer.reached) return;
      this.app.tell(msg, true);
      layer.reached = this.scene.dirty = true;
    } });
  }

  _send() {
    const { type } = TOOLS[this.tool], topic = this.target.value, { fixed, x, y, yaw } = this._inMap(this.scene.wanted);
    const at = this.app.clock(), sec = Math.floor(at / 1000);
    const header = { stamp: { sec, nanosec: Math.floor((at - sec * 1000) * 1e6) }, frame_id: fixed };
    const pose = { position: { x, y, z: 0 }, orientation: { x: 0, y: 0, z: Math.sin(yaw / 2), w: Math.cos(yaw / 2) } };
    const message = { header, pose: this.tool === "initial" ? { pose, covariance: COVARIANCE } : pose }, isHeard = this.app.connection.graph.subscribed.get(topic)?.length > 0;
    if (!this.app.connection.publish(topic, type, message)) this.app.tell(this.words("lost"), true);
    else if (isHeard) {
      this.app.tell(this.words("world.sent", { topic, x: x.toFixed(2), y: y.toFixed(2), degrees: degrees(yaw).slice(0, -1), frame: fixed }));
      this.scene.sent(topic, type, message);
      if (isGoal(topic)) this._watch(topic, Date.now() - 50); // the system's clock, as nodes have it: performance's goes on by itself
    } else this.app.tell(this.words(isGoal(topic) ? "world.unheard.goal" : "world.unheard", { topic }), true);
    this._use(null);
  }
}

/** Draw what a row of the list shows into its canvas of 44 by 24 pixels. */
function legend(canvas, scene, name) {
  const context = canvas.getContext("2d"), { layer, kind } = scene.layers.get(name) ?? {}, { colours } = scene;
  context.clearRect(0, 0, WIDTH, HEIGHT);
  if (layer?.colours) {
    layer.colours.forEach((colour, i, all) => {
      context.fillStyle = colour;
      context.fillRect((i * WIDTH) / all.length, 0, WIDTH / all.length, HEIGHT);
    });
  } else FORMS[kind?.form ?? name]?.(context, layer?.colour ?? colours.trail, scene);
}

function line(context, ...places) {
  context.beginPath();
  for (const place of places) context.lineTo(...place);
}

const FORMS = {
  beams(context, colour, { colours }) {
    const ends = [5, 10, 14, 19].map((y) => [39, y]);
    context.fillStyle = faint(colour, 0.22);
    line(context, [3, MIDDLE], ...ends);
    context.fill();
    dots(context, ends, colours.halo, colour, 1);
  },
  line(context, colour, { colours }) {
    line(context, [4, 17], [22, MIDDLE], [40, MIDDLE]);
    cased(context, colours, colour, 4);
  },
  ring(context, colour, { colours }) {
    context.beginPath();
    context.arc(22, MIDDLE, 6, 0, 7);
    cased(context, colours, colour, 3);
  },
  area(context, colour) {
    line(context, [38, 3], [6, MIDDLE], [38, 21]);
    context.fillStyle = faint(colour, 0.22);
    context.fill();
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.stroke();
  },
  arrow(context, colour, { colours }) {
    context.beginPath();
    arrow(context, 7, MIDDLE, 0, 30);
    cased(context, colours, colour, 3);
  },
  swarm(context, colour, { colours }) {
    dots(context, [[22, MIDDLE], [16, 8], [27, 7], [30, 15], [15, 16], [23, 19], [9, 11], [36, 10]], colours.halo, colour, 1);
  },
  tf(context, _, { colours }, names = ["axis-x", "axis-y"]) {
    names.forEach((name, i) => {
      line(context, [16, 19], i ? [16, 3] : [36, 19]);
      context.strokeStyle = colours[name];
      context.lineWidth = 3;
      context.stroke();
    });
  },
  grid(context, _, scene) { FORMS.tf(context, _, scene, ["grid", "grid"]); },
  names(context, _, scene) {
    context.font = "16px system-ui";
    context.textAlign = "center";
    scene.write(context, "Aa", 22, 18);
  },
};
FORMS.trails = FORMS.line;

export const panel = { id: "world", create: (element, app, options) => new World(element, app, options) };
