// Tests of the page's pure modules: ring, frames, layout and words. `node --test tests/view/page/modules.test.mjs`

import assert from "node:assert/strict";
import test from "node:test";
import { Connection } from "../../../robolink/view/page/connection.js";
import { asked, KINDS, kindOf, layoutOf, PANELS, recalled, restored, tabsOf } from "../../../robolink/view/page/layouts.js";
import { at, leaf } from "../../../robolink/view/page/panels/tree.js";
import { MINUTE, Ring } from "../../../robolink/view/page/ring.js";
import { compose, Frames, IDENTITY, inverse, poseOf, yawOf } from "../../../robolink/view/page/tf.js";
import { choose, words, WORDS } from "../../../robolink/view/page/words.js";

const message = (size, fill = 0) => new DataView(new Uint8Array(size).fill(fill).buffer);
const turned = (x, y, yaw) => ({ ...IDENTITY, x, y, qz: Math.sin(yaw / 2), qw: Math.cos(yaw / 2) });

test("a ring keeps the last minute, ten a second", () => {
  const ring = new Ring();
  for (let time = 0; time <= 2 * MINUTE; time += 10) ring.add(time, message(8, time), 1e9);
  assert.equal(ring.length, 601);
  assert.equal(ring.start, MINUTE);
  for (let time = MINUTE; time <= 2 * MINUTE; time += 100) assert.equal(ring.at(time).view.getUint8(7), time & 0xff);
  assert.equal(ring.at(MINUTE + 120), ring.at(MINUTE + 180), "the same object for the same message");
  assert.equal(ring.at(MINUTE + 155).time, MINUTE + 100);
  assert.equal(ring.at(MINUTE - 1), null);
  assert.equal([...ring.between(MINUTE, MINUTE + 1000)].length, 11);
});

test("a ring never holds more than its share, and thins before it forgets", () => {
  const ring = new Ring(), share = 50_000;
  for (let time = 0; time <= MINUTE; time += 20) {
    ring.add(time, message(500), share);
    assert.ok(ring.bytes <= share);
  }
  assert.ok(ring.start < 2000, "the whole minute is there");
  for (let time = MINUTE; time <= 1.5 * MINUTE; time += 20) ring.add(time, message(500), share / 2);
  assert.ok(ring.bytes <= share / 2, "a smaller share");
  const large = new Ring();
  large.add(0, message(60_000), share);
  assert.deepEqual([large.length, large.bytes], [0, 0], "a message that is larger than the share is not kept");
});

test("a ring begins anew when time goes back, and keeps copies", () => {
  const ring = new Ring(), view = message(4, 1);
  ring.add(5000, view, 1e6);
  view.setUint8(0, 9);
  assert.equal(ring.at(5000).view.getUint8(0), 1);
  ring.add(1000, view, 1e6);
  assert.deepEqual([ring.length, ring.start], [1, 1000]);
});

test("poses are composed and inverted", () => {
  const there = compose(turned(1, 2, Math.PI / 2), turned(1, 0, 0.5));
  assert.ok(Math.hypot(there.x - 1, there.y - 3) < 1e-12);
  assert.ok(Math.abs(yawOf(there) - Math.PI / 2 - 0.5) < 1e-12);
  const back = compose(there, inverse(there));
  assert.ok(Math.hypot(back.x, back.y, back.qz) < 1e-12);
  assert.equal(yawOf(poseOf({ position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 0 } })), 0);
});

const transform = (parent, child, x, y, yaw = 0) => ({ header: { frame_id: parent }, child_frame_id: child,
  transform: { translation: { x, y, z: 0 }, rotation: { x: 0, y: 0, z: Math.sin(yaw / 2), w: Math.cos(yaw / 2) } } });

test("frames are looked up through their tree, and circles end", () => {
  const frames = new Frames({ live: true, at: 0 });
  frames.add({ transforms: [transform("map", "odom", 1, 0, Math.PI / 2), transform("/odom", "base_link", 2, 0)] });
  const found = frames.lookup("base_link");
  assert.ok(Math.hypot(found.x - 1, found.y - 2) < 1e-12);
  assert.equal(frames.lookup("elsewhere"), null);
  assert.deepEqual(frames.names(), ["base_link", "map", "odom"]);
  frames.fixed = "base_link";
  frames.clearCache();
  assert.ok(Math.abs(frames.lookup("odom").x + 2) < 1e-12);
  frames.add({ transforms: [transform("a", "b", 0, 0), transform("b", "a", 0, 0)] });
  assert.equal(frames.lookup("a"), null);
});

test("frames of robots that are gone are forgotten, but not where all stand still", () => {
  const frames = new Frames({ live: true, at: 0 });
  frames.add({ transforms: [transform("map", "odom", 0, 0)] });
  for (const name of ["a", "b"]) frames.add({ transforms: [transform("odom", name, 0, 0)] }, 1000);
  frames.frame(60_000);
  assert.equal(frames.nodes.size, 3);
  frames.add({ transforms: [transform("odom", "b", 0, 0)] }, 60_000);
  frames.frame(60_200);
  assert.deepEqual(frames.names(), ["b", "map", "odom"]);
  assert.ok(frames.lookup("b"));
});

test("frames are where they were at the timeline's time", () => {
  const time = { live: true, at: 0 }, frames = new Frames(time);
  for (let now = 0; now <= 1000; now += 100) {
    frames.add({ transforms: [transform("map", "base_link", now, 0)] });
    frames.frame(now);
  }
  Object.assign(time, { live: false, at: 450 });
  frames.frame(1100);
  assert.equal(frames.lookup("base_link").x, 400);
  time.live = true;
  frames.frame(1100);
  assert.equal(frames.lookup("base_link").x, 1000);
});

test("a type that was changed is read by its new text, also after the server was started again", () => {
  const connection = new Connection("ws://nowhere");
  const names = (text) => connection.schemaOf("a/msg/B", text).fields().map(({ name }) => name);
  assert.deepEqual([names("int32 x\n"), names("float64 y\n")], [["x"], ["y"]]);
  assert.equal(connection.schemaOf("a/msg/B", "int32 x\n"), connection.schemaOf("a/msg/B", "int32 x\n"));
});

test("what ran before the connection was lost is not shown any more", () => {
  const connection = new Connection("ws://nowhere");
  connection.open = () => {}; // it would try again
  let told = 0;
  connection.on("graph", () => { told += 1; });
  const publishedTopics = [{ name: "/old/cmd_vel", type: "geometry_msgs/msg/Twist", publisherIds: ["/old"] }];
  connection._text({ op: "connectionGraphUpdate", publishedTopics, nodes: ["/old"] });
  connection._closed();
  assert.deepEqual([connection.graph.nodes, connection.graph.types.size, connection.graph.published.size, told], [[], 0, 0, 2]);
});

const NOTHING = { robots: 0, command: undefined, twist: "", images: undefined, turtle: false, spatial: false };
const ROBOT = { ...NOTHING, robots: 1, command: "/r/cmd_vel", spatial: true };
const ids = (model) => model.columns.map(({ cells }) => cells.map(({ tabs }) => tabs.map(({ id }) => id).join("|")).join(" / "));

test("the kind of a system follows from what it has", () => {
  for (const [more, kind] of [
    [{ isLearn: true, isEmpty: true }, "learn"], [{ isBag: true, images: "/image" }, "bag"], [{ isEmpty: true }, "empty"], [{}, "topics"], [{ robots: 1 }, "drive"],
    [{ command: "/cmd_vel" }, "drive"], [{ command: "/cmd_vel", images: "/image" }, "camera"], [{ robots: 2, images: "/image" }, "robots"], [{ robots: 2, turtle: true, command: "/t/cmd_vel" }, "drive"],
  ]) assert.equal(kindOf({ ...NOTHING, ...more }), kind, JSON.stringify(more));
});

test("each kind has a layout of panels that there are, on a phone too", () => {
  for (const kind of KINDS) {
    for (const isPhone of [false, true]) {
      for (const found of [NOTHING, ROBOT, { ...ROBOT, images: "/image", turtle: true }]) assert.ok(tabsOf(layoutOf(kind, found, isPhone)).every(({ id }) => PANELS.includes(id)), kind);
      assert.equal(layoutOf(kind, ROBOT, isPhone).columns.length === 0, kind === "empty");
    }
  }
  assert.deepEqual(ids(layoutOf("drive", ROBOT, false)), ["world", "topics|log|teleop / plot"]);
  assert.deepEqual(ids(layoutOf("camera", { ...ROBOT, images: "/image" }, true)), ["world|images / teleop", "plot", "topics", "log"]);
  const [messages, plot] = ["topics", "plot"].map((id) => tabsOf(layoutOf("drive", { ...ROBOT, twist: "twist." }, false)).find((tab) => tab.id === id).options);
  assert.deepEqual([messages.topic, plot.series], ["/r/cmd_vel", [{ topic: "/r/cmd_vel", path: "twist.linear.x" }, { topic: "/r/cmd_vel", path: "twist.angular.z" }]]);
});

test("a layout of nonsense is not recalled", () => {
  const own = layoutOf("drive", ROBOT, false);
  for (const kept of [null, undefined, 7, [], { columns: 7 }, { columns: [{ cells: 3 }] }, { changed: true, columns: [{ cells: [{ id: "log" }] }] }]) {
    assert.equal(restored(kept), null);
    assert.equal(recalled(kept, own), own);
  }
  assert.deepEqual(restored({ columns: [{ width: "x", cells: [{ tabs: [{ id: "nothing" }] }] }] }), { columns: [] });
});

test("a layout that a person changed is recalled; of one that nobody changed only what its panels show", () => {
  const own = () => layoutOf("drive", ROBOT, false), text = (model) => JSON.parse(JSON.stringify(model)), plot = (model) => tabsOf(model).find(({ id }) => id === "plot").options;
  const kept = text(own());
  plot(kept).seconds = 5;
  assert.deepEqual(ids(recalled({ ...kept, changed: false }, own())), ids(own()));
  assert.equal(plot(recalled({ ...kept, changed: false }, own())).seconds, 5);
  const other = () => layoutOf("drive", { ...ROBOT, command: "/s/cmd_vel" }, false); // another robot's fields are its own
  assert.equal(plot(recalled({ ...kept, changed: false }, other())).series[0].topic, "/s/cmd_vel");
  kept.columns.reverse();
  assert.deepEqual(ids(recalled({ ...kept, changed: true }, own())), ids(own()).reverse());
  assert.equal(plot(recalled({ ...kept, changed: true }, own())).seconds, 5);
  assert.equal(plot(recalled({ ...kept, changed: true }, other())).series[0].topic, "/s/cmd_vel");
});

test("an address asks for panels, side by side", () => {
  for (const [hash, expected] of [["#turtlesim+services", ["turtlesim", "services"]], ["#graph", ["graph"]]]) assert.deepEqual(ids(asked(hash)), expected, hash);
  for (const hash of ["", "#", "#../../x+nothing"]) assert.equal(asked(hash), null);
  assert.deepEqual(tabsOf(asked("#images:/a/b+log")).map(({ options }) => options.topic), ["/a/b", undefined]);
});

test("values at paths, and in one line", () => {
  const found = { a: { b: [{ c: 1 }, { c: 2 }] }, d: new Float64Array([0.1, 2]) };
  assert.deepEqual([at(found, "a.b[1].c"), at(found, "d[0]"), at(found, "a.x.y"), at(found, "a.b[7].c")], [2, 0.1, undefined, undefined]);
  assert.deepEqual([leaf(0.1 + 0.2), leaf("x"), leaf(12n), leaf(found.d), leaf(true)], ["0.3", '"x"', "12", "[2] 0.1, 2", "true"]);
});

test("both languages have all words, with the same gaps", () => {
  const gaps = (text) => (text.match(/\{\w+\}/g) ?? []).sort();
  assert.deepEqual(Object.keys(WORDS.en).sort(), Object.keys(WORDS.pt).sort());
  for (const [key, text] of Object.entries(WORDS.en)) assert.deepEqual(gaps(WORDS.pt[key]), gaps(text), key);
  choose("pt");
  assert.equal(words("ago", { seconds: 3 }), "há 3 s");
  for (const id of PANELS) assert.notEqual(words(`panel.${id}`), `panel.${id}`);
});
