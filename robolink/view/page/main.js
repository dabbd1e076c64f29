// Entry of the page: the connection, what panels share (`app`), header, STOP, shortcuts and the loop of frames.
//
// What a panel has of `app`:
// - listen(topic, {rate, every}): subscribes, also to a topic that comes later and after a lost connection; returns
//   {topic, close()}. rate in Hz (0: every message); every(view, time, topic) gets each message: topic.decode(view)
// - topics: Map of name to Topic: type, channel (null while nobody publishes), schema, statistics, latest (decoded
//   when it is read), view (its bytes: another object for another message), time (ms), ring.between(start, end) (the
//   last minute, thinned), error
// - store: on("change"): a topic came or went; on("statistics"): once a second; list(): the topics that are shown
// - connection: publish(topic, type, message, {stopAfter}), call(service, request) (a promise), service(name),
//   services, graph, schemaOf(type), record(command), send(operation), isReadOnly, on("services" / "graph" /
//   "parameters" / "recording" / "status" ...)
// - time, now, clock(): time.live, or the timeline was dragged to time.at; now is the shown time and clock() that of
//   what arrives, in milliseconds
// - isBag: the server plays a bag, where nothing can be driven, called or recorded, and clock() is the bag's; isLearn: the
//   page of exercises
// - tf: lookup(frame): pose in the fixed frame, or null; fixed, names()
// - words(key, values), tell(text, isError): texts of the page, and notes to the person
// - on("pick", (topic, path) => ...): a number in the tree of a message was clicked; a drag has text/robolink-field,
//   JSON {topic, path}
// - stopping: STOP (stop.js): held, press(), release(); on("stop") tells of a press and of each change
// - drivable(): topics that drive robots, with their types
// - on("header", (element) => ...): place for a tool in the header; also emitted when it is built again

import { Connection } from "./connection.js";
import { button, Emitter, h, isTyping, recall, remember } from "./dom.js";
import { find } from "./find.js";
import { Layout } from "./layout.js";
import { offered } from "./layouts.js";
import { addRecordButton } from "./recording.js";
import { showModal, Stop } from "./stop.js";
import { Frames } from "./tf.js";
import { Timeline } from "./timeline.js";
import { Topics } from "./topics.js";
import { choose, words } from "./words.js";

const TWISTS = ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"];
const SEVERAL = ["world", "topics", "plot", "images"]; // panels of which a second one has a use
const SETTINGS = "robolink.settings";

/** What is remembered by the browser beside the layout. */
const settings = { theme: "", language: "", ...recall(SETTINGS) };
choose(settings.language);

/** Everything that a panel may use, as the head of this file lists it. */
class App extends Emitter {
  constructor() {
    super();
    const token = new URLSearchParams(location.search).get("token");
    this.connection = new Connection(`${location.origin.replace(/^http/, "ws")}/ws${token ? `?token=${encodeURIComponent(token)}` : ""}`);
    this.time = { live: true, at: 0 };
    this.store = new Topics(this.connection, this.time);
    this.topics = this.store.map;
    this.tf = new Frames(this.time);
    this.settings = settings;
    this.words = words;
    this.work = 0;
  }

  /** Subscribe to a topic: see Topics.listen. */
  listen(name, options) { return this.store.listen(name, options); }

  /** True where the server plays a bag: nothing can be driven, called or recorded, and time is the bag's. */
  get isBag() { return Boolean(this.connection.info?.robolink?.bag); }

  /** True on the page of `robolink learn view`. */
  get isLearn() { return Boolean(this.connection.info?.robolink?.exercises); }

  /** Time that the page shows, in milliseconds. */
  get now() { return this.time.live ? this.clock() : this.time.at; }

  /** Time of what arrives, in milliseconds: the system's, or that of the bag that is played. */
  clock() { return this.timeline?.bagTime ?? performance.timeOrigin + performance.now(); }

  /** Tell the person something for some seconds. */
  tell(text, isError = false) {
    const note = h("p", { class: isError ? "note error" : "note", role: isError ? "alert" : "status" }, text);
    this.notes.append(note);
    setTimeout(() => note.remove(), isError ? 8000 : 4000);
    while (this.notes.children.length > 4) this.notes.firstChild.remove();
  }

  /** Forget what was received: a bag was moved to another place, or another system runs. */
  forget() {
    this.tf.clear();
    this.store.forget();
  }

  /** Remember layout, options and settings. */
  remember() {
    this.layout.save();
    remember(SETTINGS, settings);
  }

  /** Topics that drive robots, with their types: also those that nobody publishes yet. */
  drivable() {
    const found = new Map();
    for (const topic of this.topics.values()) if (TWISTS.includes(topic.type) && /(^|\/|_)cmd_vel($|\/|_)/.test(topic.name)) found.set(topic.name, topic.type);
    return found;
  }
}

const app = new App();
globalThis.robolink = app; // for people who look with the browser's tools, and for tests

function showTheme() {
  if (settings.theme) document.documentElement.dataset.theme = settings.theme;
  else delete document.documentElement.dataset.theme;
  app.emit("theme");
}

/** Colours of the style sheet, which canvases use too. */
app.colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

/** True while the page is light. */
app.isLight = () => (settings.theme ? settings.theme === "light" : matchMedia("(prefers-color-scheme: light)").matches);

function turnTheme() {
  settings.theme = app.isLight() ? "dark" : "light";
  showTheme();
  app.remember();
}

function turnLanguage() {
  const name = settings.language = choose(settings.language) === "en" ? "pt" : "en";
  showLanguage();
  if (app.connection.learn && !app.connection.isReadOnly) app.connection.send({ op: "learn", command: "language", name });
}

function showLanguage() {
  choose(settings.language);
  app.remember();
  buildHeader();
  app.timeline.build();
  app.layout.rebuild();
}

/** What is shown: the bag, or the domain of the running system. */
function systemName() {
  const { bag, domain } = app.connection.info?.robolink ?? {};
  return bag ? bag.split(/[\\/]/).filter(Boolean).pop() : domain === undefined ? "robolink" : words(app.isLearn ? "panel.learn" : "domain", { domain });
}

function buildHeader() {
  document.documentElement.lang = choose(settings.language);
  document.body.classList.toggle("bag", app.isBag);
  document.body.classList.toggle("learning", app.isLearn);
  const name = systemName(), state = h("span", { id: "state", role: "status" });
  document.title = name === "robolink" ? name : `${name} – robolink`;
  const menu = h("select", { id: "add", "aria-label": words("add"), title: words("add"), onchange: () => {
    if (menu.value === "reset") app.layout.reset();
    else if (menu.value === "remove") app.layout.removeLast();
    else if (SEVERAL.includes(menu.value)) app.layout.add(menu.value);
    else app.layout.open(menu.value);
    menu.value = "";
    document.getElementById("menu").hidePopover(); // a phone's: the panel is behind it
  } }, h("option", { value: "" }, words("add")), ...offered(app).map((id) => h("option", { value: id }, words(`panel.${id}`))), app.layout?.isPhone && h("option", { value: "remove" }, words("panel.remove")), h("option", { value: "reset" }, words("layout.reset")));
  const tools = h("span", { id: "tools" });
  document.getElementById("header").replaceChildren(h("h1", { title: name }, name), state, h("span", { class: "gap" }),
    button(words("find.find"), words("find.title"), () => find(app), { id: "find" }), h("button", { id: "more", type: "button", "aria-label": words("more"), popovertarget: "menu" }, "⋯"),
    h("div", { id: "menu", popover: "auto" }, tools, menu, button("◐", words("theme"), turnTheme, { id: "theme" }),
      button(words("language"), null, turnLanguage, { id: "language" }), button("?", words("help"), help, { id: "help" })), app.stopping.button());
  app.emit("header", tools);
  showState();
}

function showState() {
  const state = document.getElementById("state"), { connection } = app;
  const readOnly = connection.isReadOnly;
  state.textContent = connection.isOpen ? (readOnly ? words("read-only") : words("connected")) : words(app.lost ? "lost" : "connecting");
  state.title = readOnly ? words("read-only.why") : "";
  state.className = connection.isOpen ? (readOnly ? "warn" : "good") : "bad";
}

const SHORTCUTS = ["space", "/", "d", "g", "i", "r", "1…9", "⇥ ←→ del", "esc", "p", "l", ", .", "←↑→↓", "+ -", "f", "m", "t", "?"];
const SHORTCUT_WORDS = { "1…9": "digit", ", .": "step", "⇥ ←→ del": "tabs", "←↑→↓": "arrows", "+ -": "zoom" };

function help() {
  const speed = h("p", { class: "dim" }), show = () => { speed.textContent = `robolink ${app.connection.info?.robolink?.version ?? ""} · ${stamps.length} ${words("frames")}/s`; };
  const timer = setInterval(show, 500);
  const keys = SHORTCUTS.filter((key) => !(app.isBag || app.isLearn) || !["space", "d", "g", "i", "r"].includes(key));
  const dialog = h("dialog", { class: "help", onclose: () => { clearInterval(timer); dialog.remove(); } }, h("h2", {}, words("shortcuts")),
    h("dl", {}, ...keys.flatMap((key) => [h("dt", {}, h("kbd", {}, key === "space" ? words("space") : key)), h("dd", {}, words(`key.${SHORTCUT_WORDS[key] ?? key}`))])),
    speed, h("form", { method: "dialog" }, h("button", {}, words("close"))));
  show();
  showModal(app, dialog);
}

/** Drive by keys: the stick has the keyboard. */
function drive() {
  if (app.isBag || app.isLearn) return;
  const { element, loaded } = app.layout.open("teleop");
  loaded.then(() => element.querySelector(".stick")?.focus());
}

/** Do what the world does for a key, wherever the keyboard is. */
function inWorld(event) { app.layout.open("world").loaded.then(() => app.layout.panel("world")?.keys(event)); }

let clicked = null; // what the mouse gave the keyboard to
addEventListener("pointerdown", ({ target }) => { clicked = target.closest("button, summary"); });

function shortcut(event) {
  if (isTyping(event.target) || event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
  const acts = { "?": help, "/": () => find(app), ",": () => app.timeline.step(-1), ".": () => app.timeline.step(1), d: drive, f: inWorld, t: turnTheme, p: () => app.timeline.toggle(), l: () => app.timeline.goLive(), " ": () => app.stopping.press() };
  if (!app.isBag && !app.isLearn) Object.assign(acts, { g: inWorld, i: inWorld, r: () => document.getElementById("record").click() });
  const act = /^[1-9]$/.test(event.key) ? () => app.layout.focus(Number(event.key) - 1) : acts[event.key];
  // Space on a button that was reached by the keyboard is that button's; one that was clicked before must not keep it from stopping.
  if (!act || (event.key === " " && event.target !== clicked && event.target.matches("button, summary"))) return;
  event.preventDefault();
  if (!event.repeat || event.key === " ") act(event);
}

/** Figures that the page measures of itself: frames in the last second, and milliseconds of work in each. */
const stamps = [];
function frame(now) {
  requestAnimationFrame(frame);
  const start = performance.now();
  app.connection.painted();
  app.tf.frame(app.clock());
  app.layout.frame(now);
  app.timeline.frame(now);
  app.work = performance.now() - start;
  stamps.push(now);
  while (stamps[0] < now - 1000) stamps.shift();
  app.emit("frame", now, app.work);
}

function begin() {
  const { connection } = app;
  app.notes = h("div", { id: "notes", "aria-live": "polite" });
  document.body.append(app.notes);
  showTheme();
  addRecordButton(app);
  app.stopping = new Stop(app);
  app.timeline = new Timeline(document.getElementById("timeline"), app);
  buildHeader();
  app.layout = new Layout(document.getElementById("panels"), app);
  app.on("pick", (topic, path) => app.layout.open("plot", ({ series = [], ...more }) => ({ ...more, series: [...series, { topic, path }] }), false));
  for (const [name, stays] of [["/tf", false], ["/tf_static", true]]) {
    app.listen(name, { every: (view, time, topic) => { const message = topic.decode(view); if (message?.transforms) app.tf.add(message, stays ? Infinity : time); } });
  }
  connection.on("info", () => { if (systemName() !== document.querySelector("h1").textContent) buildHeader(); else showState(); });
  let told = ""; // language of the exercises, which the page speaks, too
  connection.on("learn", ({ language }) => {
    if (language === told) return;
    told = language;
    if (choose(settings.language) === language) return;
    settings.language = language;
    showLanguage();
  });
  connection.on("close", (before) => { app.lost ||= Boolean(before); showState(); });
  connection.on("open", () => {
    if (app.lost) app.forget();
    app.lost = false;
  });
  connection.on("status", ({ level, message }) => { if (level > 0) app.tell(message, level > 1); });
  matchMedia("(prefers-color-scheme: light)").addEventListener("change", showTheme);
  addEventListener("keydown", shortcut);
  addEventListener("pagehide", () => app.remember());
  connection.open();
  requestAnimationFrame(frame);
}

begin();
