// Tree of a message: fields with their values, arrays folded; numbers can be dragged to a plot.

import { h } from "../dom.js";

const FIRST = 20; // elements of an array that are shown at once
const SHORT = 6; // numbers that stand beside a folded array's name

/** Value at a path such as "pose.position.x" or "ranges[3]"; undefined if there is none. */
export function at(message, path) {
  let value = message;
  for (const part of path.match(/[^.[\]]+/g) ?? []) {
    if (value === null || value === undefined) return undefined;
    value = value[part];
  }
  return value;
}

function isList(value) { return Array.isArray(value) || ArrayBuffer.isView(value); }

function isBranch(value) { return isList(value) ? value.length > 0 : value !== null && typeof value === "object"; }

/** A value in one line. */
export function leaf(value) {
  if (typeof value === "number") return Number.isInteger(value) ? `${value}` : `${Number(value.toPrecision(7))}`;
  if (typeof value === "string") return JSON.stringify(value.length > 300 ? `${value.slice(0, 300)}…` : value);
  if (isList(value)) {
    const numbers = Array.from(value.slice(0, SHORT), (each) => (typeof each === "object" ? "{…}" : leaf(each)));
    return `[${value.length}] ${numbers.join(", ")}${value.length > SHORT ? " …" : ""}`;
  }
  return value !== null && typeof value === "object" ? "" : `${value}`;
}

export class Tree {
  /** @param words of the page  @param onpick called with (topic, path) when a number is clicked */
  constructor(words, onpick) {
    this.words = words;
    this.onpick = onpick;
    this.element = h("div", { class: "tree", role: "tree" });
    this.forget([]);
    this.element.addEventListener("keydown", (event) => this._key(event));
  }

  /** Show nothing, and unfold these paths of what comes: true for all but arrays. */
  forget(open) {
    this.unfolds = open === true;
    this.open = new Set(this.unfolds ? [] : open);
    this.limits = new Map();
    this.rows = new Map();
    this.element.replaceChildren();
  }

  show(topic, message) {
    this.topic = topic;
    if (this.unfolds) this._unfold(message, "");
    const wanted = [];
    this._collect(wanted, message, "", 0);
    const present = new Set(wanted.map(({ path }) => path));
    for (const [path, row] of this.rows) {
      if (present.has(path)) continue;
      row.remove();
      this.rows.delete(path);
    }
    let before = null;
    for (const each of wanted) {
      const row = this._row(each), place = before ? before.nextSibling : this.element.firstChild;
      if (row !== place) this.element.insertBefore(row, place);
      before = row;
    }
  }

  _unfold(value, path) {
    this.unfolds = false;
    for (const [name, each] of Object.entries(value)) {
      if (!isBranch(each) || isList(each)) continue;
      this.open.add(`${path}${name}`);
      this._unfold(each, `${path}${name}.`);
    }
  }

  _collect(found, value, path, depth) {
    const list = isList(value), keys = list ? null : Object.keys(value);
    const count = list ? value.length : keys.length, limit = list ? (this.limits.get(path) ?? FIRST) : count;
    for (let i = 0; i < Math.min(count, limit); i++) {
      const name = list ? `[${i}]` : keys[i], each = list ? value[i] : value[name];
      const full = list ? `${path}${name}` : path ? `${path}.${name}` : name;
      found.push({ path: full, name, value: each, depth });
      if (isBranch(each) && this.open.has(full)) this._collect(found, each, full, depth + 1);
    }
    if (count > limit) found.push({ path: `${path} …`, more: path, name: this.words("tree.more", { count: count - limit }), value: null, depth });
  }

  _row(each) {
    let row = this.rows.get(each.path);
    if (!row) {
      row = this._make(each);
      this.rows.set(each.path, row);
    }
    const text = each.more === undefined ? leaf(each.value) : "";
    const shown = row.lastChild;
    if (shown.textContent !== text) shown.textContent = text;
    if (isBranch(each.value)) row.ariaExpanded = String(this.open.has(each.path));
    return row;
  }

  _make({ path, more, name, value, depth }) {
    const branch = isBranch(value), number = typeof value === "number" || typeof value === "bigint" || typeof value === "boolean";
    const row = h("div", { class: branch ? "branch" : number ? "number" : more === undefined ? "leaf" : "more", role: "treeitem", tabIndex: -1, "data-path": path, "aria-level": depth + 1 },
      h("span", { class: "key" }, name), h("span", { class: "value" }));
    row.style.paddingLeft = `${depth + 0.3}em`;
    if (!this.rows.size) row.tabIndex = 0;
    if (number) {
      row.draggable = true;
      row.title = this.words("tree.drag");
      row.addEventListener("dragstart", (event) => {
        event.dataTransfer.setData("text/robolink-field", JSON.stringify({ topic: this.topic, path }));
        event.dataTransfer.setData("text/plain", `${this.topic} ${path}`);
      });
    }
    row.addEventListener("click", () => this._act(row, path, more));
    return row;
  }

  _act(row, path, more) {
    if (more !== undefined) this.limits.set(more, (this.limits.get(more) ?? FIRST) * 10);
    else if (row.classList.contains("branch")) this._fold(path, !this.open.has(path));
    else if (row.classList.contains("number")) this.onpick?.(this.topic, path);
    this.onchange?.();
  }

  _fold(path, open) {
    if (open) this.open.add(path);
    else this.open.delete(path);
    this.onchange?.();
  }

  _key(event) {
    const row = event.target.closest("[role=treeitem]");
    if (!row) return;
    const { path } = row.dataset, go = (to) => { to?.focus(); if (to) for (const each of this.rows.values()) each.tabIndex = each === to ? 0 : -1; };
    const acts = {
      ArrowDown: () => go(row.nextSibling), ArrowUp: () => go(row.previousSibling),
      ArrowRight: () => row.classList.contains("branch") && this._fold(path, true),
      ArrowLeft: () => this._fold(path, false), Enter: () => row.click(),
    };
    if (!acts[event.key]) return;
    event.preventDefault();
    acts[event.key]();
  }
}
