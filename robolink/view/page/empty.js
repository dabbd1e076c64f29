// Empty page: which network is watched, and what to type so that something appears.

import { h } from "./dom.js";
import { addPairs, words } from "./words.js";

addPairs("nothing", {
  title: ["Nothing is running yet", "Nada está rodando ainda"],
  watched: ["This page watches domain {domain}, network {network}", "Esta página observa o domínio {domain}, rede {network}"],
  localhost: ["this machine", "esta máquina"], lan: ["this machine and its local network", "esta máquina e a rede local"], off: ["nobody else", "ninguém mais"],
  dds: ["ROS 2 nodes by DDS", "nodes ROS 2 por DDS"],
  type: ["In another terminal, type", "Em outro terminal, digite"],
  appears: ["It appears here by itself.", "Aparece aqui sozinho."],
  other: ["Does it run already? Then in another domain or network: both terminals need the same ROS_DOMAIN_ID, and robolink doctor says what is wrong.",
    "Já está rodando? Então em outro domínio ou rede: os dois terminais precisam do mesmo ROS_DOMAIN_ID, e robolink doctor diz o que há de errado."],
});

/** Element of the empty page, with what the server watches. */
export function emptyPage({ connection }) {
  const { domain, network = "" } = connection.info?.robolink ?? {}, text = (key, values) => words(`nothing.${key}`, values);
  const meant = text(network) === `nothing.${network}` ? "" : ` (${text(network)})`;
  return h("div", { class: "nothing" }, h("h2", {}, text("title")), h("p", {}, `${text("watched", { domain, network })}${meant}.`),
    h("p", {}, text("type")), h("pre", {}, "robolink launch wander"), h("p", {}, text("appears")), h("p", { class: "dim" }, text("other")));
}
