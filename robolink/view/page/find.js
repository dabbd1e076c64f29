// Find: a text opens what it names, so that nothing is more than five keys away: a panel, topic, field, service or parameter.

import { short } from "./cdr.js";
import { COMMON } from "./connection.js";
import { h } from "./dom.js";
import { offered } from "./layouts.js";
import { showModal } from "./stop.js";
import { addPairs, words } from "./words.js";

addPairs("find", {
  find: ["Find", "Buscar"], title: ["panel, topic, field, service or parameter (/)", "painel, topic, campo, service ou parâmetro (/)"],
  none: ["nothing has this name", "nada tem esse nome"],
});

const MOST = 30; // entries that are shown
const PICTURE = /\/(Compressed)?Image$/;

/** Paths of the numbers in messages of a type, those of arrays left out. */
function* numbers(schema, type, path = "") {
  for (const field of schema.fields(type)) {
    if (field.shape !== "one") continue;
    if (path.length > 300 || (!field.primitive && !schema.types.has(short(field.type)))) continue; // a type within itself, or left out
    if (!field.primitive) yield* numbers(schema, field.type, `${path}${field.name}.`);
    else if (!field.type.endsWith("string")) yield path + field.name;
  }
}

/** All that can be found, as [text, kind, act]. */
function entries(app, parameters) {
  const panels = offered(app), found = panels.map((id) => [words(`panel.${id}`), "", () => app.layout.open(id)]);
  const add = (text, id, ...what) => found.push([text, words(`panel.${id}`), () => app.layout.open(id).loaded.then(() => app.layout.panel(id)?.find(...what))]);
  for (const { name, hidden } of app.connection.services.values()) if (!hidden && !COMMON.test(name)) add(name, "services", name);
  for (const { name } of parameters) add(name.replace(".", " "), "parameters", ...name.split(/\.(.*)/, 2));
  for (const { name, type, schema } of app.store.list()) {
    add(name, PICTURE.test(type) ? "images" : "topics", name);
    if (!schema) continue;
    for (const path of numbers(schema)) found.push([`${name} ${path}`, words("panel.plot"), () => app.emit("pick", name, path)]);
  }
  return found;
}

/** Find: ask for a text, and open what it names: the shortest that has all of its words stands first, and Enter takes it. */
export function find(app) {
  const { connection } = app, title = words("find.title"), list = h("div", { id: "found" });
  const input = h("input", { "aria-label": title, placeholder: title, autocomplete: "off", oninput: () => show() });
  let parameters = [];
  const off = connection.on("parameters", (told) => { ({ parameters } = told); show(); });
  const dialog = h("dialog", { class: "find", onclose: () => { off(); dialog.remove(); } },
    h("form", { method: "dialog", onsubmit: (event) => { event.preventDefault(); list.firstChild.click?.(); } }, input), list);
  const show = () => {
    const wanted = input.value.toLowerCase().split(/\s+/);
    const found = entries(app, parameters).filter(([text, kind]) => wanted.every((each) => `${text} ${kind}`.toLowerCase().includes(each)));
    if (input.value) found.sort(([a], [b]) => a.length - b.length);
    list.replaceChildren(...found.slice(0, MOST).map(([text, kind, act]) => h("button", { onclick: () => { dialog.close(); act(); } }, text, h("span", { class: "dim" }, kind))), found.length ? "" : words("find.none"));
  };
  if (connection.info?.capabilities?.includes("parameters")) connection.send({ op: "getParameters", parameterNames: [] });
  showModal(app, dialog);
  show();
}
