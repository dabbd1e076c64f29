// Layers of the world panel: one class for each kind of message, by what it draws.
//
// A layer has `update(message, scene)`, called with each new message, and any of: floor, map and ground(context, scene),
// drawn only when they change, groundKey(scene) that tells of it, pixels(scene), draw(context, scene),
// bounds() -> [left, bottom, right, top], hover(x, y, reach, scene). Its colours are `colour` and `pixel`.

import { compose, inverse, poseOf, rotate, yawOf } from "../tf.js";
import { Markers } from "./world_markers.js";
import { faint, pixel, shown } from "./world_pixels.js";
import { around } from "./world_view.js";

const MOST_POINTS = 120_000;
const TRAIL_POINTS = 400;
const ELLIPSE = 2; // standard deviations
const ALL_ROUND = 6.2; // radians of a scan that has no gap
const SHOWN_BEAMS = 60; // of a scan, as lines
const SIGHT = 1.2; // metres that a camera's view is drawn
const REACHED = 0.35; // metres from a goal at which it is reached
const MOST_PARTICLES = 5000;
const LOCAL = /(^|[/_])(local|transformed|optimal)/; // paths of the next seconds, which lie above the one to the goal
const FAINTEST = 0.25, STEPS = 4; // opacity of a particle without weight; steps of weight that are told apart

/** Axes of a pose seen from above: [x, y, xx, xy, yx, yy]. */
function seen(pose) {
  const x = rotate(pose, 1, 0, 0), y = rotate(pose, 0, 1, 0);
  return [pose.x, pose.y, x[0], x[1], y[0], y[1]];
}

class Layer {
  constructor(topic) { this.topic = topic; }

  set colour(colour) {
    this._colour = colour;
    this.pixel = pixel(colour);
  }

  get colour() { return this._colour; }

  update(message) { this.message = message; }

  /** Pose of the message's frame: as it was when the message came, or as soon as it is known. */
  frame(scene) { return scene.pose(this.message.header.frame_id); }

  bounds() { return null; }

  hover() { return null; }
}

class Scan extends Layer {
  update(message, scene) {
    super.update(message);
    this._place(scene);
  }

  /** Where the beams end, in the fixed frame; NaN for those that end nowhere. A scan stays where it was measured while its robot drives on. */
  _place(scene) {
    const { ranges, header, angle_min: start, angle_increment: step, range_min: least, range_max: most } = this.message;
    this.pose = scene.known(header.frame_id);
    const [px, py, xx, xy, yx, yy] = seen(this.pose ?? scene.pose(header.frame_id)), ends = this.ends = new Float32Array(2 * ranges.length);
    this.from = { x: px, y: py };
    ranges.forEach((range, i) => {
      const far = range >= least && range <= most ? range : NaN, cos = far * Math.cos(start + i * step), sin = far * Math.sin(start + i * step);
      ends[2 * i] = px + cos * xx + sin * yx;
      ends[2 * i + 1] = py + cos * xy + sin * yy;
    });
  }

  pixels(scene) {
    if (!this.pose) this._place(scene);
    if (scene.many) scene.pixels.fan(this.from, this.ends, this.pixel);
  }

  /** Draw what the beams sweep, some of them, and where they end. */
  draw(context, { view, many, colours }) {
    if (many) return;
    const from = [view.toX(this.from.x), view.toY(this.from.y)], places = [], every = Math.ceil(this.ends.length / 2 / SHOWN_BEAMS);
    for (let i = 0; i < this.ends.length; i += 2) places.push(this.ends[i] === this.ends[i] ? [view.toX(this.ends[i]), view.toY(this.ends[i + 1])] : null);
    context.fillStyle = faint(this.colour, 0.06);
    context.beginPath();
    if (Math.abs(this.message.ranges.length * this.message.angle_increment) < ALL_ROUND) context.moveTo(...from);
    for (const place of places) context.lineTo(...(place ?? from));
    context.fill();
    context.strokeStyle = faint(this.colour, 0.18);
    context.lineWidth = view.ratio;
    context.beginPath();
    for (const place of places.filter((each, i) => each && i % every === 0)) {
      context.moveTo(...from);
      context.lineTo(...place);
    }
    context.stroke();
    dots(context, places.filter(Boolean), colours.halo, this.colour, view.ratio);
  }

  bounds() { // enough ends to fit the view
    const every = Math.ceil(this.ends.length / 90);
    return around([this.from, ...Array.from({ length: 45 }, (_, i) => ({ x: this.ends[2 * i * every], y: this.ends[2 * i * every + 1] }))]);
  }

  hover(x, y, reach) {
    const i = this.message.ranges.findIndex((_, k) => Math.hypot(this.ends[2 * k] - x, this.ends[2 * k + 1] - y) < reach);
    return i < 0 ? null : `${this.message.ranges[i].toFixed(3)} m (${i})`;
  }
}

class Cloud extends Layer {
  update(message, scene) {
    super.update(message);
    const read = message.points ? plainPoints(message) : cloudPoints(message);
    const pose = this.frame(scene);
    const { count, at, tint } = read;
    this.count = count;
    this.places = new Float32Array(2 * count);
    this.tints = new Uint32Array(count);
    for (let i = 0; i < count; i++) {
      const [x, y, z] = at(i), p = rotate(pose, x, y, z);
      this.places[2 * i] = pose.x + p[0];
      this.places[2 * i + 1] = pose.y + p[1];
      this.tints[i] = tint?.(i) ?? byHeight(pose.z + p[2]);
    }
  }

  get colours() { return [0, 1, 2].map((z) => shown(byHeight(z))); }

  pixels(scene) { scene.pixels.points(this.places, this.count, this.tints); }

  hover(x, y, reach) {
    for (let i = 0; i < this.count; i++) {
      if (Math.hypot(this.places[2 * i] - x, this.places[2 * i + 1] - y) < reach) return `${this.count} points`;
    }
    return null;
  }
}

function plainPoints({ points }) {
  return { count: Math.min(points.length, MOST_POINTS), at: (i) => [points[i].x, points[i].y, points[i].z] };
}

function cloudPoints({ fields, data, point_step: step, row_step: row, width, height, is_bigendian: big }) {
  const offsets = Object.fromEntries(fields.map((each) => [each.name, each]));
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const get = (field) => (field?.datatype === 8 ? (at) => view.getFloat64(at + field.offset, !big) : (at) => view.getFloat32(at + field.offset, !big));
  if (!offsets.x || !offsets.y) return { count: 0 };
  const x = get(offsets.x), y = get(offsets.y), z = offsets.z ? get(offsets.z) : () => 0;
  const all = Math.min(width * height, Math.floor(data.length / Math.max(1, step)));
  const stride = Math.max(1, Math.ceil(all / MOST_POINTS));
  const place = (i) => Math.floor((i * stride) / width) * row + ((i * stride) % width) * step;
  const rgb = offsets.rgb ?? offsets.rgba;
  const tint = rgb && ((i) => {
    const at = place(i) + rgb.offset;
    return (0xff000000 | (view.getUint8(at) << 16) | (view.getUint8(at + 1) << 8) | view.getUint8(at + 2)) >>> 0;
  });
  const at = (i) => { const from = place(i); return [x(from), y(from), z(from)]; };
  return { count: Math.floor(all / stride), at, tint };
}

function byHeight(z) { // from blue at the floor to red at two metres
  const t = Math.max(0, Math.min(1, z / 2)), r = 255 * Math.min(1, 2 * t), b = 255 * Math.min(1, 2 - 2 * t), g = 255 - Math.abs(r - b) * 0.5;
  return (0xff000000 | (b << 16) | (g << 8) | r) >>> 0;
}

class Grid extends Layer {
  /** Place in the pile of grids: costmaps lie on maps, and that around the robot on top. */
  get above() { return /costmap/.test(this.topic.name) ? 1 + /local/.test(this.topic.name) : 0; }

  update(message, scene) {
    super.update(message);
    const { width, height } = message.info;
    this.canvas = document.createElement("canvas");
    this.canvas.width = Math.max(1, width);
    this.canvas.height = Math.max(1, height);
    const context = this.canvas.getContext("2d"), image = context.createImageData(this.canvas.width, this.canvas.height);
    const colours = this.above ? scene.costs : scene.occupancy, pixels = new Uint32Array(image.data.buffer), { data } = message;
    for (let i = 0; i < data.length; i++) pixels[i] = colours[data[i] & 0xff];
    context.putImageData(image, 0, 0);
    this.colours = (colours === scene.costs ? [20, 60, 99, 100] : [0, 50, 100]).map((value) => shown(colours[value]));
    scene.groundChanged = true;
  }

  _corner(scene) { return compose(this.frame(scene), poseOf(this.message.info.origin)); }

  groundKey(scene) { return Object.values(this.frame(scene)).join(); }

  map(context, scene) {
    const { view } = scene, { resolution } = this.message.info, [x, y, xx, xy, yx, yy] = seen(this._corner(scene)), s = view.scale * resolution;
    context.save();
    context.imageSmoothingEnabled = s < 1;
    context.setTransform(xx * s, -xy * s, yx * s, -yy * s, view.toX(x), view.toY(y));
    context.drawImage(this.canvas, 0, 0);
    context.restore();
  }

  bounds(scene) {
    const { width, height, resolution } = this.message.info, corner = this._corner(scene);
    return around([[0, 0], [1, 0], [0, 1], [1, 1]].map(([a, b]) => {
      const p = rotate(corner, a * width * resolution, b * height * resolution, 0);
      return { x: corner.x + p[0], y: corner.y + p[1] };
    }));
  }

  hover(x, y, _, scene) {
    const { width, height, resolution } = this.message.info;
    const back = inverse(this._corner(scene)), p = rotate(back, x, y, 0);
    const column = Math.floor((back.x + p[0]) / resolution), row = Math.floor((back.y + p[1]) / resolution);
    return column >= 0 && row >= 0 && column < width && row < height ? `${this.message.data[row * width + column]} (${column}, ${row})` : null;
  }
}

class Odometry extends Layer {
  update(message, scene) {
    super.update(message);
    const pose = compose(this.frame(scene), poseOf(message.pose.pose)), trail = (this.trail ??= []);
    if (this.root !== scene.frames.fixed) trail.length = 0; // measured in another frame
    this.root = scene.frames.fixed;
    const last = trail[trail.length - 1];
    if (!last || Math.hypot(pose.x - last.x, pose.y - last.y) > scene.trailStep) {
      if (last && scene.trails && scene.many) scene.pixels.groundLine(last.x, last.y, pose.x, pose.y, this.pixel);
      trail.push({ x: pose.x, y: pose.y });
      if (trail.length > TRAIL_POINTS) this.trail = trail.filter((_, i) => i % 2 === 0);
    }
    this.pose = pose;
    scene.odometry.set(message.child_frame_id || this.topic.name, this);
  }

  forget() { this.trail = []; }

  /** Draw the trail: of many robots in pixels, into the ground. */
  draw(context, { view, trails, many, colours }) {
    if (many || !trails) return;
    context.beginPath();
    for (const { x, y } of [...this.trail, this.pose]) context.lineTo(view.toX(x), view.toY(y));
    cased(context, colours, this.colour, 2 * view.ratio);
  }

  groundPixels(scene) {
    if (!scene.trails || !scene.many) return;
    const { trail } = this;
    for (let i = 1; i < trail.length; i++) scene.pixels.groundLine(trail[i - 1].x, trail[i - 1].y, trail[i].x, trail[i].y, this.pixel);
  }

  bounds() { return around([this.pose]); }

  hover(x, y, reach) {
    const { linear, angular } = this.message.twist.twist;
    return Math.hypot(this.pose.x - x, this.pose.y - y) < reach * 2 ? `${linear.x.toFixed(2)} m/s, ${angular.z.toFixed(2)} rad/s` : null;
  }
}

/** Layer of points that are joined, filled or marked, in the frame of the header. */
class Outline extends Layer {
  get above() { return LOCAL.test(this.topic.name) ? 1 : 0; }

  update(message) {
    super.update(message);
    const { poses, polygon, point } = message;
    this.places = poses ? poses.map((each) => each.pose.position) : polygon ? polygon.points : [point];
  }

  _points(scene) {
    const pose = this.frame(scene);
    return this.places.map(({ x, y, z }) => {
      const p = rotate(pose, x, y, z);
      return { x: pose.x + p[0], y: pose.y + p[1] };
    });
  }

  draw(context, scene) {
    const points = this._points(scene), { view } = scene;
    context.beginPath();
    if (points.length === 1) context.arc(view.toX(points[0].x), view.toY(points[0].y), 4 * view.ratio, 0, 2 * Math.PI);
    else for (const { x, y } of points) context.lineTo(view.toX(x), view.toY(y));
    if (this.message.polygon) {
      context.closePath();
      context.fillStyle = faint(this.colour, 0.25);
      context.fill();
    }
    cased(context, scene.colours, this.colour, 3 * view.ratio);
  }

  bounds(scene) { return around(this._points(scene)); }

  hover(x, y, reach, scene) {
    return this._points(scene).some((each) => Math.hypot(each.x - x, each.y - y) < reach) ? `${this.places.length} points` : null;
  }
}

/** Layer of poses: arrows, and the ellipse of a covariance. */
class Poses extends Layer {
  _poses(scene) {
    const { message } = this, frame = this.frame(scene);
    const list = message.poses ?? [message.pose.pose ?? message.pose];
    return list.map((each) => compose(frame, poseOf(each)));
  }

  draw(context, scene) {
    const { view, colours } = scene, length = Math.max(0.3 * view.scale, 12 * view.ratio), poses = this._poses(scene);
    if (isGoal(this.topic.name)) return this.isReached(scene) || goal(context, scene, poses[0], this.colour);
    context.beginPath();
    for (const pose of poses) arrow(context, view.toX(pose.x), view.toY(pose.y), yawOf(pose), this.message.poses ? length / 2 : length);
    cased(context, colours, this.colour, (this.message.poses ? 1 : 3) * view.ratio);
    const { covariance } = this.message.pose ?? {};
    if (covariance) this._ellipse(context, scene, covariance);
    return undefined;
  }

  update(message) {
    super.update(message);
    this.reached = false;
  }

  /** True once a robot has come to the goal. */
  isReached(scene) {
    const [pose] = this._poses(scene), isHere = ({ name, pose: at }) => Math.hypot(pose.x - at.x, pose.y - at.y) < REACHED
      && (scene.drawn.length === 1 || this.topic.name.startsWith(`/${name}/`));
    this.reached ||= scene.drawn.some(isHere);
    return this.reached;
  }

  _ellipse(context, scene, covariance) {
    const [a, b, d] = [covariance[0], covariance[1], covariance[7]];
    const middle = (a + d) / 2, rest = Math.hypot((a - d) / 2, b);
    if (!(middle - rest > 0)) return;
    const { view } = scene, [pose] = this._poses(scene), turn = yawOf(this.frame(scene));
    context.beginPath();
    context.ellipse(view.toX(pose.x), view.toY(pose.y), ELLIPSE * Math.sqrt(middle + rest) * view.scale, ELLIPSE * Math.sqrt(middle - rest) * view.scale,
      -(turn + Math.atan2(2 * b, a - d) / 2), 0, 2 * Math.PI);
    cased(context, scene.colours, this.colour, 1.5 * view.ratio);
  }

  bounds(scene) { return around(this._poses(scene)); }

  hover(x, y, reach, scene) {
    const found = this._poses(scene).find((each) => Math.hypot(each.x - x, each.y - y) < reach);
    return found ? `(${found.x.toFixed(2)}, ${found.y.toFixed(2)}, ${degrees(yawOf(found))})` : null;
  }
}

/** Layer of a localization filter's particles: short strokes as they look, fainter with less weight. */
class Particles extends Layer {
  update(message, scene) {
    super.update(message);
    const { particles } = message, stride = Math.max(1, Math.ceil(particles.length / MOST_PARTICLES)), frame = this.frame(scene);
    const most = particles.reduce((greatest, { weight }) => Math.max(greatest, weight), 0);
    this.steps = Array.from({ length: STEPS }, () => []);
    this.poses = [];
    for (let i = 0; i < particles.length; i += stride) {
      const pose = compose(frame, poseOf(particles[i].pose)), share = most > 0 ? particles[i].weight / most : 1;
      const place = { x: pose.x, y: pose.y, yaw: yawOf(pose) };
      this.steps[Math.max(0, Math.ceil(share * STEPS) - 1) || 0].push(place);
      this.poses.push(place);
    }
  }

  draw(context, { view }) {
    const length = Math.min(12 * view.ratio, Math.max(5 * view.ratio, 0.12 * view.scale)), dot = 2 * view.ratio;
    this.steps.forEach((places, step) => {
      const alpha = FAINTEST + ((1 - FAINTEST) * step) / (STEPS - 1);
      context.fillStyle = faint(this.colour, alpha);
      context.strokeStyle = faint(this.colour, 0.6 * alpha);
      context.lineWidth = view.ratio;
      context.beginPath();
      for (const { x, y, yaw } of places) {
        const px = view.toX(x), py = view.toY(y);
        context.moveTo(px, py);
        context.lineTo(px + length * Math.cos(yaw), py - length * Math.sin(yaw));
        context.fillRect(px - dot / 2, py - dot / 2, dot, dot);
      }
      context.stroke();
    });
  }

  bounds() { return around(this.poses); }

  hover(x, y, reach) {
    return this.poses.some((each) => Math.hypot(each.x - x, each.y - y) < reach) ? `${this.message.particles.length}` : null;
  }
}

class Cone extends Layer {
  draw(context, scene) {
    const { view } = scene, { range, field_of_view: angle } = this.message, pose = this.frame(scene), yaw = yawOf(pose);
    if (!Number.isFinite(range)) return;
    context.fillStyle = faint(this.colour, 0.3);
    context.beginPath();
    context.moveTo(view.toX(pose.x), view.toY(pose.y));
    context.arc(view.toX(pose.x), view.toY(pose.y), range * view.scale, -yaw - angle / 2, -yaw + angle / 2);
    context.fill();
  }

  hover(x, y, reach, scene) {
    const pose = this.frame(scene);
    return Math.hypot(pose.x - x, pose.y - y) < reach ? `${this.message.range.toFixed(3)} m` : null;
  }
}

/** View of a camera, in its frame: an optical one looks along z, with x to the right; else along x, with y to the left. */
class Sight extends Layer {
  draw(context, scene) {
    const { view } = scene, { k, width, header } = this.message, pose = scene.known(header.frame_id);
    if (!pose || !(k[0] > 0) || scene.many) return;
    const isOptical = header.frame_id.endsWith("optical_frame"), x = view.toX(pose.x), y = view.toY(pose.y);
    const [left, right] = [-k[2], width - k[2]].map((column) => {
      const side = (column / k[0]) * SIGHT, p = isOptical ? rotate(pose, side, 0, SIGHT) : rotate(pose, SIGHT, -side, 0);
      return [view.toX(pose.x + p[0]), view.toY(pose.y + p[1])];
    });
    context.beginPath();
    for (const corner of [left, [x, y], right]) context.lineTo(...corner);
    context.fillStyle = faint(this.colour, 0.22);
    context.fill();
    context.strokeStyle = faint(this.colour, 0.8);
    context.lineWidth = view.ratio;
    context.stroke();
  }
}

/** True for topics of goals, as navigation listens to them. */
export function isGoal(name) { return name.endsWith("goal_pose"); }

/** Stroke a path in a colour, on an edge that is seen on any floor. */
export function cased(context, { halo }, colour, width) {
  context.lineCap = context.lineJoin = "round";
  for (const [style, wide] of [[halo, 2 * width], [colour, width]]) {
    context.strokeStyle = style;
    context.lineWidth = wide;
    context.stroke();
  }
}

/** Draw a goal: a ring at its place, and an arrow as it looks. */
export function goal(context, { view, colours }, { x, y, ...pose }, colour) {
  const px = view.toX(x), py = view.toY(y), yaw = pose.yaw ?? yawOf(pose), unit = view.ratio, radius = 9 * unit;
  context.beginPath();
  context.arc(px, py, radius, 0, 2 * Math.PI);
  arrow(context, px + radius * Math.cos(yaw), py - radius * Math.sin(yaw), yaw, 22 * unit);
  cased(context, colours, colour, 3 * unit);
  context.beginPath();
  context.arc(px, py, 3.5 * unit, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
}

/** Draw dots at places in pixels, each of three by three pixels with an edge. */
export function dots(context, places, halo, colour, unit) {
  for (const [style, size] of [[faint(halo, 0.5), 5], [colour, 3]]) {
    const far = Math.floor((size * unit) / 2), side = Math.round(size * unit);
    context.fillStyle = style;
    for (const place of places) context.fillRect(Math.round(place[0]) - far, Math.round(place[1]) - far, side, side);
  }
}

/** Add an arrow to a path: where it begins in pixels, heading in radians, length in pixels. */
export function arrow(context, x, y, yaw, length) {
  const ex = x + length * Math.cos(yaw), ey = y - length * Math.sin(yaw), head = length * 0.3;
  context.moveTo(x, y);
  context.lineTo(ex, ey);
  for (const side of [2.6, -2.6]) {
    context.moveTo(ex, ey);
    context.lineTo(ex + head * Math.cos(yaw + side), ey - head * Math.sin(yaw + side));
  }
}

/** Angle as a text. */
export function degrees(angle) { return `${((angle * 180) / Math.PI).toFixed(0)}°`; }

/**
 * Class of layer by type; `rate` is how often at most messages are needed (Hz), `form` how it looks in the list if it has no
 * `colours`, and `role` its colour in the palette where a system has one robot.
 */
export const KINDS = {
  "nav_msgs/msg/OccupancyGrid": { make: Grid, rate: 2, order: 0 },
  "sensor_msgs/msg/LaserScan": { make: Scan, rate: 0, order: 1, form: "beams", role: "scan" },
  "sensor_msgs/msg/PointCloud2": { make: Cloud, rate: 10, order: 1 },
  "sensor_msgs/msg/PointCloud": { make: Cloud, rate: 10, order: 1 },
  "sensor_msgs/msg/CameraInfo": { make: Sight, rate: 2, order: 1, form: "area", role: "camera" },
  "sensor_msgs/msg/Range": { make: Cone, rate: 20, order: 2, form: "area" },
  "visualization_msgs/msg/Marker": { make: Markers, rate: 0, order: 3, every: true },
  "visualization_msgs/msg/MarkerArray": { make: Markers, rate: 0, order: 3, every: true },
  "nav_msgs/msg/Odometry": { make: Odometry, rate: 0, order: 4, form: "line", role: "trail" },
  "nav_msgs/msg/Path": { make: Outline, rate: 10, order: 6, form: "line", role: "path" },
  "geometry_msgs/msg/PolygonStamped": { make: Outline, rate: 20, order: 6, form: "area" },
  "geometry_msgs/msg/PointStamped": { make: Outline, rate: 20, order: 6, form: "ring" },
  "geometry_msgs/msg/PoseStamped": { make: Poses, rate: 20, order: 7, form: "arrow", role: "goal" },
  "geometry_msgs/msg/PoseWithCovarianceStamped": { make: Poses, rate: 20, order: 7, form: "arrow", role: "particles" },
  "nav2_msgs/msg/ParticleCloud": { make: Particles, rate: 5, order: 3, form: "swarm", role: "particles" },
  "geometry_msgs/msg/PoseArray": { make: Poses, rate: 10, order: 7, form: "arrow" },
};
