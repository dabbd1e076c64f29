// Turtlesim panel: the window of turtlesim as its node draws it, and a turtle that is driven by keys as by turtle_teleop_key.

import { h, isTyping } from "../dom.js";
import { addPairs } from "../words.js";
import { Images } from "./images.js";

addPairs("turtlesim", {
  turtle: ["turtle", "tartaruga"], none: ["no turtles", "nenhuma tartaruga"],
  keys: ["Arrow keys drive; G B V C D E R T turn to a heading, F cancels.", "As setas dirigem; G B V C D E R T giram para uma direção, F cancela."],
});

const POSE = "turtlesim/msg/Pose";
const DRIVES = { ArrowUp: [2, 0], ArrowDown: [-2, 0], ArrowLeft: [0, 2], ArrowRight: [0, -2] }; // m/s and rad/s
const TURNS = { g: 0, t: 0.7854, r: 1.5708, e: 2.3562, d: 3.1416, c: -2.3562, v: -1.5708, b: -0.7854 };

class Turtlesim extends Images {
  _build() {
    super._build();
    const { words } = this.app, { element } = this;
    this.menu = h("select", { class: "turtle", "aria-label": words("turtlesim.turtle"), title: words("turtlesim.turtle"), onchange: () => { this.turtle = this.menu.value; this.canvas.focus(); } });
    this.state.before(this.menu);
    element.append(h("p", { class: "dim hints" }, words("turtlesim.keys")));
    this.canvas.tabIndex = 0;
    element.addEventListener("keydown", (event) => this._key(event));
  }

  _names() { return [...this.app.store.map.values()].filter(({ channel, name }) => channel && name.endsWith("/_picture")).map(({ name }) => name).sort(); }

  /** The pictures, and the turtles that the chosen one shows: those below its node's namespace. */
  _list() {
    super._list();
    this.picker.element.hidden = this._names().length < 2;
    const space = this.topic.replace(/[^/]*[/]_picture$/, ""), { menu, app } = this;
    const turtles = app.store.list().filter(({ name, type, channel }) => channel && type === POSE && name.startsWith(space)).map(({ name }) => name.slice(0, -5));
    if (!turtles.includes(this.turtle)) this.turtle = turtles[0] ?? "";
    menu.replaceChildren(...(turtles.length ? turtles : [app.words("turtlesim.none")]).map((name) => h("option", { value: name }, name)));
    if (this.turtle) menu.value = this.turtle;
  }

  /** Take the keyboard when the picture comes, unless somebody uses it elsewhere. */
  _size(width, height) {
    const isFirst = this.canvas.hidden;
    super._size(width, height);
    if (isFirst && document.activeElement === document.body) this.canvas.focus();
  }

  _key(event) {
    const { app, turtle } = this, { connection } = app, key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (isTyping(event.target) || event.ctrlKey || event.metaKey || event.altKey || !turtle || !(key in DRIVES || key in TURNS || key === "f")) return;
    event.preventDefault();
    if (connection.isReadOnly) return void app.tell(app.words("read-only.why"), true);
    if (key in DRIVES) {
      const [x, z] = DRIVES[key];
      return void connection.publish(`${turtle}/cmd_vel`, "geometry_msgs/msg/Twist", { linear: { x, y: 0, z: 0 }, angular: { x: 0, y: 0, z } });
    }
    if (event.repeat) return;
    const action = `${turtle}/rotate_absolute/_action`, uuid = crypto.getRandomValues(new Uint8Array(16));
    const call = key === "f" ? connection.call(`${action}/cancel_goal`, {}) : connection.call(`${action}/send_goal`, { goal_id: { uuid }, goal: { theta: TURNS[key] } });
    call.catch((error) => app.tell(error.message, true));
  }
}

export const panel = { id: "turtlesim", create: (element, app, options) => new Turtlesim(element, app, options) };
