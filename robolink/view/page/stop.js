// STOP: one lock for the whole system, which the server keeps. Its button in the header, the banner while it holds, the key.
//
// The page shows what the server tells, never what it hopes for: a press is sent again until it is told, also after a
// lost connection. A release is sent once, and only by a click or Enter: a key that is hit in a hurry never releases.

import { button, h } from "./dom.js";
import { addPairs } from "./words.js";

addPairs("stop", {
  press: ["STOP", "PARAR"], title: ["Hold all robots at zero until somebody releases them (space)", "Manter todos os robôs parados até que alguém os libere (espaço)"],
  release: ["RELEASE", "LIBERAR"], release_title: ["Let the robots move again", "Deixar os robôs andarem de novo"],
  holds: ["STOP holds", "PARADA ativa"], until: ["It stays until somebody releases it, also when this page is closed.", "Fica até que alguém a libere, mesmo com esta página fechada."],
  obeyed: ["{nodes}: obeys, whoever sends commands.", "{nodes}: obedece, mande quem mandar."],
  unheard: ["{nodes} does not listen to /e_stop: zeros go to {topics} 20 times a second, and another publisher may move it in between.",
    "{nodes} não escuta /e_stop: zeros vão para {topics} 20 vezes por segundo, e outro publisher pode movê-lo entre eles."],
  more: ["{names} and {count} more", "{names} e mais {count}"],
  nobody: ["No robot is known: one that starts now is held.", "Nenhum robô conhecido: um que comece agora fica parado."],
  sending: ["STOP is not confirmed yet: sending it again…", "PARADA ainda não confirmada: enviando de novo…"],
});

const AGAIN = 250; // ms after which a press that was not told is sent again
const SHOWN = 4; // names in a line
const GUARD = 700; // ms in which a release does nothing: the second half of a double click

/** Show a dialog above the page: a press beside it closes it, and on STOP presses that, which must stay in reach. */
export function showModal(app, dialog) {
  dialog.addEventListener("pointerdown", ({ clientX, clientY }) => {
    const { left, right, top, bottom } = dialog.getBoundingClientRect();
    if (clientX >= left && clientX <= right && clientY >= top && clientY <= bottom) return;
    dialog.close();
    if (document.elementFromPoint(clientX, clientY)?.id === "stop") app.stopping.press();
  });
  document.body.append(dialog);
  dialog.showModal();
}

/** The lock: `held` as the server told it. The app's event "stop" tells of a press, and of every change. */
export class Stop {
  constructor(app) {
    this.app = app;
    this.state = { held: false, obeyed: [], unheard: {} };
    this.since = 0;
    this.banner = h("section", { id: "stopped", role: "alert", hidden: true });
    document.getElementById("header").after(this.banner);
    const { connection } = app;
    connection.on("stop", (state) => this._told(state));
    connection.on("info", () => this.show());
    connection.on("close", () => this.show());
  }

  get held() { return this.state.held; }

  /** True where nothing can be stopped: a bag, exercises, or a page without the token. */
  get isMute() { return this.app.isBag || this.app.isLearn || this.app.connection.isReadOnly; }

  press() {
    this.app.emit("stop");
    if (this.isMute || this.pending) return;
    this.pending = true;
    this._send();
    setTimeout(() => this.show(), AGAIN); // only if it takes long
  }

  _send() {
    if (this.pending && this.isMute) { // the server that came back shows something else
      this.pending = false;
      this.show();
    }
    if (!this.pending) return;
    this.app.connection.send({ op: "stop", held: true });
    setTimeout(() => this._send(), AGAIN);
  }

  release() {
    if (this.pending || this.isMute || performance.now() < this.since + GUARD) return;
    this.app.connection.send({ op: "stop", held: false });
  }

  _told(state) {
    const isNew = state.held !== this.held;
    if (isNew) this.since = performance.now();
    this.state = state;
    if (state.held) this.pending = false;
    this.show();
    if (isNew) this.app.emit("stop");
  }

  /** Button of the header. */
  button() {
    const { words } = this.app;
    this.stop = button(words("stop.press"), words("stop.title"), () => this.press(), { id: "stop", onpointerdown: () => this.press() }); // not when the finger leaves it
    this.show();
    return this.stop;
  }

  show() {
    const { app, banner, stop, state } = this, { words, connection } = app;
    if (!stop) return;
    stop.hidden = app.isBag || app.isLearn;
    stop.disabled = connection.isReadOnly;
    stop.ariaPressed = String(this.held);
    stop.title = words(connection.isReadOnly ? "read-only.why" : "stop.title");
    banner.hidden = stop.hidden || !(this.held || this.pending);
    const some = (names) => (names.length > SHOWN + 1 ? words("stop.more", { names: names.slice(0, SHOWN).join(", "), count: names.length - SHOWN }) : names.join(", "));
    const deaf = new Map(); // topics by the nodes that do not listen there: one robot may have many
    for (const [topic, nodes] of Object.entries(state.unheard)) deaf.set(some(nodes), [...(deaf.get(some(nodes)) ?? []), topic]);
    const lines = [...deaf].map(([nodes, topics]) => h("li", { class: "unheard" }, words("stop.unheard", { nodes, topics: some(topics) })));
    if (state.obeyed.length) lines.unshift(h("li", {}, words("stop.obeyed", { nodes: some(state.obeyed) })));
    if (!lines.length) lines.push(h("li", {}, words("stop.nobody")));
    const text = this.held ? [h("strong", {}, words("stop.holds")), " ", words("stop.until"), h("ul", {}, ...lines)] : [words("stop.sending")];
    const release = button(words("stop.release"), words("stop.release_title"), () => this.release(), { className: "release", disabled: !this.held || !connection.isOpen || this.isMute });
    for (const name of ["keydown", "keyup"]) release.addEventListener(name, (event) => { if (event.key === " ") event.preventDefault(); });
    const focused = banner.contains(document.activeElement);
    banner.replaceChildren(h("div", {}, ...text), release);
    if (focused) release.focus();
  }
}
