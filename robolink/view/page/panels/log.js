// Log panel: /rosout with levels, filters by node and text, pause, and the count of each level.

import { button, h } from "../dom.js";
import { addPairs } from "../words.js";

addPairs("log", {
  level: ["least level", "nível mínimo"], node: ["node", "node"], text: ["text", "texto"], clear: ["clear", "limpar"],
  pause: ["pause or go on", "pausar ou continuar"], waiting: ["What nodes log is shown here.", "O que os nodes registram aparece aqui."],
  count: ["{shown} of {all}", "{shown} de {all}"], more: ["{count} more while paused", "mais {count} durante a pausa"],
});

const LEVELS = { 10: "DEBUG", 20: "INFO", 30: "WARN", 40: "ERROR", 50: "FATAL" };
const KEPT = 5000, SHOWN = 1000; // entries in memory, and in the list

class Log {
  constructor(element, app, options) {
    Object.assign(this, { element, app, level: 10, node: "", text: "" }, options);
    this.entries = [];
    this.fresh = [];
    this.paused = false;
    this.matching = 0;
    this._build();
    this.handle = app.listen("/rosout", { every: (view, time, topic) => this._take(topic.decode(view), time) });
    for (const { view, time } of this.handle.topic.ring.between(0, Infinity)) this._take(this.handle.topic.decode(view), time);
  }

  save() { return { level: this.level, node: this.node, text: this.text }; }

  close() { this.handle.close(); }

  _build() {
    const { words } = this.app;
    const field = (name) => {
      const input = h("input", { type: "search", class: name, value: this[name], placeholder: words(`log.${name}`), "aria-label": words(`log.${name}`), oninput: () => { this[name] = input.value; this._again(); } });
      return input;
    };
    const levels = h("select", { class: "level", title: words("log.level"), "aria-label": words("log.level"), onchange: () => { this.level = Number(levels.value); this._again(); } },
      ...Object.entries(LEVELS).map(([value, name]) => h("option", { value, selected: Number(value) === this.level }, `${name} +`))); // its first letter chooses it
    this.count = h("span", { class: "dim count" });
    this.pauseButton = button("❚❚", words("log.pause"), () => { this.paused = !this.paused; this.pauseButton.ariaPressed = String(this.paused); this._tell(); }, { className: "pause" });
    this.list = h("ol", { class: "log", tabIndex: 0, "aria-label": words("panel.log") });
    this.hint = h("p", { class: "empty" }, words("log.waiting"));
    this.element.append(h("div", { class: "row" }, levels, field("node"), field("text"), this.count, this.pauseButton, button("✕", words("log.clear"), () => this._clear())), this.hint, this.list);
    this._tell();
  }

  _take(message, time) {
    if (typeof message?.msg !== "string") return; // a topic of this name and another type
    const stamp = message.stamp?.sec ? message.stamp.sec * 1000 + message.stamp.nanosec / 1e6 : time;
    this.fresh.push({ level: message.level, node: message.name, text: message.msg, place: message.file ? `${message.file}:${message.line} ${message.function}` : "", stamp });
    if (this.fresh.length > KEPT) this.fresh.shift();
  }

  _clear() {
    this.entries = [];
    this.fresh = [];
    this._again();
  }

  _matches(entry) {
    return entry.level >= this.level && entry.node.toLowerCase().includes(this.node.toLowerCase()) && `${entry.text}`.toLowerCase().includes(this.text.toLowerCase());
  }

  _again() {
    const matching = this.entries.filter((each) => this._matches(each));
    this.matching = matching.length;
    this.list.replaceChildren(...matching.slice(-SHOWN).map(row));
    this.list.scrollTop = this.list.scrollHeight;
    this._tell();
    this.app.remember();
  }

  _tell() {
    const { words } = this.app;
    this.count.textContent = this.paused && this.fresh.length ? words("log.more", { count: this.fresh.length })
      : words("log.count", { shown: this.matching, all: this.entries.length });
    this.hint.hidden = this.entries.length > 0;
  }

  frame() {
    if (!this.fresh.length) return;
    if (this.paused) return this._tell();
    const fresh = this.fresh.sort((a, b) => a.stamp - b.stamp), isLate = fresh[0].stamp < this.entries.at(-1)?.stamp - 1000, { list } = this, atEnd = list.scrollHeight - list.scrollTop - list.clientHeight < 30;
    this.fresh = [];
    this.entries.push(...fresh);
    if (isLate) this.entries.sort((a, b) => a.stamp - b.stamp); // what a node retained for late ones comes node by node
    if (this.entries.length > KEPT) this.entries.splice(0, this.entries.length - KEPT);
    if (isLate) return this._again();
    const matching = fresh.filter((each) => this._matches(each));
    this.matching += matching.length;
    list.append(...matching.slice(-SHOWN).map(row));
    while (list.children.length > SHOWN) list.firstChild.remove();
    if (atEnd) list.scrollTop = list.scrollHeight;
    this._tell();
  }
}

function row({ level, node, text, place, stamp }) {
  const name = LEVELS[level] ?? `${level}`;
  return h("li", { class: `level-${name.toLowerCase()}`, title: place }, h("time", {}, new Date(stamp).toLocaleTimeString("en-GB") + (stamp % 1000 / 1000).toFixed(3).slice(1)), " ", h("b", {}, name), " ", h("i", {}, node), " ", h("span", {}, text));
}

export const panel = { id: "log", create: (element, app, options) => new Log(element, app, options) };
