// Layout for each kind of system: what is there, which kind of system that is, and the panels that it opens with.
//
// A layout is {columns: [{width, cells: [{height, current, tabs: [{id, options, given}]}]}]}: the panels of a cell share
// its place as tabs; `given` is the text of the options that a panel was opened with. On a phone a column is a page.

/** Panels by name, in the order of the menu: the file is panels/NAME.js, its title the word "panel.NAME". */
export const PANELS = ["world", "topics", "plot", "log", "teleop", "services", "parameters", "images", "graph", "actions", "turtlesim", "learn"];

/** Kinds of systems: one that comes later has more in it than one before. */
export const KINDS = ["empty", "topics", "drive", "camera", "robots", "bag", "learn"];

const BASE = /(^|\/)base_(link|footprint)$/;
const OWN = /^\/(rosout|parameter_events)$/; // what any node publishes, the view's own too
const IMAGE = /^sensor_msgs\/msg\/(Compressed)?Image$/;
const SPATIAL = /\/(LaserScan|OccupancyGrid|MarkerArray|PointCloud2|Odometry|Path)$/;
const LIVE = ["teleop", "services", "parameters", "actions", "graph"]; // panels of what runs now: a bag has none of it

/** Panels that can be added: not those of what a bag cannot do. */
export function offered(app) { return PANELS.filter((id) => (id === "learn" ? app.isLearn : !app.isBag || !LIVE.includes(id))); }

/** What a system has, as far as its layout depends on it. */
export function facts(app) {
  const topics = app.store.list().filter(({ name }) => !OWN.test(name)), frames = app.tf.names(), has = (type) => topics.some((each) => type.test(each.type));
  const [command, type] = [...app.drivable()].sort(([a], [b]) => b.endsWith("/cmd_vel") - a.endsWith("/cmd_vel") || a.length - b.length || (a < b ? -1 : 1))[0] ?? [];
  const spaces = topics.filter((each) => each.type === "nav_msgs/msg/Odometry").map(({ name }) => name.replace(/[^/]*$/, ""));
  const robots = new Set(frames.filter((name) => BASE.test(name)).map((name) => name.replace(BASE, ""))).size
    || [...app.drivable().keys()].filter((name) => name.endsWith("/cmd_vel") && spaces.includes(name.slice(0, -7))).length;
  const pictures = topics.filter(({ type }) => IMAGE.test(type)).map(({ name }) => name);
  return {
    isLearn: app.isLearn, isBag: app.isBag, isEmpty: !topics.length && app.connection.graph.nodes.every((name) => /\/_[^/]*$/.test(name)), robots, command,
    twist: type?.endsWith("Stamped") ? "twist." : "", images: pictures.find((name) => name.endsWith("/image_raw")) ?? pictures[0], turtle: has(/^turtlesim\//), spatial: frames.length > 0 || has(SPATIAL),
  };
}

/** Kind of a system with these facts. */
export function kindOf({ isLearn, isBag, isEmpty, robots, images, command, turtle }) {
  return isLearn ? "learn" : isBag ? "bag" : isEmpty ? "empty" : robots > 1 && !turtle ? "robots" : images ? "camera" : command || robots ? "drive" : "topics";
}

/** Layout that a kind of system opens with, on a phone or on a screen. */
export function layoutOf(kind, found, isPhone) { return made((isPhone ? phone : screen)(kind, found)); }

/** Panels that an address asks for by "#NAME+NAME:TOPIC", side by side; null if it asks for none. A panel of one topic shows the one that is named. */
export function asked(hash) {
  const names = hash.slice(1).split("+").map((each) => each.split(":")).filter(([id]) => PANELS.includes(id));
  return names.length ? made(names.map(([id, topic]) => [50, [100, topic ? [id, { topic }] : id]])) : null;
}

function screen(kind, { turtle, command, twist, images, spatial }) {
  const series = ["linear.x", "angular.z"].map((path) => ({ topic: command, path: twist + path }));
  const world = turtle ? "turtlesim" : "world", picture = images ? [["images", { topic: images }]] : [];
  const messages = [command ? ["topics", { topic: command, open: true }] : "topics", "log"], plot = command ? ["plot", { seconds: 30, series }] : "plot";
  if (kind === "empty") return [];
  if (kind === "learn") return [[100, [100, "learn"]]];
  if (kind === "robots") return [[72, [100, world]], [28, [100, "topics", "log", "teleop", ...picture]]];
  if (kind === "bag") return spatial ? [[62, [100, world]], [38, [56, ...picture, ...messages], [44, plot]]] : [[50, [100, ...picture, ...messages]], [50, [100, plot]]];
  if (kind === "topics") return [[50, [100, "topics"]], [50, [60, ...(spatial ? [world] : []), "graph"], [40, "log"]]];
  if (kind === "drive") return [[65, [100, world]], [35, [56, ...messages, "teleop"], [44, plot]]];
  return spatial || command ? [[55, [58, world], [42, plot]], [45, [58, ...picture], [42, ...messages, "teleop"]]] : [[60, [100, ...picture]], [40, [100, ...messages]]];
}

/** Pages of the panels that a screen has: the first with what one looks at, above the stick. */
function phone(kind, found) {
  const ids = screen(kind, found).flatMap(([, ...cells]) => cells.flatMap(([, ...tabs]) => tabs)), above = ids.filter((id) => /^(world|turtlesim|images)\b/.test(id));
  const first = ids.includes("teleop") ? [[100, [58, ...above], [42, "teleop"]]] : above.length ? [[100, [100, ...above]]] : [];
  return [...first, ...ids.filter((id) => id !== "teleop" && !above.includes(id)).map((id) => [100, [100, id]])];
}

/** Layout of [[width, [height, panel, panel ...] ...] ...]; a panel is its name, or [name, options]. */
function made(columns) {
  const tab = (id, options = {}) => ({ id, options, given: JSON.stringify(options) });
  return { columns: columns.map(([width, ...cells]) => ({ width, cells: cells.map(([height, ...ids]) => ({ height, current: 0, tabs: ids.map((each) => tab(...[each].flat())) })) })) };
}

/** Layout of what the browser remembers; null if it is nonsense, and without the panels that there are not. */
export function restored(kept) {
  try {
    const columns = kept.columns.map(({ width, cells }) => ({
      width: Number(width) || 50,
      cells: cells.map(({ height, current, tabs }) => ({
        height: Number(height) || 50, current: Number(current) || 0,
        tabs: tabs.filter(({ id }) => PANELS.includes(id)).map(({ id, options = {}, given }) => ({ id, options, given })),
      })).filter(({ tabs }) => tabs.length),
    }));
    return { columns: columns.filter(({ cells }) => cells.length) };
  } catch {
    return null;
  }
}

/** All tabs of a layout. */
export function tabsOf(model) { return model.columns.flatMap(({ cells }) => cells.flatMap(({ tabs }) => tabs)); }

/**
 * Layout of a kind: the one that the person has made (`kept.changed`), else the kind's own. Of the panels' options those
 * that are remembered count, as long as the kind still gives what it gave then.
 */
export function recalled(kept, own) {
  const before = restored(kept), model = (kept?.changed && before) || own, fresh = tabsOf(own);
  for (const tab of tabsOf(model)) {
    const now = fresh.find(({ id }) => id === tab.id);
    if (model === own) Object.assign(tab, { options: tabsOf(before ?? { columns: [] }).find(({ id, given }) => id === tab.id && given === tab.given)?.options ?? tab.options });
    else if (tab.given !== undefined && now && now.given !== tab.given) Object.assign(tab, now);
  }
  return model;
}
