// Markers of visualization_msgs seen from above: Marker and MarkerArray, with their lifetimes and deletions.

import { compose, poseOf, rotate } from "../tf.js";
import { around } from "./world_view.js";

const [ARROW, CUBE, SPHERE, CYLINDER, LINE_STRIP, LINE_LIST, CUBE_LIST, SPHERE_LIST, POINTS, TEXT, MESH, TRIANGLES] = Array(12).keys();
const DELETE = 2, DELETE_ALL = 3;

function css({ r, g, b, a }) { return `rgba(${Math.round(255 * r)},${Math.round(255 * g)},${Math.round(255 * b)},${a})`; }

export class Markers {
  constructor(topic, colour) {
    this.topic = topic;
    this.colour = colour;
    this.shown = new Map();
  }

  /** Take each message: what it adds, changes or deletes. */
  update(message, scene) {
    for (const marker of message.markers ?? [message]) {
      const key = `${marker.ns}\n${marker.id}`;
      if (marker.action === DELETE_ALL) this.shown.clear();
      else if (marker.action === DELETE) this.shown.delete(key);
      else {
        const { sec, nanosec } = marker.lifetime;
        const life = sec * 1000 + nanosec / 1e6;
        this.shown.set(key, { marker, until: life ? scene.now + life : Infinity, place: poseOf(marker.pose) });
      }
    }
  }

  forget() { this.shown.clear(); }

  draw(context, scene) {
    context.save();
    for (const [key, { marker, until, place }] of this.shown) {
      if (until < scene.now) this.shown.delete(key);
      else shape(context, scene.view, marker, compose(scene.pose(marker.header.frame_id), place));
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

function shape(context, view, marker, pose) {
  const { type, scale, points, colors } = marker;
  const at = (point) => {
    const p = rotate(pose, point.x, point.y, point.z);
    return [view.toX(pose.x + p[0]), view.toY(pose.y + p[1])];
  };
  const wide = (metres) => Math.max(1, metres * view.scale);
  const tint = (i) => css(colors.length > i ? colors[i] : marker.color);
  context.fillStyle = context.strokeStyle = css(marker.color);
  switch (type) {
    case ARROW: {
      const [from, to] = points.length > 1 ? points : [{ x: 0, y: 0, z: 0 }, { x: scale.x, y: 0, z: 0 }];
      pointed(context, at(from), at(to), wide(points.length > 1 ? scale.x : scale.y));
      break;
    }
    case CUBE: return polygon(context, box(scale).map(at));
    case SPHERE: case CYLINDER: return polygon(context, round(scale).map(at));
    case LINE_STRIP: case LINE_LIST:
      context.lineWidth = wide(scale.x);
      context.lineCap = context.lineJoin = "round";
      return lines(context, points.map(at), tint, type === LINE_LIST ? 2 : colors.length ? 1 : 0);
    case CUBE_LIST: case SPHERE_LIST: case POINTS: {
      const corners = type === SPHERE_LIST ? round(scale) : box(scale);
      points.forEach((point, i) => {
        context.fillStyle = tint(i);
        polygon(context, corners.map((each) => at({ x: point.x + each.x, y: point.y + each.y, z: point.z })));
      });
      return undefined;
    }
    case TEXT: {
      const [x, y] = at({ x: 0, y: 0, z: 0 });
      context.font = `${Math.max(8, scale.z * view.scale)}px system-ui`;
      context.textBaseline = "middle";
      context.textAlign = "center";
      return context.fillText(marker.text, x, y);
    }
    case MESH: return polygon(context, box(scale).map(at));
    case TRIANGLES:
      for (let i = 0; i + 2 < points.length; i += 3) {
        context.fillStyle = tint(i);
        polygon(context, points.slice(i, i + 3).map(at));
      }
  }
  return undefined;
}

function box({ x, y }) { return [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) => ({ x: (a * x) / 2, y: (b * y) / 2, z: 0 })); }

function round({ x, y }) {
  return Array.from({ length: 24 }, (_, i) => ({ x: (x / 2) * Math.cos((i * Math.PI) / 12), y: (y / 2) * Math.sin((i * Math.PI) / 12), z: 0 }));
}

function polygon(context, corners) {
  context.beginPath();
  for (const [x, y] of corners) context.lineTo(x, y);
  context.closePath();
  context.fill();
}

/** Draw lines between places: all joined in one path, or each pair (`step` 2) or part (1) in its own colour. */
function lines(context, places, tint, step) {
  if (!step) {
    context.beginPath();
    for (const [x, y] of places) context.lineTo(x, y);
    context.stroke();
    return;
  }
  for (let i = 0; i + 1 < places.length; i += step) {
    context.strokeStyle = tint(i);
    context.beginPath();
    context.moveTo(...places[i]);
    context.lineTo(...places[i + 1]);
    context.stroke();
  }
}

function pointed(context, [x, y], [ex, ey], width) {
  const yaw = Math.atan2(ey - y, ex - x), head = Math.max(6, 2 * width);
  context.lineWidth = width;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(ex - head * Math.cos(yaw), ey - head * Math.sin(yaw));
  context.stroke();
  polygon(context, [[ex, ey], ...[2.6, -2.6].map((side) => [ex + head * Math.cos(yaw + side), ey + head * Math.sin(yaw + side)])]);
}
