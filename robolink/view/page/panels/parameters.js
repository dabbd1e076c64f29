// Parameters panel: those of a node by its services, with inputs by type and range, and the node's reason when it refuses.

import { button, h } from "../dom.js";
import { addPairs } from "../words.js";
import { absence, number, Picker } from "./form.js";

addPairs("parameters", {
  node: ["node", "node"], none: ["no nodes with parameters", "nenhum node com parâmetros"], none_why: ["No node runs that has parameters. One to try: robolink launch wander", "Nenhum node com parâmetros em execução. Um para experimentar: robolink launch wander"], filter: ["filter", "filtrar"], again: ["read again", "ler de novo"],
  readonly: ["read-only parameter", "parâmetro só de leitura"], refused: ["{name}: {reason}", "{name}: {reason}"], refused_why: ["the node refused it", "o node recusou"],
  empty: ["no parameters", "sem parâmetros"], range: ["{low} to {high}", "de {low} a {high}"], set: ["{name} = {value}", "{name} = {value}"], unset: ["not set", "sem valor"],
});

const FIELDS = [null, "bool_value", "integer_value", "double_value", "string_value", "byte_array_value", "bool_array_value", "integer_array_value", "double_array_value", "string_array_value"];
const TYPES = ["", "bool", "int64", "float64", "string", "byte[]", "bool[]", "int64[]", "float64[]", "string[]"];
const BOOL = 1, STRING = 4;

class Parameters {
  constructor(element, app, options) {
    Object.assign(this, { element, app, node: "", filter: "" }, options);
    this.rows = new Map(); // name -> {row, show(value)}
    this._build();
    this.offs = [app.connection.on("services", () => this._list()), app.connection.on("info", () => this._list())];
    this.handle = app.listen("/parameter_events", { every: (view, _, topic) => this._event(topic.decode(view)) });
    this._list();
  }

  save() { return { node: this.node, filter: this.filter }; }

  close() {
    for (const off of this.offs) off();
    this.handle.close();
  }

  _build() {
    const { words } = this.app;
    this.picker = new Picker(words("parameters.node"), words("parameters.none"), (name) => { this.node = name; this._list(); this.app.remember(); });
    const search = this.search = h("input", { type: "search", value: this.filter, placeholder: words("parameters.filter"), "aria-label": words("parameters.filter"), oninput: () => { this.filter = search.value; this._hide(); } });
    this.state = h("p", { role: "status", class: "state" });
    this.body = h("div", { class: "fields parameters" });
    this.element.append(h("div", { class: "row" }, this.picker.element, search, button("↻", words("parameters.again"), () => { this.read = ""; this._list(); })), h("div", { class: "scroll padded" }, this.state, this.body));
  }

  /** Show a parameter of a node, and give the keyboard to it. */
  find(node, name) {
    if (node !== this.node) this.rows.clear();
    Object.assign(this, { node, wanted: name, filter: "" });
    this.search.value = "";
    this._list();
    this._hide();
  }

  _list() {
    const { connection, words } = this.app, mark = "/describe_parameters";
    const names = [...connection.services.values()].filter(({ name }) => name.endsWith(mark)).map(({ name }) => name.slice(0, -mark.length));
    this.node = this.picker.show(names, this.node);
    const here = connection.isOpen && ["list_parameters", "get_parameters", "describe_parameters", "set_parameters"].every((each) => connection.service(`${this.node}/${each}`));
    const key = here ? `${this.node} ${connection.isReadOnly}` : "";
    if (connection.isReadOnly) this._tell(words("read-only.why"), "warn");
    if (key === this.read) return;
    this.read = key;
    if (key) this._load(this.node);
    else if (!here) this._tell(absence(this.app, this.node, words("parameters.none_why")), this.node ? "warn" : "dim");
  }

  async _load(node) {
    const { connection, words } = this.app, load = this.load = {}; // another one that begins meanwhile is newer
    if (connection.isReadOnly) return this._follow(node);
    try {
      const { result: { names } } = await connection.call(`${node}/list_parameters`, { prefixes: [], depth: 0 });
      names.sort();
      const [{ descriptors }, { values }] = await Promise.all([connection.call(`${node}/describe_parameters`, { names }), connection.call(`${node}/get_parameters`, { names })]);
      if (load !== this.load) return;
      this.rows.clear();
      this.body.replaceChildren();
      this._tell(names.length ? "" : words("parameters.empty"));
      names.forEach((name, i) => this._add(name, descriptors[i] ?? {}, values[i] ?? { type: 0 }));
      this._hide();
    } catch (error) {
      if (load === this.load) this._tell(error.message, "error");
    }
  }

  _tell(text, kind = "") {
    this.state.textContent = text;
    this.state.className = `state ${kind}`;
  }

  _add(name, descriptor, value) {
    const { words } = this.app, editor = this._editor(name, descriptor, value);
    const row = h("label", { title: [descriptor.description, descriptor.additional_constraints, TYPES[value.type]].filter(Boolean).join("\n") }, h("span", {}, ...name.split(/(?<=_)/).flatMap((part) => [part, h("wbr")])), editor.element);
    if (descriptor.read_only) {
      row.title = words("parameters.readonly");
      for (const each of row.querySelectorAll("input")) each.disabled = true;
    }
    this.rows.set(name, { row, ...editor });
    editor.show(value);
    this.body.append(row);
  }

  _editor(name, descriptor, value) {
    const range = descriptor.integer_range?.[0] ?? descriptor.floating_point_range?.[0];
    const state = { type: value.type };
    if (value.type === BOOL) {
      const box = h("input", { type: "checkbox", "data-parameter": name, onchange: () => this._set(name, { type: BOOL, bool_value: box.checked }) });
      return { element: box, show: (given) => { box.checked = given.bool_value; } };
    }
    const input = h("input", { type: "text", "data-parameter": name, "aria-label": name, autocomplete: "off", spellcheck: false });
    const slider = range && h("input", { type: "range", min: Number(range.from_value), max: Number(range.to_value), step: Number(range.step) || (value.type === 2 ? 1 : "any"), "aria-label": name, title: this.app.words("parameters.range", { low: range.from_value, high: range.to_value }) });
    const send = (text) => {
      try {
        this._set(name, read(this.app.words, name, state.type, text));
      } catch (error) {
        this._refuse(name, error.message);
      }
    };
    input.addEventListener("change", () => send(input.value));
    input.addEventListener("keydown", (event) => { if (event.key === "Escape") state.show?.(); });
    slider?.addEventListener("input", () => { input.value = slider.value; });
    slider?.addEventListener("change", () => send(slider.value));
    const show = (given) => {
      state.type = given.type || state.type;
      state.show = () => show(given);
      if (document.activeElement === input && input.value !== input.defaultValue) return; // somebody types
      input.defaultValue = input.value = written(given);
      if (!given.type) input.placeholder = this.app.words("parameters.unset");
      if (slider) slider.value = Number(input.value);
    };
    return { element: h("span", { class: "choice" }, slider, input), show };
  }

  async _set(name, value) {
    const { connection, words } = this.app, { node } = this;
    try {
      const { results: [result] } = await connection.call(`${node}/set_parameters`, { parameters: [{ name, value }] });
      if (node !== this.node) return;
      if (!result?.successful) return this._refuse(name, result?.reason || words("parameters.refused_why"));
      this._invalid(name, null);
      this._tell(words("parameters.set", { name, value: written(value) }), "good");
      this.rows.get(name)?.show(value);
    } catch (error) {
      if (node === this.node) this._refuse(name, error.message);
    }
  }

  /** Tell why a value was not taken, and show the one that holds. */
  async _refuse(name, reason) {
    const { node } = this;
    this._tell(this.app.words("parameters.refused", { name, reason }), "error");
    this._invalid(name, "true");
    const answer = await this.app.connection.call(`${node}/get_parameters`, { names: [name] }).catch(() => null);
    if (answer && node === this.node) {
      document.activeElement?.blur?.();
      this.rows.get(name)?.show(answer.values[0]);
    }
  }

  _invalid(name, invalid) { for (const each of this.rows.get(name)?.row.querySelectorAll("input") ?? []) each.ariaInvalid = invalid; }

  /** Values that a page which may not call services is told by the server. */
  _follow(node) {
    const { connection } = this.app;
    this.values = new Map();
    this.off ??= this.offs[this.offs.push(connection.on("parameters", ({ parameters }) => this._told(parameters))) - 1];
    connection.send({ op: "subscribeParameterUpdates", parameterNames: [] });
    connection.send({ op: "getParameters", parameterNames: [], id: `panel ${node}` });
  }

  _told(parameters) {
    for (const { name, value } of parameters) {
      const [node, own] = splitName(name);
      if (node === this.node) value === undefined ? this.values.delete(own) : this.values.set(own, value);
    }
    this.rows.clear();
    this.body.replaceChildren(...[...this.values].sort(([a], [b]) => (a < b ? -1 : 1)).map(([own, value]) => h("label", {}, h("span", {}, own), h("input", { value: Array.isArray(value) ? value.join(", ") : `${value}`, disabled: true, "data-parameter": own }))));
  }

  _hide() {
    for (const [name, { row }] of this.rows) row.hidden = !name.toLowerCase().includes(this.filter.toLowerCase());
    const field = this.rows.get(this.wanted)?.row.querySelector("input:not([type=range])");
    if (!field) return;
    this.wanted = "";
    field.focus();
    field.select();
  }

  _event(event) {
    if (event?.node !== this.node) return;
    if (event.new_parameters.some(({ name }) => !this.rows.has(name)) || event.deleted_parameters.length) {
      this.read = "";
      return this._list();
    }
    for (const { name, value } of [...event.new_parameters, ...event.changed_parameters]) this.rows.get(name)?.show(value);
  }
}

/** Node and name of a parameter as the server has it: "/node.name". */
function splitName(name) {
  const at = name.indexOf(".");
  return [name.slice(0, at), name.slice(at + 1)];
}

function written(value) {
  const found = value[FIELDS[value.type]];
  if (!value.type) return "";
  if (value.type === 9) return JSON.stringify(Array.from(found));
  return value.type > 4 ? Array.from(found).join(", ") : `${found}`;
}

/** ParameterValue of a text. Throws Error with one line. */
function read(words, name, type, text) {
  if (type === STRING) return { type, string_value: text };
  const scalar = (each) => (type === 6 || type === BOOL ? /^(true|1)$/i.test(each) : number(words, name, type === 5 ? "byte" : type === 7 || type === 2 ? "int64" : "float64", each));
  if (!type) return guess(text);
  if (type < 5) return { type, [FIELDS[type]]: scalar(text) };
  if (type === 9) return { type, [FIELDS[type]]: text.trim().startsWith("[") ? JSON.parse(text).map(String) : text.split(",").map((each) => each.trim()) };
  return { type, [FIELDS[type]]: text.split(/[,\s]+/).filter(Boolean).map(scalar) };
}

function guess(text) {
  if (/^(true|false)$/i.test(text)) return { type: 1, bool_value: /true/i.test(text) };
  if (/^[+-]?\d+$/.test(text)) return { type: 2, integer_value: BigInt(text) };
  return text.trim() && Number.isFinite(Number(text)) ? { type: 3, double_value: Number(text) } : { type: 4, string_value: text };
}

export const panel = { id: "parameters", create: (element, app, options) => new Parameters(element, app, options) };
