// Markers of visualization_msgs seen from above: Marker and MarkerArray, with their lifetimes and deletions; and robots, whose
// bodies are such markers.
//
// What rests in the fixed frame is part of the ground, which is drawn only when it changes. By their `ns`, as the world
// node names them: "floor" and "paint" lie below maps, "signs" are shown as pictures, "robots" are drawn with their heading.

import { compose, poseOf, rotate, yawOf } from "../tf.js";
import { around } from "./world_view.js";

const [ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST, CUBE_LIST, SPHERE_LIST, POINTS, TEXT, MESH, TRIANGLES] = Array(12).keys();
const DELETE = 2, DELETE_ALL = 3;
const REST = 1000; // ms without a message after which a topic's markers rest
const SHADOW = "rgba(0,0,0,0.28)", EDGE = "rgba(0,0,0,0.4)";
const MOST_PIXELS = 2048, LEAST_SIGN = 26; // pixels of a picture's side, and of a sign on the screen
const FLOOR = /^(floor|paint)$/, UPRIGHT = "wall_faces"; // seen from above, upright faces are nothing
const ROBOT = /(^|\/)(base_link|base_footprint)$/;
const BODY = 0.15; // metres: radius of a robot whose shape nobody publishes
const CASE = "rgba(0,0,0,0.6)", NOSE = "#fff";
const LARGE = 60, TURNS = 48, MOST_STAMPS = 1000; // of many robots smaller ones (pixels of a radius) are copied from pictures in so many turns

export class Markers {
  constructor(topic) {
    this.topic = topic;
    this.shown = new Map();
    this.since = 0;
  }

  /** Take each message: what it adds, changes or deletes. */
  update(message, scene) {
    const wasGround = this.isGround;
    this.since = performance.now();
    for (const marker of message.markers ?? [message]) {
      const key = `${marker.ns}\n${marker.id}`;
      if (marker.action === DELETE_ALL) this.shown.clear();
      else if (marker.action === DELETE) this.shown.delete(key);
      else if (marker.ns !== UPRIGHT) {
        const { sec, nanosec } = marker.lifetime, life = sec * 1000 + nanosec / 1e6;
        this.shown.set(key, { marker, until: life ? scene.now + life : Infinity, place: poseOf(marker.pose), fill: css(marker.color) });
      }
    }
    this.groundKey(scene);
    if (wasGround || this.isGround) scene.groundChanged = true;
  }

  forget() { this.shown.clear(); }

  /** Colours that are drawn, the first ones. */
  get colours() {
    const found = new Set();
    for (const { marker, fill } of this.shown.values()) {
      if (found.size < 6) found.add(marker.colors.length ? css(marker.colors[0]) : fill);
    }
    return [...found];
  }

  /** What lies in the ground, as a text that changes with it. */
  groundKey(scene) {
    const isQuiet = performance.now() - this.since > REST;
    let count = 0;
    for (const item of this.shown.values()) {
      const { marker: { ns, header }, until } = item;
      item.rests = ns !== "robots" && until === Infinity && header.frame_id.replace(/^\//, "") === scene.frames.fixed && (isQuiet || FLOOR.test(ns));
      count += item.rests;
    }
    this.isGround = count > 0;
    return `${count} ${this.since}`;
  }

  floor(context, scene) { this._each(context, scene, (item) => item.rests && FLOOR.test(item.marker.ns)); }

  ground(context, scene) { this._each(context, scene, (item) => item.rests && !FLOOR.test(item.marker.ns)); }

  draw(context, scene) { this._each(context, scene, ({ rests, marker }) => !rests && marker.ns !== "robots"); }

  /** Markers of robots by the frames that they are in. */
  bodies(scene) {
    for (const item of this.shown.values()) if (item.marker.ns === "robots") scene.bodies.set(item.marker.header.frame_id.replace(/^\//, ""), item);
  }

  _each(context, scene, wanted) {
    context.save();
    for (const [key, item] of this.shown) {
      if (item.until < scene.now) this.shown.delete(key);
      else if (wanted(item)) shape(context, scene, item, compose(scene.pose(item.marker.header.frame_id), item.place));
    }
    context.restore();
  }

  bounds(scene) {
    const found = [];
    for (const { marker, place } of this.shown.values()) {
      const pose = compose(scene.pose(marker.header.frame_id), place), { x: sx, y: sy } = marker.scale;
      const corners = marker.points.length ? marker.points : [[1, 1], [1, -1], [-1, 1], [-1, -1]].map(([a, b]) => ({ x: (a * sx) / 2, y: (b * sy) / 2, z: 0 }));
      for (const corner of corners) {
        const p = rotate(pose, corner.x, corner.y, corner.z);
        found.push({ x: pose.x + p[0], y: pose.y + p[1] });
      }
    }
    return around(found);
  }

  hover(x, y, reach, scene) {
    for (const { marker, place } of this.shown.values()) {
      const pose = compose(scene.pose(marker.header.frame_id), place);
      const size = marker.points.length ? 0 : Math.min(marker.scale.x, marker.scale.y) / 2;
      if (Math.hypot(pose.x - x, pose.y - y) < Math.max(reach, size)) return `${marker.ns} ${marker.id} ${marker.text}`.trim();
    }
    return null;
  }
}

/** Add the outline of a solid marker to a path; `at` gives the pixels of a point {x, y, z} of the marker. */
function trace(context, { type, scale, points }, at) {
  const corners = type === CYLINDER || type === SPHERE ? round(scale) : type === TRIANGLES || type === LINE_STRIP ? points : box(scale);
  if (type === TRIANGLES) for (let i = 0; i + 2 < corners.length; i += 3) loop(context, corners.slice(i, i + 3).map(at));
  else loop(context, corners.map(at));
}

/** Half of a solid marker's length and width, in metres. */
function halves({ scale, points }) {
  return ["x", "y"].map((axis) => (points.length ? most(points.map((each) => each[axis])) - least(points.map((each) => each[axis])) : scale[axis]) / 2);
}

function shape(context, scene, item, pose) {
  const { marker, fill } = item, { type, scale, points, colors } = marker, { view } = scene;
  const at = (point) => {
    const p = rotate(pose, point.x, point.y, point.z);
    return [view.toX(pose.x + p[0]), view.toY(pose.y + p[1])];
  };
  const wide = (metres) => Math.max(1, metres * view.scale);
  const tint = (i) => (colors.length > i ? css(colors[i]) : fill);
  context.fillStyle = context.strokeStyle = fill;
  if (marker.ns === "signs") return sign(context, scene, item, at);
  switch (type) {
    case ARROW: {
      const [from, to] = points.length > 1 ? points : [{ x: 0, y: 0, z: 0 }, { x: scale.x, y: 0, z: 0 }];
      return pointed(context, at(from), at(to), wide(points.length > 1 ? scale.x : scale.y));
    }
    case CUBE: case SPHERE: case CYLINDER: case MESH: return solid(context, marker, at, view.ratio);
    case LINE_STRIP: case LINE_LIST:
      context.lineWidth = wide(scale.x);
      context.lineCap = context.lineJoin = "round";
      return lines(context, points.map(at), tint, type === LINE_LIST ? 2 : 1, colors.length > 0);
    case CUBE_LIST: case SPHERE_LIST: case POINTS: {
      const corners = type === SPHERE_LIST ? round(scale) : box(scale);
      points.forEach((point, i) => {
        context.fillStyle = tint(i);
        context.beginPath();
        loop(context, corners.map((each) => at({ x: point.x + each.x, y: point.y + each.y, z: point.z })));
        context.fill();
      });
      return undefined;
    }
    case TEXT: {
      const [x, y] = at({ x: 0, y: 0, z: 0 });
      context.font = `${Math.max(10 * view.ratio, scale.z * view.scale)}px system-ui`;
      context.textBaseline = "middle";
      context.textAlign = "center";
      return scene.write(context, marker.text, x, y, fill);
    }
    case TRIANGLES:
      if (colors.length) return flat(context, scene, item, pose);
      return FLOOR.test(marker.ns) ? filled(context, marker, at) : solid(context, marker, at, view.ratio);
  }
  return undefined;
}

function box({ x, y }) { return [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) => ({ x: (a * x) / 2, y: (b * y) / 2, z: 0 })); }

function round({ x, y }) {
  return Array.from({ length: 32 }, (_, i) => ({ x: (x / 2) * Math.cos((i * Math.PI) / 16), y: (y / 2) * Math.sin((i * Math.PI) / 16), z: 0 }));
}

/** Add a closed line to a path, always the same way round: parts of one path that overlap would else make holes. */
function loop(context, corners) {
  const turn = corners.reduce((sum, [x, y], i) => { const [nx, ny] = corners[(i + 1) % corners.length]; return sum + x * ny - nx * y; }, 0);
  (turn < 0 ? corners.reverse() : corners).forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.closePath();
}

function filled(context, marker, at, edge) {
  context.beginPath();
  trace(context, marker, at);
  if (edge) context.stroke();
  context.fill();
}

/** Fill a thing that stands on the floor, with its edge and its shadow. */
function solid(context, marker, at, unit) {
  const { fillStyle } = context;
  context.fillStyle = SHADOW;
  filled(context, marker, (point) => { const [x, y] = at(point); return [x + 2 * unit, y + 3 * unit]; });
  context.strokeStyle = EDGE;
  context.lineWidth = 1.5 * unit;
  context.fillStyle = fillStyle;
  filled(context, marker, at, true);
}

/** Draw triangles of several colours that lie flat, as a picture that is made once. */
function flat(context, { view }, item, pose) {
  const { canvas, left, top, step } = (item.picture ??= picture(item.marker, "x", "y"));
  const x = rotate(pose, step, 0, 0), y = rotate(pose, 0, step, 0), corner = rotate(pose, left, top, 0), s = view.scale;
  context.save();
  context.imageSmoothingEnabled = step * s < 1;
  context.setTransform(x[0] * s, -x[1] * s, -y[0] * s, y[1] * s, view.toX(pose.x + corner[0]), view.toY(pose.y + corner[1]));
  context.drawImage(canvas, 0, 0);
  context.restore();
}

/** Draw lines between places: each pair (`step` 2), or joined (1); in one path, or each in its own colour. */
function lines(context, places, tint, step, coloured) {
  for (let i = 0; i + 1 < places.length; i += step) {
    if (coloured || !i) {
      context.strokeStyle = tint(i);
      context.beginPath();
    }
    if (coloured || step > 1 || !i) context.moveTo(...places[i]);
    context.lineTo(...places[i + 1]);
    if (coloured || i + step + 1 >= places.length) context.stroke();
  }
}

function pointed(context, [x, y], [ex, ey], width) {
  const yaw = Math.atan2(ey - y, ex - x), head = Math.max(6, 2 * width);
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(ex - head * Math.cos(yaw), ey - head * Math.sin(yaw));
  context.stroke();
  context.beginPath();
  loop(context, [[ex, ey], ...[2.6, -2.6].map((side) => [ex + head * Math.cos(yaw + side), ey + head * Math.sin(yaw + side)])]);
  context.fill();
}

/** Colour of a std_msgs/ColorRGBA. */
function css({ r, g, b, a }) { return `rgba(${Math.round(255 * r)},${Math.round(255 * g)},${Math.round(255 * b)},${a})`; }

/**
 * Picture of a marker's triangles in the plane of two of its axes, `u` to the right and `v` up: {canvas, left, top, step}
 * with its upper left corner and the side of a pixel, in metres. Edges are where the pixels' are, where there are few enough.
 */
function picture({ points, colors, color }, u, v) {
  const us = points.map((each) => each[u]), vs = points.map((each) => each[v]), left = least(us), top = most(vs);
  const wide = most(us) - left, high = top - least(vs), longest = Math.max(wide, high) || 1;
  const step = Math.max(longest / MOST_PIXELS, Math.min(longest / 64, finest(us, longest), finest(vs, longest)));
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
  canvas.width = Math.max(1, Math.round(wide / step));
  canvas.height = Math.max(1, Math.round(high / step));
  for (let i = 0; i + 2 < points.length; i += 3) {
    context.fillStyle = context.strokeStyle = css(colors[i] ?? color);
    context.lineWidth = 0.5; // or two triangles of one rectangle would have a seam
    context.beginPath();
    for (let k = i; k < i + 3; k++) context.lineTo((us[k] - left) / step, (top - vs[k]) / step);
    context.closePath();
    context.fill();
    context.stroke();
  }
  return { canvas, left, top, step };
}

const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity), most = (values) => -least(values.map((each) => -each));

/** Smallest distance of two values that differ. */
function finest(values, longest) {
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  return sorted.reduce((found, each, i) => (i && each - sorted[i - 1] > longest / MOST_PIXELS ? Math.min(found, each - sorted[i - 1]) : found), longest);
}

/** Draw a sign's plate from above, and its picture before it, facing who looks. */
function sign(context, { view, colours }, item, at) {
  const { canvas, step } = (item.picture ??= picture(item.marker, "y", "z")), unit = view.ratio;
  const ys = item.marker.points.map(({ y }) => y), low = least(ys), high = most(ys);
  const [x, y] = at({ x: 0, y: 0, z: 0 }), [fx, fy] = at({ x: 1, y: 0, z: 0 }), far = Math.hypot(fx - x, fy - y) || 1;
  const height = Math.max(LEAST_SIGN * unit, canvas.height * step * view.scale), width = (height * canvas.width) / canvas.height;
  const ahead = Math.max(height, width) / 2 + 5 * unit, px = x + ((fx - x) / far) * ahead, py = y + ((fy - y) / far) * ahead;
  context.lineCap = "butt";
  for (const [colour, wide] of [[colours.halo, 6], [colours.text, 3]]) {
    context.strokeStyle = colour;
    context.lineWidth = wide * unit;
    context.beginPath();
    context.moveTo(...at({ x: 0, y: low, z: 0 }));
    context.lineTo(...at({ x: 0, y: high, z: 0 }));
    context.stroke();
  }
  context.fillStyle = colours.halo;
  context.fillRect(px - width / 2 - unit, py - height / 2 - unit, width + 2 * unit, height + 2 * unit);
  context.imageSmoothingQuality = "high";
  context.drawImage(canvas, px - width / 2, py - height / 2, width, height);
}

/** Robots: frames named base_link or base_footprint, and odometry whose frame tf does not know: [{name, frame, pose}]. */
export function robotsOf(scene) {
  const found = new Map(), { frames } = scene;
  for (const frame of frames.nodes.keys()) {
    if (!ROBOT.test(frame)) continue;
    const name = frame.replace(ROBOT, "") || "robot";
    if (!found.has(name) || frame.endsWith("base_link")) found.set(name, { name, frame, pose: scene.pose(frame) });
  }
  for (const [child, { message, topic }] of scene.odometry) {
    if (frames.nodes.has(child) || !topic.channel) continue;
    const name = child.replace(ROBOT, "") || topic.name.replace(/^\/|\/[^/]*$/g, "") || "robot";
    if (!found.has(name)) found.set(name, { name, frame: child, pose: compose(scene.pose(message.header.frame_id), poseOf(message.pose.pose)) });
  }
  return [...found.values()];
}

/** Radius of a robot's body, in metres. */
export function reachOf({ body }) { return body ? Math.max(...halves(body.marker)) : BODY; }

/** Draw robots, each with its body: a marker's shape, or a disc. */
export function drawRobots(context, scene, robots) {
  const { view } = scene, unit = view.ratio;
  for (const robot of robots) {
    const radius = Math.max(reachOf(robot) * view.scale, 5 * unit), x = view.toX(robot.pose.x), y = view.toY(robot.pose.y), yaw = yawOf(robot.pose);
    if (scene.many && radius < LARGE * unit) {
      const picture = stamp(scene, robot, radius, Math.round((yaw * TURNS) / 2 / Math.PI));
      context.drawImage(picture, Math.round(x - picture.width / 2), Math.round(y - picture.height / 2)); // whole pixels are copied fast
    } else turned(context, scene, robot, radius, x, y, yaw);
  }
}

/** Picture of a robot in one of many turns: one for all that look the same. */
function stamp(scene, robot, radius, turn) {
  const { body, colour } = robot, key = `${radius.toFixed(1)} ${turn} ${colour} ${body?.fill} ${body?.marker.type} ${Object.values(body?.marker.scale ?? {})} ${body?.marker.points.length}`;
  if (scene.stamps.size > MOST_STAMPS) scene.stamps.clear();
  if (!scene.stamps.has(key)) {
    const canvas = document.createElement("canvas"), size = 2 * Math.ceil(1.5 * radius + 5 * scene.view.ratio);
    canvas.width = canvas.height = size;
    turned(canvas.getContext("2d"), scene, robot, radius, size / 2, size / 2, (turn * 2 * Math.PI) / TURNS);
    scene.stamps.set(key, canvas);
  }
  return scene.stamps.get(key);
}

function turned(context, scene, robot, radius, x, y, yaw) {
  context.save();
  context.translate(x, y);
  context.rotate(-yaw);
  paint(context, scene, robot, radius);
  context.restore();
}

/** Draw a robot at the origin, looking to the right: a ring in its colour, its body, and an arrow. */
function paint(context, { view, colours }, robot, radius) {
  const unit = view.ratio, { body, colour } = robot, scale = radius / reachOf(robot);
  context.beginPath();
  if (body) trace(context, body.marker, ({ x, y, z }) => { const p = rotate(body.place, x, y, z); return [(body.place.x + p[0]) * scale, -(body.place.y + p[1]) * scale]; });
  else context.arc(0, 0, radius, 0, 2 * Math.PI);
  context.lineJoin = "round";
  for (const [style, width] of [[CASE, 5], [colour, 3]]) { // what lies within is covered by the body
    context.strokeStyle = style;
    context.lineWidth = width * unit;
    context.stroke();
  }
  context.fillStyle = body?.fill ?? colours.robot;
  context.fill();
  const nose = Math.max(0.72 * (body ? scale * Math.min(...halves(body.marker)) : radius), 4 * unit);
  context.beginPath();
  for (const [x, y] of [[1, 0], [-0.6, 0.75], [-0.25, 0], [-0.6, -0.75]]) context.lineTo(x * nose, y * nose);
  context.closePath();
  context.strokeStyle = CASE;
  context.lineWidth = 2 * unit;
  context.stroke();
  context.fillStyle = NOSE;
  context.fill();
}
