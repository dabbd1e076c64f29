// DOM helpers: elements made without HTML text, so that nothing of the network is ever parsed as HTML.

/** Element of a tag; properties are set, `on...` are listeners, `class`, `role`, `aria-*` and `data-*` attributes. */
export function h(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name === "class" ? "class" : name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** Button with a text or a symbol; `label` is its name for screen readers and its tooltip. */
export function button(text, label, onclick, properties = {}) {
  return h("button", { type: "button", title: label ?? "", "aria-label": label ?? text, onclick, ...properties }, text);
}

/** Set of listeners by name: `on(name, listener)` returns a function that takes it away. */
export class Emitter {
  constructor() { this._listeners = new Map(); }

  on(name, listener) {
    if (!this._listeners.has(name)) this._listeners.set(name, new Set());
    this._listeners.get(name).add(listener);
    return () => this._listeners.get(name).delete(listener);
  }

  emit(name, ...values) {
    for (const listener of [...(this._listeners.get(name) ?? [])]) listener(...values);
  }
}

/** Number in few characters: 1234567 is "1.23M". */
export function brief(value, digits = 3) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  for (const [limit, letter] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]]) {
    if (size >= limit) return `${Number((value / limit).toPrecision(digits))}${letter}`;
  }
  return `${Number(value.toPrecision(digits))}`;
}

const known = new Map(); // text -> pixels
let measure; // context of a canvas

/** Width of a text in pixels, in the font of tables. */
export function widthOf(text) {
  if (known.size > 5000) known.clear();
  if (!known.has(text)) {
    measure ??= document.createElement("canvas").getContext("2d");
    measure.font = "12px system-ui, sans-serif";
    known.set(text, measure.measureText(text).width);
  }
  return known.get(text);
}

/** Text as far as there are pixels for it: what does not fit is left out of its middle, since both ends tell things apart. */
export function fitted(text, room) {
  for (let kept = text.length, short = text; ; short = `${text.slice(0, kept * 0.4)}…${text.slice(text.length - Math.ceil(kept * 0.6))}`) {
    if (!(kept > 1) || widthOf(short) <= room) return short;
    kept = Math.min(kept - 1, Math.ceil((kept * room) / widthOf(short)));
  }
}

/** True where keys write text: shortcuts leave them alone. */
export function isTyping(target) {
  if (target instanceof HTMLInputElement) return !/^(range|checkbox|radio|button|color)$/.test(target.type);
  return target instanceof HTMLElement && (target.isContentEditable || /^(TEXTAREA|SELECT)$/.test(target.tagName));
}

/** What the browser remembers under a name: {} if it is nothing, nonsense, or forbidden. */
export function recall(key) {
  try {
    return { ...JSON.parse(localStorage.getItem(key)) };
  } catch {
    return {};
  }
}

/** Let the browser remember something, if it may and has room. */
export function remember(key, value) {
  try {
    localStorage.setItem(key, JSON.stringify(value));
  } catch { /* then it is forgotten with the page */ }
}

export function download(name, content, type = "application/octet-stream") {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  const address = URL.createObjectURL(blob);
  h("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
