// Actions panel: sends goals with a form made from the type; feedback, status, result and cancelling, by an action's services and topics.

import { partSchema } from "../connection.js";
import { button, h } from "../dom.js";
import { addPairs } from "../words.js";
import { absence, Form, Picker } from "./form.js";
import { leaf, Tree } from "./tree.js";

addPairs("actions", {
  choose: ["action", "action"], none: ["no actions", "nenhuma action"], none_why: ["No node serves an action. One to try: robolink run examples_rclpy_minimal_action_server server", "Nenhum node serve uma action. Uma para experimentar: robolink run examples_rclpy_minimal_action_server server"], send: ["Send goal", "Enviar objetivo"], cancel: ["Cancel", "Cancelar"],
  cancelling: ["canceling", "cancelando"], rejected: ["rejected", "rejeitado"], sent: ["sent…", "enviado…"], feedback: ["feedback", "feedback"], result: ["result", "resultado"],
  refused: ["the cancel request was refused", "o cancelamento foi recusado"],
  0: ["unknown", "desconhecido"], 1: ["accepted", "aceito"], 2: ["executing", "executando"], 3: ["canceling", "cancelando"], 4: ["succeeded", "concluído"], 5: ["canceled", "cancelado"], 6: ["aborted", "abortado"],
});

const GOAL = "/_action/send_goal", KEPT = 10, LONG = 24 * 3600;

class Actions {
  constructor(element, app, options) {
    Object.assign(this, { element, app, action: "" }, options);
    this.goals = new Map(); // id -> {element, ...}
    this.handles = [];
    this._build();
    this.offs = [app.connection.on("services", () => this._list()), app.connection.on("info", () => this._list())];
    this._list();
  }

  save() { return { action: this.action }; }

  close() {
    for (const off of this.offs) off();
    for (const each of this.handles) each.close();
  }

  _build() {
    const { words } = this.app;
    this.picker = new Picker(words("actions.choose"), words("actions.none"), (name) => { this.action = name; this._list(); this.app.remember(); });
    this.type = h("p", { class: "dim" });
    this.sendButton = h("button", { class: "send" }, words("actions.send"));
    this.place = h("form", { onsubmit: (event) => { event.preventDefault(); this._send(); } });
    this.state = h("p", { role: "status", class: "state" });
    this.list = h("div", { class: "goals" });
    this.element.append(h("div", { class: "row" }, this.picker.element), h("div", { class: "scroll padded" }, this.type, this.place, this.state, this.list));
  }

  _list() {
    const { connection, words } = this.app;
    const names = [...connection.services.values()].filter(({ name }) => name.endsWith(GOAL)).map(({ name }) => name.slice(0, -GOAL.length));
    this.action = this.picker.show(names, this.action);
    const found = connection.service(this.action + GOAL), why = connection.isReadOnly ? words("read-only.why") : "";
    if (found && (found.name !== this.shown?.name || found.type !== this.shown?.type)) this._follow(found);
    this.sendButton.disabled = Boolean(why) || !found;
    this.sendButton.title = why;
    if (why) this._tell(why, "warn");
    else if (!found) this._tell(absence(this.app, this.action, words("actions.none_why")), this.action ? "warn" : "dim");
    else if (this.isAway) this._tell("");
    this.isAway = !found;
  }

  _tell(text, kind = "") {
    this.state.textContent = text;
    this.state.className = `state ${kind}`;
    if (text) this.state.scrollIntoView({ block: "nearest" });
  }

  _follow(found) {
    this.shown = found;
    this._tell("");
    this.goals.clear();
    this.list.replaceChildren();
    for (const each of this.handles) each.close();
    const follow = (name, every) => this.app.listen(`${this.action}/_action/${name}`, { every: (view, _, topic) => { const message = topic.decode(view); if (message) every(message); } });
    this.handles = [
      follow("feedback", ({ goal_id: id, feedback }) => this.goals.get(hex(id.uuid))?.feedback(feedback)),
      follow("status", ({ status_list: list }) => { for (const each of list) this.goals.get(hex(each.goal_info.goal_id.uuid))?.status(each.status); }),
    ];
    const schema = partSchema(found, "request"), goal = schema.fields().find(({ name }) => name === "goal");
    this.type.textContent = found.type.replace(/_SendGoal$/, "");
    this.form = new Form(schema, this.app.words, goal.type);
    this.place.replaceChildren(this.form.element, this.sendButton);
  }

  async _send() {
    if (this.sendButton.disabled) return;
    const { connection, words } = this.app, { action } = this, uuid = crypto.getRandomValues(new Uint8Array(16)), id = { uuid: Array.from(uuid) };
    let goal = null;
    try {
      const wanted = this.form.value;
      this._tell("");
      goal = this._goal(action, id);
      const { accepted } = await connection.call(action + GOAL, { goal_id: id, goal: wanted });
      if (!accepted) return goal.end(words("actions.rejected"), "warn");
      goal.status(1);
      const { status, result } = await connection.call(`${action}/_action/get_result`, { goal_id: id }, LONG);
      goal.done(status, result);
    } catch (error) {
      if (goal) goal.end(error.message, "error");
      else this._tell(error.message, "error");
    }
  }

  /** A goal in the list, with what can be told to it. */
  _goal(action, id) {
    const { words, connection } = this.app;
    const state = h("b", { class: "goal-state" }, words("actions.sent")), feedback = h("p", { class: "feedback dim" }), tree = new Tree(words);
    const cancel = button(words("actions.cancel"), null, async () => {
      try {
        const { return_code: code } = await connection.call(`${action}/_action/cancel_goal`, { goal_info: { goal_id: id } });
        if (code) this._tell(words("actions.refused"), "error");
      } catch (error) {
        this._tell(error.message, "error");
      }
    }, { className: "cancel" });
    const element = h("section", { class: "goal", "data-goal": hex(id.uuid) }, h("div", { class: "row" }, state, h("span", { class: "dim" }, new Date().toLocaleTimeString("en-GB")), h("span", { class: "gap" }), cancel), feedback, tree.element);
    this.list.prepend(element);
    let ended = false, reached = 0; // the status may be heard before the answer that the goal was accepted
    const end = (text, kind) => {
      ended = true;
      state.textContent = text;
      state.className = `goal-state ${kind}`;
      cancel.remove();
    };
    const goal = {
      end,
      feedback: (message) => { feedback.textContent = `${words("actions.feedback")}: ${Object.entries(message).map(([name, value]) => `${name} ${leaf(value) || JSON.stringify(value, plain)}`).join(", ")}`; },
      status: (code) => {
        if (ended || code < reached) return;
        reached = code;
        state.textContent = words(`actions.${code}`);
      },
      done: (code, result) => {
        end(words(`actions.${code}`), code === 4 ? "good" : "warn");
        tree.onchange = () => tree.show(words("actions.result"), result);
        tree.onchange();
      },
    };
    this.goals.set(hex(id.uuid), goal);
    while (this.list.children.length > KEPT) {
      this.goals.delete(this.list.lastChild.dataset.goal);
      this.list.lastChild.remove();
    }
    return goal;
  }
}

const hex = (uuid) => Array.from(uuid, (each) => each.toString(16).padStart(2, "0")).join("");

function plain(_, value) {
  if (typeof value === "bigint") return `${value}`;
  return ArrayBuffer.isView(value) ? leaf(value) : value;
}

export const panel = { id: "actions", create: (element, app, options) => new Actions(element, app, options) };
