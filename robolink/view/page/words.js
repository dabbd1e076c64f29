// Words of the page in English and Portuguese. A panel's own are added with `addPairs`.

const WORDS = {
  en: {
    "language": "Português", "connecting": "connecting…", "connected": "connected", "lost": "connection lost: trying again",
    "read-only": "read-only", "read-only.why": "this page was opened without the token: it may look, but not act",
    "theme": "dark or light", "help": "shortcuts (?)", "close": "close",
    "add": "Add panel", "layout.reset": "Reset layout", "layout.split": "edge of a panel", "more": "menu", "pages": "pages", "domain": "domain {domain}", "panel.drive": "Drive", "panel.bigger": "whole page", "panel.move": "move",
    "panel.remove": "remove panel", "panel.world": "World", "panel.topics": "Topics", "panel.plot": "Plot", "panel.log": "Log", "panel.teleop": "Teleop",
    "panel.services": "Services", "panel.parameters": "Parameters", "panel.images": "Images", "panel.graph": "Graph", "panel.actions": "Actions", "panel.turtlesim": "Turtlesim", "panel.learn": "Exercises", "frames": "frames",
    "empty": "no panels: add one above", "loading": "loading…",
    "live": "live", "live.title": "back to now (l)", "pause": "pause (p)", "play": "play (p)", "timeline": "time",
    "timeline.memory": "last minute: {bytes} of {most}", "ago": "{seconds} s ago", "speed": "speed",
    "shortcuts": "Shortcuts", "space": "space",
    "key.space": "stop all robots", "key.?": "this list", "key.p": "pause or go on", "key.l": "back to now",
    "key.digit": "to the panel of this number", "key.d": "drive by keys", "key./": "find, and open it", "key.r": "record, and end it", "key.step": "one second back, on", "key.tabs": "on a panel's tab: the next one, close it", "key.t": "dark or light", "key.esc": "close; end a tool",
    "key.arrows": "world: move; timeline: step", "key.zoom": "world: zoom in, out", "key.f": "world: fit all",
    "key.g": "world: goal pose (arrows, with ⇧ its heading, enter)", "key.i": "world: initial pose",
    "world.fit": "fit all (f)", "world.follow": "follow", "world.layers": "layers",
    "world.fixed": "fixed frame", "world.goal": "goal pose (g)", "world.initial": "initial pose (i)",
    "world.tool": "click, and drag to set the heading", "world.sent": "{topic}: x {x}, y {y}, {degrees}° in {frame}",
    "world.unconnected": "not connected to {frame}, drawn at its origin: {frames}", "world.none": "nothing to show yet",
    "world.unheard": "nobody listens to {topic}", "world.unheard.goal": "nobody listens to {topic}: start a node that drives there, such as: robolink run goto",
    "key.m": "world: layers, follow, fixed frame",
    "world.tf": "tf frames", "world.trails": "trails", "world.grid": "grid", "world.names": "names",
    "world.tool.fit": "fit", "world.tool.goal": "goal", "world.tool.pose": "pose", "world.zoomin": "zoom in (+)", "world.zoomout": "zoom out (-)",
    "topics.filter": "filter", "topics.topic": "topic", "topics.type": "type", "topics.rate": "Hz",
    "topics.bandwidth": "B/s", "topics.age": "age", "topics.publishers": "pub", "topics.subscriptions": "sub",
    "topics.none": "no topics", "topics.waiting": "no message yet", "topics.back": "back to the list",
    "topics.count": "{count} topics", "tree.more": "{count} more", "tree.drag": "drag to a plot",
  },
  pt: {
    "language": "English", "connecting": "conectando…", "connected": "conectado", "lost": "conexão perdida: tentando de novo",
    "read-only": "só leitura", "read-only.why": "esta página foi aberta sem o token: pode olhar, mas não agir",
    "theme": "escuro ou claro", "help": "atalhos (?)", "close": "fechar",
    "add": "Novo painel", "layout.reset": "Layout inicial", "layout.split": "borda de um painel", "more": "menu", "pages": "páginas", "domain": "domínio {domain}", "panel.drive": "Dirigir", "panel.bigger": "página inteira", "panel.move": "mover",
    "panel.remove": "remover painel", "panel.world": "Mundo", "panel.topics": "Topics", "panel.plot": "Gráfico", "panel.log": "Log", "panel.teleop": "Teleoperação",
    "panel.services": "Services", "panel.parameters": "Parâmetros", "panel.images": "Imagens", "panel.graph": "Grafo", "panel.actions": "Actions", "panel.turtlesim": "Turtlesim", "panel.learn": "Exercícios", "frames": "quadros",
    "empty": "nenhum painel: adicione um acima", "loading": "carregando…",
    "live": "ao vivo", "live.title": "voltar ao agora (l)", "pause": "pausar (p)", "play": "continuar (p)", "timeline": "tempo",
    "timeline.memory": "último minuto: {bytes} de {most}", "ago": "há {seconds} s", "speed": "velocidade",
    "shortcuts": "Atalhos", "space": "espaço",
    "key.space": "parar todos os robôs", "key.?": "esta lista", "key.p": "pausar ou continuar", "key.l": "voltar ao agora",
    "key.digit": "ir ao painel deste número", "key.d": "dirigir por teclas", "key./": "buscar, e abrir", "key.r": "gravar, e encerrar", "key.step": "um segundo atrás, à frente", "key.tabs": "na aba de um painel: a próxima, fechar", "key.t": "escuro ou claro", "key.esc": "fechar; encerrar a ferramenta",
    "key.arrows": "mundo: mover; tempo: passo", "key.zoom": "mundo: aproximar, afastar", "key.f": "mundo: mostrar tudo",
    "key.g": "mundo: pose de destino (setas, com ⇧ a direção, enter)", "key.i": "mundo: pose inicial",
    "world.fit": "mostrar tudo (f)", "world.follow": "seguir", "world.layers": "camadas",
    "world.fixed": "referencial fixo", "world.goal": "pose de destino (g)", "world.initial": "pose inicial (i)",
    "world.tool": "clique, e arraste para dar a direção", "world.sent": "{topic}: x {x}, y {y}, {degrees}° em {frame}",
    "world.unconnected": "sem ligação com {frame}, desenhado na origem: {frames}", "world.none": "nada para mostrar ainda",
    "world.unheard": "ninguém escuta {topic}", "world.unheard.goal": "ninguém escuta {topic}: inicie um node que dirige até lá, como: robolink run goto",
    "key.m": "mundo: camadas, seguir, referencial fixo",
    "world.tf": "referenciais tf", "world.trails": "rastros", "world.grid": "grade", "world.names": "nomes",
    "world.tool.fit": "tudo", "world.tool.goal": "destino", "world.tool.pose": "pose", "world.zoomin": "aproximar (+)", "world.zoomout": "afastar (-)",
    "topics.filter": "filtrar", "topics.topic": "topic", "topics.type": "tipo", "topics.rate": "Hz",
    "topics.bandwidth": "B/s", "topics.age": "idade", "topics.publishers": "pub", "topics.subscriptions": "sub",
    "topics.none": "nenhum topic", "topics.waiting": "nenhuma mensagem ainda", "topics.back": "voltar à lista",
    "topics.count": "{count} topics", "tree.more": "mais {count}", "tree.drag": "arraste para um gráfico",
  },
};

let language = "en";

/** Add a panel's words under a name: {key: [English, Portuguese]}. */
export function addPairs(name, pairs) {
  for (const [key, [en, pt]] of Object.entries(pairs)) {
    WORDS.en[`${name}.${key}`] = en;
    WORDS.pt[`${name}.${key}`] = pt;
  }
}

/** Choose the language: "en" or "pt"; anything else is what the browser asks for. */
export function choose(wanted) {
  const told = wanted || (globalThis.navigator?.languages ?? []).find((each) => /^(en|pt)/.test(each)) || "en";
  language = `${told}`.startsWith("pt") ? "pt" : "en";
  return language;
}

/** Text of a key with {names} filled in; the key itself where there is no text. */
export function words(key, values = {}) {
  const text = WORDS[language][key] ?? WORDS.en[key] ?? key;
  return text.replace(/\{(\w+)\}/g, (_, name) => values[name] ?? "");
}

/** Languages and their texts, for the test that none is missing. */
export { WORDS };
