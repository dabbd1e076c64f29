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
  return {
    isLearn: app.isLearn, isBag: app.isBag, isEmpty: !topics.length && app.connection.graph.nodes.every((name) => /\/_[^/]*$/.test(name)), robots, command,
    twist: type?.endsWith("Stamped") ? "twist." : "", images: has(IMAGE), turtle: has(/^turtlesim\//), spatial: frames.length > 0 || has(SPATIAL),
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

function parts({ turtle, command, twist }) {
  const series = ["linear.x", "angular.z"].map((path) => ({ topic: command, path: twist + path }));
  return {
    world: turtle ? "turtlesim" : "world",
    messages: command ? ["topics", { topic: command, open: true }] : "topics",
    plot: command ? ["plot", { seconds: 30, series }] : "plot",
  };
}

function screen(kind, found) {
  const { world, messages, plot } = parts(found), { images, spatial, command } = found;
  const picture = images ? ["images"] : [];
  switch (kind) {
    case "empty": return [];
    case "learn": return [[100, [100, "learn"]]];
    case "drive": return [[65, [100, world]], [35, [56, messages, "log", "teleop"], [44, plot]]];
    case "robots": return [[72, [100, world]], [28, [100, "topics", "log", "teleop", ...picture]]];
    case "camera": return spatial || command ? [[55, [58, world], [42, plot]], [45, [58, "images"], [42, messages, "log", "teleop"]]] : [[60, [100, "images"]], [40, [100, "topics", "log"]]];
    case "bag": return spatial ? [[62, [100, "world"]], [38, [56, ...picture, messages, "log"], [44, plot]]] : [[50, [100, ...picture, messages]], [50, [56, plot], [44, "log"]]];
    default: return [[50, [100, "topics"]], [50, [60, ...(spatial ? ["world"] : []), "graph"], [40, "log"]]];
  }
}

function phone(kind, found) {
  const { world, messages, plot } = parts(found), picture = found.images ? ["images"] : [];
  const pages = (...ids) => ids.map((id) => [100, [100, id]]);
  switch (kind) {
    case "empty": return [];
    case "learn": return pages("learn");
    case "bag": return [[100, [100, ...(found.spatial ? ["world"] : []), ...picture, ...(found.spatial || found.images ? [] : ["topics"])]], ...pages(messages, plot, "log")];
    case "topics": return pages("topics", found.spatial ? "world" : "graph", "log", "plot");
    default: return [[100, [58, world, ...picture], [42, "teleop"]], ...pages(messages, plot, "log")];
  }
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
        tabs: tabs.filter(({ id }) => PANELS.includes(id)).map(({ id, options, given }) => ({ id, options: options ?? {}, given })),
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
