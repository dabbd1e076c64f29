// Timeline: scrubs the last minute of live data, or the bag that the server plays.

import { brief, button, h } from "./dom.js";
import { MINUTE } from "./ring.js";
import { MEMORY } from "./topics.js";
import { words } from "./words.js";

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];
const PLAYING = 0;

export class Timeline {
  constructor(footer, app) {
    this.footer = footer;
    this.app = app;
    this.bag = null; // {start, end, time, playing, speed} in milliseconds, while the server plays a bag
    this._at = 0;
    this._requests = this._answered = 0; // numbers of the last request to the server, and of the last one that it has answered
    app.connection.on("info", (info) => this._info(info));
    app.connection.on("playback", (state) => this._state(state));
    app.connection.on("time", (time) => { if (this.bag && this._isAnswered) this.bag.time = time; });
    this.build();
  }

  /** False while the server's times are older than what was requested last. */
  get _isAnswered() { return this._answered === this._requests; }

  /** Time of the bag, or undefined without one. */
  get bagTime() { return this.bag?.time; }

  build() {
    this.toggleButton = button("❚❚", words("pause"), () => this.toggle(), { id: "pause" });
    this.slider = h("input", { type: "range", id: "scrub", min: 0, max: 1, step: "any", value: 1, "aria-label": words("timeline"),
      oninput: () => this._scrub(Number(this.slider.value)) });
    this.label = h("output", { class: "dim", id: "when" });
    this.live = button(words("live"), words("live.title"), () => this.goLive(), { id: "live" });
    this.speeds = h("select", { "aria-label": words("speed"), title: words("speed"), id: "rate",
      onchange: () => this._control({ speed: Number(this.speeds.value) }) },
      ...SPEEDS.map((each) => h("option", { value: each, selected: each === (this.bag?.speed ?? 1) }, `${each}×`)));
    const about = this.bag?.start > 1e11 ? h("span", { id: "about" }, begun(this.bag)) : ""; // a simulation's time has no date
    this.footer.replaceChildren(this.toggleButton, about, this.slider, this.label, this.bag ? this.speeds : this.live);
    document.querySelector(this.bag ? "header" : "main").after(this.footer); // a bag's is what one comes for: at the top
    this._show();
  }

  toggle() {
    if (this.bag) return this._control({ play: !this.bag.playing });
    const { time } = this.app;
    if (!time.live) return this.goLive();
    time.at = this.app.clock();
    time.live = false;
    this._show();
  }

  goLive() {
    if (this.bag) return;
    this.app.time.live = true;
    this._show();
  }

  frame(now) {
    if (now - this._at < 200) return;
    this._at = now;
    this._show();
  }

  /** Go some seconds on, or back. */
  step(seconds) {
    const [start, end] = this._span(), { bag } = this, { time } = this.app, at = bag ? bag.time : time.live ? end : time.at;
    const to = Math.max(start, Math.min(end, at + seconds * 1000));
    if (bag) bag.time = to; // the next step may come before the server's answer, and an earlier step's answer before that
    this._scrub((to - start) / (end - start));
  }

  /** First and last time of the slider. */
  _span() {
    if (this.bag) return [this.bag.start, this.bag.end];
    const end = this.app.clock();
    return [end - MINUTE, end];
  }

  _scrub(share) {
    const [start, end] = this._span(), at = start + share * (end - start);
    if (this.bag) return this._control({ seek: at });
    this.app.time.live = share >= 1;
    this.app.time.at = at;
    this._show();
  }

  _control({ play = this.bag.playing, speed = this.bag.speed, seek }) {
    this.app.connection.playback({ play, speed, seek, id: `${++this._requests}` });
  }

  _info(info) {
    const ms = (time) => (time ? time.sec * 1000 + time.nsec / 1e6 : 0);
    const had = Boolean(this.bag);
    this._answered = this._requests; // a new connection answers nothing of before
    this.bag = (info.capabilities ?? []).includes("playbackControl")
      ? { start: ms(info.dataStartTime), end: ms(info.dataEndTime), time: ms(info.dataStartTime), playing: true, speed: 1 } : null;
    if (had || this.bag) this.build();
  }

  _state({ status, time, speed, didSeek, id }) {
    if (!this.bag) return;
    if (id) this._answered = Number(id);
    if (didSeek) this.app.forget(); // what is so at the new time follows
    if (this._isAnswered) Object.assign(this.bag, { time, speed, playing: status === PLAYING });
    this.speeds.value = speed;
    this._at = 0; // shown with the next frame
  }

  _show() {
    const [start, end] = this._span(), { time, store } = this.app;
    const at = this.bag ? this.bag.time : time.live ? end : time.at;
    if (document.activeElement !== this.slider || time.live || this.bag) this.slider.value = (at - start) / Math.max(1, end - start);
    const runs = this.bag ? this.bag.playing : time.live;
    this.toggleButton.textContent = runs ? "❚❚" : "▶";
    this.toggleButton.title = words(runs ? "pause" : "play");
    this.toggleButton.setAttribute("aria-label", this.toggleButton.title);
    this.live.classList.toggle("on", time.live);
    this.slider.title = this.bag ? "" : words("timeline.memory", { bytes: `${brief(store.memory)}B`, most: `${brief(MEMORY)}B` });
    this.label.textContent = this.bag ? `${seconds(at - start)} / ${seconds(end - start)}`
      : time.live ? "" : words("ago", { seconds: ((end - at) / 1000).toFixed(1) });
  }
}

/** Date and time at which a bag begins. */
function begun({ start }) { return new Date(start).toLocaleString(document.documentElement.lang, { dateStyle: "medium", timeStyle: "short" }); }

function seconds(ms) {
  const all = Math.max(0, ms) / 1000, minutes = Math.floor(all / 60);
  return `${minutes}:${(all - 60 * minutes).toFixed(1).padStart(4, "0")}`;
}
