// Robots of the world panel: which there are, and their bodies with the way they look, seen on any floor.

import { compose, poseOf, yawOf } from "../tf.js";
import { halves, trace } from "./world_markers.js";

const ROBOT = /(^|\/)(base_link|base_footprint)$/;
const BODY = 0.15; // metres: radius of a robot whose shape nobody publishes
const CASE = "rgba(0,0,0,0.6)", NOSE = "#fff";
const LARGE = 60; // pixels of a radius above which a robot is drawn anew, and not as a picture that is turned

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
    const radius = Math.max(reachOf(robot) * view.scale, 5 * unit);
    context.save();
    context.translate(view.toX(robot.pose.x), view.toY(robot.pose.y));
    context.rotate(-yawOf(robot.pose));
    if (radius > LARGE * unit || robots.length === 1) paint(context, scene, robot, radius);
    else {
      const picture = stamp(scene, robot, radius);
      context.drawImage(picture, -picture.width / 2, -picture.height / 2);
    }
    context.restore();
  }
}

/** Picture of a robot that looks to the right: one for all that look the same. */
function stamp(scene, robot, radius) {
  const { body, colour } = robot, key = `${radius.toFixed(1)} ${colour} ${body?.fill} ${body?.marker.type} ${Object.values(body?.marker.scale ?? {})} ${body?.marker.points.length}`;
  if (scene.stamps.size > 200) scene.stamps.clear();
  if (!scene.stamps.has(key)) {
    const canvas = document.createElement("canvas"), size = 2 * Math.ceil(1.5 * radius + 5 * scene.view.ratio);
    canvas.width = canvas.height = size;
    const context = canvas.getContext("2d");
    context.translate(size / 2, size / 2);
    paint(context, scene, robot, radius);
    scene.stamps.set(key, canvas);
  }
  return scene.stamps.get(key);
}

/** Draw a robot at the origin, looking to the right: a ring in its colour, its body, and an arrow. */
function paint(context, { view, colours }, robot, radius) {
  const unit = view.ratio, { body, colour } = robot, scale = radius / reachOf(robot);
  context.beginPath();
  if (body) trace(context, body.marker, ({ x, y }) => [x * scale, -y * scale]);
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
