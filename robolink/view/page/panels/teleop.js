// Teleop panel: drives a robot by keys, by mouse or finger on a stick, or by a gamepad; dead-man. Its E-STOP is STOP.
//
// A robot moves only while something is held and the panel has the keyboard (a stick: the pointer). The server stops it
// when nothing came for 0.25 s, and at once when the page goes.

import { button, h } from "../dom.js";
import { addPairs } from "../words.js";

addPairs("teleop", {
  topic: ["topic", "topic"], none: ["no cmd_vel topic is known", "nenhum topic cmd_vel conhecido"],
  linear: ["m/s", "m/s"], angular: ["rad/s", "rad/s"], linear_title: ["greatest speed", "velocidade máxima"], angular_title: ["greatest turn", "giro máximo"],
  stick: ["stick: drag it, or hold W A S D or the arrows (Q and E: sideways)", "alavanca: arraste, ou segure W A S D ou as setas (Q e E: para o lado)"],
  keys: ["Click the stick to drive by keys: W A S D or arrows, Q E sideways. Release to stop.", "Clique na alavanca para dirigir por teclas: W A S D ou setas, Q E de lado. Solte para parar."],
  pad: ["Gamepad: hold LB or RB and use the sticks.", "Gamepad: segure LB ou RB e use as alavancas."],
  estop: ["E-STOP", "EMERGÊNCIA"], idle: ["stands", "parado"],
});

const PERIOD = 50; // ms between commands
const STOP_AFTER = 0.25; // seconds after which the server stops what it no longer hears
const ZEROS = 5; // zeros that are sent when all is released
const DEAD = 0.12; // of a gamepad's stick around its middle
const KEYS = {
  KeyW: [1, 0, 0], ArrowUp: [1, 0, 0], KeyS: [-1, 0, 0], ArrowDown: [-1, 0, 0], KeyA: [0, 0, 1], ArrowLeft: [0, 0, 1],
  KeyD: [0, 0, -1], ArrowRight: [0, 0, -1], KeyQ: [0, 1, 0], KeyE: [0, -1, 0],
};

class Teleop {
  constructor(element, app, options) {
    Object.assign(this, { element, app, topic: "", linear: 0.5, angular: 1 }, options);
    this.held = new Set();
    this.pull = null; // [forward, turn] of the stick while it is held
    this.zeros = 0;
    this._build();
    const release = () => this.release();
    this.offs = [app.on("stop", () => { release(); this._list(); }), app.store.on("change", () => this._list()), app.connection.on("info", () => this._list())];
    const hidden = () => document.hidden && release();
    addEventListener("blur", release);
    document.addEventListener("visibilitychange", hidden);
    this.offs.push(() => removeEventListener("blur", release), () => document.removeEventListener("visibilitychange", hidden));
    this.timer = setInterval(() => this._tick(), PERIOD);
    this._list();
  }

  save() { return { topic: this.topic, linear: this.linear, angular: this.angular }; }

  close() {
    clearInterval(this.timer);
    if (this.moving) this._send([0, 0, 0]);
    for (const off of this.offs) off();
  }

  _build() {
    const { words } = this.app;
    this.topics = h("select", { class: "topic", "aria-label": words("teleop.topic"), title: words("teleop.topic"), onchange: () => this._choose(this.topics.value) });
    const speed = (name) => {
      const input = h("input", { type: "number", class: name, min: 0, max: 100, step: 0.1, value: this[name], "aria-label": words(`teleop.${name}_title`), title: words(`teleop.${name}_title`),
        onchange: () => { this[name] = Math.max(0, Number(input.value) || 0); input.value = this[name]; this.app.remember(); } });
      return h("label", {}, input, ` ${words(`teleop.${name}`)}`);
    };
    this.knob = h("div", { class: "knob" });
    this.stick = h("div", { class: "stick", tabIndex: 0, role: "application", "aria-label": words("teleop.stick"), title: words("teleop.stick") }, this.knob);
    const { stopping } = this.app;
    this.estop = button("", "", () => (stopping.held ? stopping.release() : stopping.press()), { className: "estop" });
    this.estop.addEventListener("keydown", (event) => { if (event.key === " " && stopping.held) event.preventDefault(); }); // space never releases
    this.state = h("output", { class: "velocity" });
    this.why = h("p", { class: "warn why" });
    this.element.append(h("div", { class: "row" }, this.topics, speed("linear"), speed("angular")), this.why,
      h("div", { class: "cockpit" }, this.stick, h("div", {}, this.state, this.estop)), h("p", { class: "dim hints" }, words("teleop.keys"), " ", words("teleop.pad")));
    this.stick.addEventListener("keydown", (event) => this._key(event, true));
    this.stick.addEventListener("keyup", (event) => this._key(event, false));
    this.stick.addEventListener("blur", () => { this.held.clear(); });
    this._pointers();
  }

  _list() {
    const { app, topics } = this, { connection, words } = app, names = [...app.drivable().keys()].sort();
    if (!names.includes(this.topic)) {
      if (this.moving) this.release();
      if (!this.topic || !connection.isOpen) this.topic = this.topic || names[0] || "";
    }
    const all = this.topic && !names.includes(this.topic) ? [this.topic, ...names] : names, text = all.join(" ");
    if (text !== this.listed) {
      this.listed = text;
      topics.replaceChildren(...all.map((name) => h("option", { value: name }, name)));
    }
    topics.value = this.topic;
    const held = app.stopping.held, why = connection.isReadOnly ? words("read-only.why") : held ? words("stop.holds") : !names.includes(this.topic) ? words("teleop.none") : "";
    this.why.textContent = this.blocked = why;
    this.stick.ariaDisabled = String(Boolean(why));
    this.estop.disabled = connection.isReadOnly;
    this.estop.ariaPressed = String(held);
    this.estop.textContent = words(held ? "stop.release" : "teleop.estop");
    this.estop.title = this.estop.ariaLabel = words(connection.isReadOnly ? "read-only.why" : held ? "stop.release_title" : "stop.title");
  }

  /** Drive another robot: the one before stands first. */
  _choose(topic) {
    this.release();
    if (this.topic) this._send([0, 0, 0]);
    this.moving = false;
    this.topic = topic;
    this._list();
    this.app.remember();
  }

  /** Let go of everything; a held key counts again only when it is pressed anew. */
  release() {
    this.held.clear();
    this.pull = null;
    this.freed = true; // a gamepad's button must be pressed anew, too
    this._showKnob();
    if (this.moving) this._tick();
  }

  _key(event, down) {
    const other = event.ctrlKey || event.metaKey || event.altKey;
    if (down && other) return this.release(); // a shortcut: macOS then tells no release of the keys that are held
    if (!(event.code in KEYS)) return;
    event.preventDefault();
    if (!down) this.held.delete(event.code);
    else if (!event.repeat && !this.blocked) this.held.add(event.code);
    else return;
    this._tick();
  }

  _pointers() {
    const { stick } = this;
    const pull = (event) => {
      const { left, top, width, height } = stick.getBoundingClientRect();
      const x = (2 * (event.clientX - left)) / width - 1, y = 1 - (2 * (event.clientY - top)) / height, far = Math.max(1, Math.hypot(x, y));
      this.pull = [y / far, -x / far];
      this._showKnob();
    };
    stick.addEventListener("pointerdown", (event) => {
      stick.focus();
      if (this.blocked || this.finger !== undefined) return;
      stick.setPointerCapture(event.pointerId);
      this.finger = event.pointerId;
      pull(event);
      this._tick();
    });
    stick.addEventListener("pointermove", (event) => { if (event.pointerId === this.finger && this.pull) pull(event); });
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
      stick.addEventListener(name, (event) => {
        if (event.pointerId !== this.finger) return;
        this.finger = undefined;
        this.pull = null;
        this._showKnob();
        this._tick();
      });
    }
    stick.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  _showKnob([forward, turn] = this.pull ?? [0, 0]) {
    this.knob.style.transform = `translate(${-turn * 100}%, ${-forward * 100}%)`;
  }

  /** Pull of a gamepad, while one of its shoulder buttons is held; null otherwise. */
  _gamepad() {
    if (!document.hasFocus()) return null;
    for (const pad of navigator.getGamepads?.() ?? []) {
      if (!pad) continue;
      const held = [4, 5].some((i) => pad.buttons[i]?.pressed);
      if (!held) this.freed = false;
      if (!held || this.freed) continue;
      const axis = (i) => (Math.abs(pad.axes[i] ?? 0) < DEAD ? 0 : -pad.axes[i]);
      return [axis(1), axis(0), axis(2)];
    }
    return null;
  }

  /** Shares of [forward, sideways, turn] that are asked for; null while nothing is held. */
  _wanted() {
    if (this.blocked) return null;
    if (this.held.size) return [...this.held].reduce((sum, code) => sum.map((each, i) => Math.max(-1, Math.min(1, each + KEYS[code][i]))), [0, 0, 0]);
    if (this.pull) return [this.pull[0], 0, this.pull[1]];
    return this._gamepad();
  }

  _tick() {
    const wanted = this._wanted();
    if (!this.pull) this._showKnob([wanted?.[0] ?? 0, wanted?.[2] ?? 0]);
    if (wanted) {
      this.moving = true;
      this.zeros = ZEROS;
      this._send(wanted);
    } else if (this.moving && this.zeros > 0) {
      this.zeros -= 1;
      this._send([0, 0, 0]);
      this.moving = this.zeros > 0;
    }
    const { words } = this.app, text = wanted ? this.sent : words("teleop.idle");
    if (this.state.textContent !== text) this.state.textContent = text;
  }

  _send([forward, sideways, turn]) {
    const { app, topic } = this, type = app.drivable().get(topic);
    if (!type || app.connection.isReadOnly) return;
    const x = forward * this.linear, y = sideways * this.linear, z = turn * this.angular;
    this.sent = `${x.toFixed(2)} m/s${y ? ` (${y.toFixed(2)})` : ""}, ${z.toFixed(2)} rad/s`;
    const twist = { linear: { x, y, z: 0 }, angular: { x: 0, y: 0, z } }, now = Date.now();
    const stamp = { sec: Math.floor(now / 1000), nanosec: (now % 1000) * 1e6 };
    app.connection.publish(topic, type, type.endsWith("Stamped") ? { header: { stamp, frame_id: "" }, twist } : twist, { stopAfter: STOP_AFTER });
  }
}

export const panel = { id: "teleop", create: (element, app, options) => new Teleop(element, app, options) };
