// Panel of exercises: the list, the task, its last check in sentences, hints, and the robot's path in the check.

import { button, h } from "../dom.js";
import { addPairs } from "../words.js";
import { Film } from "./learn_track.js";

addPairs("learn", {
  none: ["There are no exercises here. In a terminal: robolink learn view", "Não há exercícios aqui. Em um terminal: robolink learn view"],
  list: ["exercises", "exercícios"], done: ["done", "feito"], next: ["next", "próximo"], open: ["not done", "não feito"],
  check: ["Check", "Testar"], hint: ["Hint {number} of {all}", "Dica {number} de {all}"], "no hint": ["no more hints", "sem mais dicas"],
  reset: ["Reset", "Reiniciar"], reset_title: ["write the file as it was at the beginning; yours is kept under another name", "grava o arquivo como no início; o seu fica com outro nome"],
  sure: ["Reset: sure?", "Reiniciar mesmo?"], onward: ["Next: {file}", "Próximo: {file}"], checking: ["checking…", "testando…"],
  passed: ["done ({seconds} s)", "feito ({seconds} s)"], failed: ["not there yet ({seconds} s)", "ainda não ({seconds} s)"],
  unchecked: ["Save {file} and it is checked.", "Salve {file} e ele é testado."], printed: ["it printed:", "ele imprimiu:"],
  copy: ["Copy", "Copiar"], copy_title: ["copy the path of your file", "copiar o caminho do seu arquivo"], copied: ["copied: {path}", "copiado: {path}"], code: ["your program", "o seu programa"],
  missing: ["This file cannot be read. Reset writes it as it was at the beginning.", "Este arquivo não pode ser lido. Reiniciar o grava como era no início."], failed_line: ["here it failed", "aqui falhou"],
  track: ["the robot's path in the check, from above: {seconds} s, contacts: {contacts}", "o caminho do robô no teste, visto de cima: {seconds} s, contatos: {contacts}"],
  play: ["play or pause", "tocar ou pausar"], time: ["time", "tempo"],
});

const MARKS = { done: "✓", next: "→", open: "" };
const SURE = 4000; // milliseconds that the button asks

let last = ""; // exercise that was chosen, for a page whose language is turned

class Learn {
  constructor(element, app) {
    this.app = app;
    this.words = (key, values) => app.words(`learn.${key}`, values);
    this.name = last;
    this.film = new Film(app, this.words);
    this.detail = null;
    if (!document.querySelector("link[href='panels/learn.css']")) document.head.append(h("link", { rel: "stylesheet", href: "panels/learn.css", onload: () => this._scroll() }));
    this._build(element);
    const { connection } = app;
    this.offs = [connection.on("learn", (state) => this._list(state)), connection.on("exercise", (detail) => this._take(detail)),
      connection.on("info", () => this._buttons()), connection.on("close", () => this._buttons())];
    if (connection.learn) this._list(connection.learn);
  }

  frame(now) { this.film.frame(now); }

  close() {
    for (const off of this.offs) off();
    clearTimeout(this.timer);
    this.film.close();
  }

  _build(element) {
    const { words } = this;
    this.none = h("p", { class: "padded" }, words("none"));
    this.heading = h("p", { class: "dim" });
    this.items = h("ol");
    this.title = h("h3");
    this.text = h("div", { class: "text" });
    this.check = button(words("check"), words("check"), () => this._send("check"), { class: "call" });
    this.hint = button("", null, () => this._send("hint"));
    this.reset = button(words("reset"), words("reset_title"), () => this._reset());
    this.onward = button("", null, () => this._choose(this.following.name));
    this.state = h("span", { role: "status" });
    this.hints = h("ol", { class: "tips" });
    this.findings = h("ul", { class: "findings", "aria-live": "polite" });
    this.printed = h("pre");
    this.output = h("div", {}, h("p", { class: "dim" }, words("printed")), this.printed);
    this.path = h("code");
    this.code = h("pre", { class: "code", tabIndex: 0, "aria-label": words("code") });
    this.file = h("div", { class: "file" }, h("div", { class: "path" }, this.path, button(words("copy"), words("copy_title"), () => this._copy())), this.code);
    this.task = h("div", { class: "task" }, this.title, this.text, h("div", { class: "row" }, this.check, this.hint, this.reset, this.state, this.onward),
      this.hints, this.findings, this.film.element, this.output);
    this.body = h("div", { class: "learn", hidden: true }, h("nav", { "aria-label": words("list"), onkeydown: (event) => this._key(event) }, this.heading, this.items), this.task, this.file);
    element.append(this.none, this.body);
  }

  /** Show the list; after a save, the exercise whose file was saved. */
  _list(state) {
    const isSave = this.list && state.saves !== this.list.saves, isFirst = !this.list;
    this.list = state;
    this.following = state.exercises.find((each) => each.state === "next");
    this.none.hidden = true;
    this.body.hidden = false;
    this.heading.textContent = state.heading;
    const held = document.activeElement?.dataset?.name;
    this.items.replaceChildren(...state.exercises.map((each) => h("li", { class: each.state },
      h("button", { type: "button", "data-name": each.name, title: `${each.file}: ${each.title} (${this.words(each.state)})`, onclick: () => this._choose(each.name) },
        h("b", { role: "img", "aria-label": this.words(each.state) }, MARKS[each.state]), each.file, h("i", {}, each.title)))));
    const known = state.exercises.some((each) => each.name === this.name);
    this._mark();
    if (held) this._item(held)?.focus();
    if (isSave || isFirst || !known) this._choose(isSave || !known ? state.current : this.name);
    else this._buttons();
  }

  _item(name) { return [...this.items.querySelectorAll("button")].find((each) => each.dataset.name === name); }

  /** Mark the chosen one, which alone the Tab key reaches: arrows go to the others. */
  _mark() {
    for (const each of this.items.querySelectorAll("button")) {
      each.ariaCurrent = String(each.dataset.name === this.name);
      each.tabIndex = each.dataset.name === this.name ? 0 : -1;
    }
  }

  _choose(name) {
    if (this.detail?.name !== name) this.detail = null;
    this.name = last = name;
    this._ask(false);
    this._mark();
    this._item(name)?.scrollIntoView({ block: "nearest" });
    this._send("show");
    this._show();
  }

  _key(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key], all = this.list.exercises, next = all[all.findIndex((each) => each.name === this.name) + step];
    if (!next) return;
    event.preventDefault();
    this._choose(next.name);
    this._item(next.name).focus();
  }

  _send(command) { this.app.connection.send({ op: "learn", command, name: this.name }); }

  _reset() {
    const isSure = this.reset.classList.contains("on");
    if (isSure) this._send("reset");
    this._ask(!isSure);
  }

  /** Let the button ask whether it is meant, for some seconds. */
  _ask(asks) {
    this.reset.classList.toggle("on", asks);
    this.reset.textContent = this.words(asks ? "sure" : "reset");
    clearTimeout(this.timer);
    if (asks) this.timer = setTimeout(() => this._ask(false), SURE);
  }

  _take(detail) {
    if (detail.name !== this.name) return;
    this.detail = detail;
    this._show();
  }

  _show() {
    const { words, detail } = this, chosen = this.list.exercises.find((each) => each.name === this.name), report = detail?.report;
    this.title.textContent = chosen ? `${chosen.file}: ${chosen.title}` : "";
    this.text.replaceChildren(...(detail?.text ?? "").split(/\n\s*\n/).map((part) => h("p", {}, part.replace(/\n(?! )/g, " "))));
    this.hints.replaceChildren(...(detail?.hints ?? []).map((text, i) => h("li", {}, h("b", {}, `${i + 1}.`), text)));
    this.findings.replaceChildren(...(report?.findings ?? []).map(({ mark, text, below }) => h("li", {},
      h("b", { class: mark === "✓" ? "good" : "bad" }, mark), h("span", {}, text), below.length ? h("pre", {}, below.join("\n")) : null)));
    this.output.hidden = !report?.printed.length;
    this.printed.textContent = report?.printed.join("\n") ?? "";
    this._program(detail);
    if (this.shown !== report?.number) this.film.show(report?.track);
    this.shown = report?.number;
    this._buttons();
  }

  /** Show path and code of the file, with the line at which the check failed, where it is known. */
  _program(detail) {
    this.file.hidden = !detail;
    const { path, code, line } = detail ?? {}, key = JSON.stringify([path, code, line]);
    if (this.program === key) return; // so that a place to which somebody scrolled stays
    this.program = key;
    this.path.textContent = path ?? "";
    const { scrollTop } = this.code, isSame = this.code.dataset.name === detail?.name, lines = (code ?? "").replace(/\n$/, "").split("\n");
    const isGone = detail && typeof code !== "string";
    this.code.replaceChildren(...(isGone ? [this.words("missing")] : lines.map((text, i) => h("span", i + 1 === line ? { class: "failed", title: this.words("failed_line") } : {}, `${text}\n`))));
    this.code.dataset.name = detail?.name;
    this.code.scrollTop = isSame ? scrollTop : 0;
    this._scroll();
  }

  /** Bring the line that failed into sight, within the code alone. */
  _scroll() {
    const failed = this.code.querySelector(".failed");
    if (failed) this.code.scrollTop = failed.offsetTop - this.code.offsetTop - this.code.clientHeight / 3;
  }

  _copy() {
    const { path } = this.detail;
    navigator.clipboard?.writeText(path).then(() => this.app.tell(this.words("copied", { path }))).catch(() => {});
  }

  _buttons() {
    if (!this.list) return;
    const { words, detail, list, app: { connection } } = this, report = detail?.report, isChecking = list.checking === this.name;
    const why = connection.isReadOnly ? this.app.words("read-only.why") : "", all = detail?.allHints ?? 0, count = detail?.hints.length ?? 0;
    for (const each of [this.check, this.hint, this.reset]) each.disabled = Boolean(why) || !connection.isOpen;
    this.check.title = why || words("check");
    this.hint.disabled ||= count >= all;
    this.hint.textContent = count < all ? words("hint", { number: count + 1, all }) : words("no hint");
    this.state.textContent = isChecking ? words("checking") : report ? words(report.passed ? "passed" : "failed", { seconds: report.seconds.toFixed(1) }) : words("unchecked", { file: list.exercises.find((each) => each.name === this.name)?.file });
    this.state.className = isChecking || !report ? "dim" : report.passed ? "good" : "bad";
    this.onward.hidden = !report?.passed || !this.following || this.following.name === this.name;
    if (this.following) this.onward.textContent = words("onward", { file: this.following.file });
  }
}

export const panel = { id: "learn", create: (element, app) => new Learn(element, app) };
