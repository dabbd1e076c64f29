// Empty page: which network is watched, and what to type so that something appears.

import { h } from "./dom.js";
import { addPairs, words } from "./words.js";

addPairs("nothing", {
  title: ["Nothing is running yet", "Nada está rodando ainda"],
  watched: ["This page watches domain {domain} of network {network}.", "Esta página observa o domínio {domain} da rede {network}."],
  type: ["In another terminal, type", "Em outro terminal, digite"],
  appears: ["It appears here by itself.", "Aparece aqui sozinho."],
  other: ["If it runs already: is its ROS_DOMAIN_ID the same? robolink doctor says more.", "Se já está rodando: o ROS_DOMAIN_ID é o mesmo? robolink doctor diz mais."],
});

/** Element of the empty page, with what the server watches. */
export function emptyPage({ connection }) {
  const p = (key, type = "p") => h(type, { class: key }, words(`nothing.${key}`, connection.info?.robolink));
  return h("div", { class: "nothing" }, p("title", "h2"), p("watched"), p("type"), h("pre", {}, "robolink launch wander"), p("appears"), p("other"));
}
