// Record button in the header: starts and stops the server's recorder, with seconds, size and what was dropped.

import { brief, button } from "./dom.js";
import { addPairs, words } from "./words.js";

addPairs("record", {
  start: ["record all topics", "gravar todos os topics"], stop: ["stop recording: {path}", "parar de gravar: {path}"], idle: ["● Rec", "● Gravar"],
  on: ["■ {seconds} s  {size}B", "■ {seconds} s  {size}B"], dropped: ["{count} dropped", "{count} perdidas"],
  done: ["recorded {count} messages, {size}B: {path}", "{count} mensagens gravadas, {size}B: {path}"], bag: ["a bag is shown: there is nothing to record", "um bag é mostrado: não há o que gravar"],
});

/** Put the button into the header, whenever that is built. */
export function addRecordButton(app) {
  const { connection } = app;
  let state = { state: "off" }, shown = null;
  const show = () => {
    if (!shown) return;
    const on = state.state === "on", why = connection.isReadOnly ? words("read-only.why") : connection.info?.robolink?.bag ? words("record.bag") : "";
    const dropped = state.dropped ? `  ${words("record.dropped", { count: state.dropped })}` : "";
    shown.textContent = on ? words("record.on", { seconds: Math.floor(state.seconds ?? 0), size: brief(state.bytes ?? 0) }) + dropped : words("record.idle");
    shown.title = why || (on ? words("record.stop", { path: state.path }) : words("record.start"));
    shown.ariaLabel = shown.title;
    shown.ariaPressed = String(on);
    shown.disabled = Boolean(why) || !connection.isOpen;
  };
  app.on("header", (element) => {
    shown = button("", "", () => connection.record(state.state === "on" ? "stop" : "start"), { id: "record" });
    element.append(shown);
    show();
  });
  connection.on("recording", (told) => {
    const ended = state.state === "on" && told.state === "off";
    state = told;
    if (told.error) app.tell(told.error, true);
    else if (ended) app.tell(words("record.done", { count: brief(told.messages), size: brief(told.bytes), path: told.path }));
    show();
  });
  connection.on("info", show);
  connection.on("close", () => { state = { state: "off" }; show(); });
}
