// Form of a ros2msg type: nested parts, arrays, booleans, numbers in their range, texts, and constants as choices.

import { button, h } from "../dom.js";
import { addPairs } from "../words.js";

addPairs("form", {
  add: ["add one", "adicionar"], remove: ["remove", "remover"], other: ["other…", "outro…"], list: ["numbers, with commas", "números, com vírgulas"],
  range: ["{name}: {low} to {high}, got '{value}'", "{name}: de {low} a {high}, e não '{value}'"], number: ["{name}: a number is needed, got '{value}'", "{name}: precisa ser um número, e não '{value}'"],
  size: ["{name}: {size} elements are needed, got {count}", "{name}: são {size} elementos, e não {count}"], most: ["{name}: at most {size} elements, got {count}", "{name}: no máximo {size} elementos, e não {count}"],
  empty: ["no fields", "sem campos"], unserved: ["Nobody serves {name} now: its node does not run.", "Ninguém serve {name} agora: o seu node não está em execução."],
  bag: ["A bag has messages alone: services, actions and parameters are those of nodes that run.", "Um bag só tem mensagens: services, actions e parâmetros são de nodes em execução."],
});

const BITS = { bool: 1, byte: 8, char: 8, uint8: 8, int8: -8, uint16: 16, int16: -16, uint32: 32, int32: -32, uint64: 64, int64: -64 };
const OTHER = "…";

/** Bounds of an integer type, or null for other types. */
export function bounds(type) {
  const bits = BITS[type];
  if (!bits) return null;
  return bits < 0 ? [-(2n ** BigInt(-bits - 1)), 2n ** BigInt(-bits - 1) - 1n] : [0n, 2n ** BigInt(bits) - 1n];
}

/** Number of a text, by its type; integers of 64 bits are BigInt where a number is not exact. Throws Error with one line. */
export function number(words, name, type, text) {
  const range = bounds(type), told = `${text}`.trim(), value = { name, value: told };
  if (!range) {
    const sign = /^([+-]?)inf(inity)?$/i.exec(told);
    const found = sign ? Number(`${sign[1]}Infinity`) : /^nan$/i.test(told) ? NaN : told === "" ? undefined : Number(told);
    if (found === undefined || (Number.isNaN(found) && !/^nan$/i.test(told))) throw new Error(words("form.number", value));
    return found;
  }
  if (!/^[+-]?\d+$|^0x[\da-f]+$/i.test(told)) throw new Error(words("form.number", value));
  const found = BigInt(told.replace(/^\+/, ""));
  if (found < range[0] || found > range[1]) throw new Error(words("form.range", { ...value, low: range[0], high: range[1] }));
  return Number.isSafeInteger(Number(found)) ? Number(found) : found;
}

/** Constants of a type that a field of it may have: by the name of the field, or if no other field could be meant. */
export function choices(schema, type, field) {
  if (field.shape !== "one" || !field.primitive || field.type === "bool") return [];
  const same = schema.constants(type).filter((each) => each.type === field.type), prefix = `${field.name.toUpperCase()}_`;
  const named = same.filter(({ name }) => name.startsWith(prefix));
  if (named.length) return named;
  const alone = schema.fields(type).filter((each) => each.type === field.type && each.shape === "one").length === 1;
  return alone && same.length > 1 ? same : [];
}

export class Form {
  /** @param schema of the type  @param words of the page  @param type part of the schema, by default its root  @param value to begin with */
  constructor(schema, words, type = schema.root, value = schema.zero(type)) {
    Object.assign(this, { schema, words });
    this.part = this._fields(type, value, "");
    this.element = h("div", { class: "form" }, this.part.element);
  }

  /** Message that the form holds. Throws Error with one line, and marks the field. */
  get value() {
    for (const each of this.element.querySelectorAll("[aria-invalid]")) each.removeAttribute("aria-invalid");
    return this.part.read();
  }

  _fields(type, value, path) {
    const parts = this.schema.fields(type).map((field) => [field, this._field(type, field, value?.[field.name], path ? `${path}.${field.name}` : field.name)]);
    const element = h("div", { class: "fields" }, ...parts.map(([field, part]) => {
      const told = `${field.type}${field.shape === "one" ? "" : field.shape === "array" ? `[${field.size}]` : field.size ? `[<=${field.size}]` : "[]"}`;
      if (part.nested) return h("details", { open: true }, h("summary", {}, field.name, h("span", { class: "dim" }, ` ${told}`)), part.element);
      return h("label", { title: told }, h("span", {}, field.name), part.element);
    }), parts.length ? null : h("p", { class: "dim" }, this.words("form.empty")));
    return { element, read: () => Object.fromEntries(parts.map(([field, part]) => [field.name, part.read()])) };
  }

  _field(type, field, given, path) {
    const value = given ?? this.schema.initial(field), isNumber = field.primitive && !/^(bool|w?string)$/.test(field.type);
    if (field.shape !== "one") return isNumber ? this._numbers(field, value, path) : this._list(type, field, value, path);
    return this._one(type, field, value, path);
  }

  _one(type, field, value, path) {
    if (!field.primitive) return { ...this._fields(field.type, value, path), nested: true };
    const constants = choices(this.schema, type, field);
    if (field.type === "bool") {
      const box = h("input", { type: "checkbox", checked: Boolean(value), "data-field": path });
      return { element: box, read: () => box.checked };
    }
    const isText = field.type.endsWith("string");
    const input = h("input", { type: "text", value: `${value}`, "data-field": path, "aria-label": path, inputMode: isText ? "text" : "decimal", autocomplete: "off", spellcheck: false });
    if (field.bound) input.maxLength = field.bound;
    const read = () => (isText ? input.value : this._number(input, field.type, path, input.value));
    if (!constants.length) return { element: input, read };
    const menu = h("select", { "data-choice": path, onchange: () => { input.hidden = menu.value !== OTHER; if (input.hidden) input.value = menu.value; } },
      ...constants.map((each) => h("option", { value: `${each.value}`, selected: `${each.value}` === `${value}` }, `${each.name} (${each.value})`)),
      h("option", { value: OTHER, selected: constants.every((each) => `${each.value}` !== `${value}`) }, this.words("form.other")));
    input.hidden = menu.value !== OTHER;
    return { element: h("span", { class: "choice" }, menu, input), read };
  }

  _number(input, type, path, text) {
    try {
      return number(this.words, path, type, text);
    } catch (error) {
      input.ariaInvalid = "true";
      throw error;
    }
  }

  _check(field, count, path) {
    const told = { name: path, size: field.size, count };
    if (field.shape === "array" && count !== field.size) throw new Error(this.words("form.size", told));
    if (field.shape === "sequence" && field.size && count > field.size) throw new Error(this.words("form.most", told));
  }

  _numbers(field, value, path) {
    const input = h("input", { type: "text", value: Array.from(value).join(", "), "data-field": path, title: this.words("form.list"), autocomplete: "off" });
    return {
      element: input,
      read: () => {
        const found = input.value.replace(/^\s*\[|\]\s*$/g, "").split(/[,\s]+/).filter(Boolean).map((each) => this._number(input, field.type, path, each));
        this._check(field, found.length, path);
        return found;
      },
    };
  }

  _list(type, field, value, path) {
    const { words } = this, items = [], one = { ...field, shape: "one", text: "" }, body = h("div", { class: "items" });
    const append = (each) => {
      const part = this._one(type, one, each ?? this.schema.initial(one), `${path}[${items.length}]`);
      const row = h("div", { class: "item" }, part.element, field.shape === "array" ? null : button("✕", words("form.remove"), () => { items.splice(items.indexOf(part), 1); row.remove(); }));
      items.push(part);
      body.append(row);
    };
    for (const each of value) append(each);
    const more = field.shape === "array" ? null : button("+", words("form.add"), () => append(), { "data-add": path });
    const read = () => {
      this._check(field, items.length, path);
      return items.map((part) => part.read());
    };
    return { element: h("div", {}, body, more), read, nested: true };
  }
}

/** Why nothing is shown of a chosen name, or of none: nobody serves it, or there is nothing of its kind, as `none` says. */
export function absence({ connection, isBag, words }, name, none) {
  if (!connection.isOpen) return "";
  return isBag ? words("form.bag") : name ? words("form.unserved", { name }) : none;
}

/** Menu of names that come and go: the chosen one stays chosen, also while it is away. */
export class Picker {
  /** @param label of the menu  @param none text where there are no names  @param onchange called with the name that was chosen */
  constructor(label, none, onchange) {
    this.none = none;
    this.element = h("select", { class: "picker", "aria-label": label, title: label, onchange: () => onchange(this.element.value) });
  }

  /** Show names, sorted, with one chosen, by default the first; returns the chosen one. */
  show(names, chosen) {
    const sorted = [...new Set(chosen ? [chosen, ...names] : names)].sort(), now = chosen || sorted[0] || "", text = JSON.stringify(sorted);
    if (text !== this.shown) {
      this.shown = text;
      this.element.replaceChildren(...(sorted.length ? sorted : [""]).map((name) => h("option", { value: name }, name || this.none)));
    }
    if (this.element.value !== now) this.element.value = now;
    return now;
  }
}
