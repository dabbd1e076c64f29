// Services panel: calls any service with a form made from its type, and shows the answer.

import { COMMON, partSchema } from "../connection.js";
import { button, h } from "../dom.js";
import { addPairs } from "../words.js";
import { absence, Form, Picker } from "./form.js";
import { Tree } from "./tree.js";

addPairs("services", {
  choose: ["service", "service"], none: ["no services", "nenhum service"], none_why: ["No node serves anything of its own. Tick 'all' for what every node serves.", "Nenhum node serve algo próprio. Marque 'todos' para ver o que todo node serve."], call: ["Call", "Chamar"], calling: ["calling…", "chamando…"],
  answered: ["answered in {seconds} s", "respondido em {seconds} s"], hidden: ["all", "todos"], hidden_title: ["also those of parameters and actions", "também os de parâmetros e actions"],
});

class Services {
  constructor(element, app, options) {
    Object.assign(this, { element, app, service: "", all: false, values: {} }, options);
    this._build();
    this.offs = [app.connection.on("services", () => this._list()), app.connection.on("info", () => this._list())];
    this._list();
  }

  save() {
    if (this.form) this._keep();
    return { service: this.service, all: this.all, values: this.values };
  }

  close() { for (const off of this.offs) off(); }

  _build() {
    const { words } = this.app;
    this.picker = new Picker(words("services.choose"), words("services.none"), (name) => this._choose(name));
    const all = h("input", { type: "checkbox", checked: this.all, onchange: () => { this.all = all.checked; this._list(); this.app.remember(); } });
    this.type = h("p", { class: "dim" });
    this.place = h("form", { onsubmit: (event) => { event.preventDefault(); this._call(); } });
    this.callButton = h("button", { class: "call" }, words("services.call"));
    this.state = h("p", { role: "status", class: "state" });
    this.tree = new Tree(words);
    this.tree.onchange = () => this.answer && this.tree.show(this.service, this.answer);
    this.element.append(h("div", { class: "row" }, this.picker.element, h("label", { title: words("services.hidden_title") }, all, " ", words("services.hidden"))),
      h("div", { class: "scroll padded" }, this.type, this.place, this.state, this.tree.element));
  }

  _list() {
    const { connection, words } = this.app, names = [...connection.services.values()].filter((each) => this.all || (!each.hidden && !COMMON.test(each.name))).map(({ name }) => name);
    this.service = this.picker.show(names, this.service);
    const found = connection.service(this.service);
    if (found?.type !== this.shown?.type || found?.name !== this.shown?.name) this._form(found);
    const why = connection.isReadOnly ? words("read-only.why") : "";
    this.callButton.disabled = Boolean(why) || !found || this.busy;
    this.callButton.title = why;
    if (why) this._tell(why, "warn");
    else if (!found) this._tell(absence(this.app, this.service, words("services.none_why")), this.service ? "warn" : "dim");
  }

  _choose(name) {
    if (this.form) this._keep();
    this.service = name;
    this._list();
    this.app.remember();
  }

  /** Show a service, and give the keyboard to its form. */
  find(name) {
    this._choose(name);
    this.place.querySelector("input, select, .call")?.focus();
  }

  _form(found) {
    this.shown = found;
    this.answer = null;
    this.tree.element.replaceChildren();
    this.tree.topic = null;
    this._tell("");
    this.type.textContent = found?.type ?? "";
    if (!found) return this.place.replaceChildren();
    const schema = partSchema(found, "request");
    this.form = new Form(schema, this.app.words, schema.root, this.values[found.name]);
    this.place.replaceChildren(this.form.element, this.callButton);
  }

  /** Keep what was typed for each service, where JSON can. */
  _keep() {
    if (!this.shown) return;
    try {
      const { value } = this.form;
      JSON.stringify(value);
      this.values = { ...this.values, [this.shown.name]: value };
    } catch { /* half typed, or an integer that JSON has not */ }
  }

  _tell(text, kind = "") {
    this.state.textContent = text;
    this.state.className = `state ${kind}`;
    if (text) this.state.scrollIntoView({ block: "nearest" });
  }

  async _call() {
    if (this.busy || this.callButton.disabled) return;
    const { words, connection } = this.app, { service } = this, start = performance.now();
    try {
      const request = this.form.value;
      this.busy = this.callButton.disabled = true;
      this._tell(words("services.calling"));
      const answer = await connection.call(service, request);
      if (service !== this.service) return;
      this.answer = answer;
      this.tree.show(service, answer);
      const good = answer.success === false ? "warn" : "good";
      this._tell(words("services.answered", { seconds: ((performance.now() - start) / 1000).toFixed(3) }), good);
    } catch (error) {
      if (service === this.service) this._tell(error.message, "error");
    } finally {
      this.busy = false;
      this.callButton.disabled = connection.isReadOnly;
    }
  }
}

export const panel = { id: "services", create: (element, app, options) => new Services(element, app, options) };
