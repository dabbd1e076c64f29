// Tree of coordinate frames from /tf and /tf_static, with a minute of snapshots for the timeline.

const SNAPSHOT = 100; // ms between snapshots
const MOST_SNAPSHOTS = 600;
const LONGEST_CHAIN = 64;
const FORGET = 15_000; // ms after which a frame has gone that others have outlived
const NUMBERS = 7;
export const IDENTITY = { x: 0, y: 0, z: 0, qx: 0, qy: 0, qz: 0, qw: 1 };

/** Pose `b`, which is told in the frame of pose `a`, in the frame in which `a` is told. */
export function compose(a, b) {
  const p = rotate(a, b.x, b.y, b.z);
  return {
    x: a.x + p[0], y: a.y + p[1], z: a.z + p[2],
    qx: a.qw * b.qx + a.qx * b.qw + a.qy * b.qz - a.qz * b.qy,
    qy: a.qw * b.qy - a.qx * b.qz + a.qy * b.qw + a.qz * b.qx,
    qz: a.qw * b.qz + a.qx * b.qy - a.qy * b.qx + a.qz * b.qw,
    qw: a.qw * b.qw - a.qx * b.qx - a.qy * b.qy - a.qz * b.qz,
  };
}

/** Pose of the frame in which `a` is told, as it is seen from `a`. */
export function inverse(a) {
  const turned = { ...IDENTITY, qx: -a.qx, qy: -a.qy, qz: -a.qz, qw: a.qw };
  const p = rotate(turned, a.x, a.y, a.z);
  return { ...turned, x: -p[0], y: -p[1], z: -p[2] };
}

/** A vector turned by a pose's rotation. */
export function rotate(q, x, y, z) {
  const { qx, qy, qz, qw } = q;
  const tx = 2 * (qy * z - qz * y), ty = 2 * (qz * x - qx * z), tz = 2 * (qx * y - qy * x);
  return [x + qw * tx + qy * tz - qz * ty, y + qw * ty + qz * tx - qx * tz, z + qw * tz + qx * ty - qy * tx];
}

export function yawOf(pose) {
  return Math.atan2(2 * (pose.qw * pose.qz + pose.qx * pose.qy), 1 - 2 * (pose.qy * pose.qy + pose.qz * pose.qz));
}

/** Pose of a geometry_msgs/Pose. A quaternion of zeros, as many nodes leave it, is not a rotation. */
export function poseOf({ position, orientation: q }) {
  const length = Math.hypot(q.x, q.y, q.z, q.w);
  const rotation = length ? { qx: q.x / length, qy: q.y / length, qz: q.z / length, qw: q.w / length } : { qx: 0, qy: 0, qz: 0, qw: 1 };
  return { x: position.x, y: position.y, z: position.z, ...rotation };
}

export class Frames {
  /** @param time the page's time: {live, at} */
  constructor(time) {
    this.time = time;
    this.fixed = "map";
    this.nodes = new Map(); // by child: {name, parent, pose, serial}
    this._snapshots = [];
    this._shown = null; // parents and poses at the scrubbed time
    this._cache = new Map();
    this._serials = 0;
    this._newest = 0;
    this.version = 0;
  }

  /** Take a tf2_msgs/TFMessage that arrived at a time, in milliseconds; static frames, with Infinity, stay. */
  add(message, at = Infinity) {
    if (at < Infinity) this._newest = at;
    for (const { header, child_frame_id: child, transform } of message.transforms) {
      const name = bare(child), parent = bare(header.frame_id);
      if (!name || name === parent) continue;
      const pose = poseOf({ position: transform.translation, orientation: transform.rotation });
      const node = this.nodes.get(name);
      if (node?.parent !== parent) this._names = null;
      if (node) Object.assign(node, { parent, pose, at });
      else this.nodes.set(name, { name, parent, pose, at, serial: this._serials++ });
    }
    this.version += 1;
    this._cache.clear();
  }

  clear() {
    this.nodes.clear();
    this._serials = this._newest = 0;
    this._names = null;
    this._snapshots = [];
    this._cache.clear();
    this.version += 1;
  }

  /** Keep a snapshot when it is due, and show those of the page's time: once a frame. */
  frame(now) {
    const last = this._snapshots[this._snapshots.length - 1];
    if (this.time.live && this.nodes.size && (!last || now - last.time >= SNAPSHOT || now < last.time)) this._snapshot(now);
    const shown = this.time.live ? null : this._snapshotAt(this.time.at);
    if (shown !== this._shown) {
      this._shown = shown;
      this._cache.clear();
      this.version += 1;
    }
  }

  names() {
    if (this._names?.size === this.nodes.size) return this._names.sorted;
    const found = new Set();
    for (const { name, parent } of this.nodes.values()) found.add(name).add(parent);
    this._names = { size: this.nodes.size, sorted: [...found].sort() };
    return this._names.sorted;
  }

  /** Pose of a frame in the fixed one, or null if they are not connected. */
  lookup(frame) {
    const name = bare(frame);
    let found = this._cache.get(name);
    if (found === undefined) {
      const [root, pose] = this._toRoot(name);
      const [fixedRoot, fixedPose] = this._toRoot(this.fixed);
      found = name === this.fixed ? IDENTITY : root === fixedRoot ? compose(inverse(fixedPose), pose) : null;
      this._cache.set(name, found);
    }
    return found;
  }

  /** Forget the poses that were looked up: the fixed frame is another one. */
  clearCache() { this._cache.clear(); }

  root(frame) { return this._toRoot(bare(frame))[0]; }

  _toRoot(name) {
    let pose = IDENTITY;
    for (let i = 0; i < LONGEST_CHAIN; i++) {
      const node = this._node(name);
      if (!node) return [name, pose];
      pose = compose(node.pose, pose);
      name = node.parent;
    }
    return [name, pose]; // a circle
  }

  _node(name) {
    const node = this.nodes.get(name);
    if (!this._shown || !node) return node;
    const { numbers, parents } = this._shown, at = node.serial * NUMBERS;
    if (parents[node.serial] === undefined) return undefined;
    const [x, y, z, qx, qy, qz, qw] = numbers.subarray(at, at + NUMBERS);
    return { parent: parents[node.serial], pose: { x, y, z, qx, qy, qz, qw } };
  }

  _snapshot(time) {
    if (this._snapshots.length && time < this._snapshots[this._snapshots.length - 1].time) this._snapshots = [];
    this._forget();
    const numbers = new Float64Array(this._serials * NUMBERS), parents = [];
    for (const { parent, pose, serial } of this.nodes.values()) {
      numbers.set([pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw], serial * NUMBERS);
      parents[serial] = parent;
    }
    this._snapshots.push({ time, numbers, parents });
    if (this._snapshots.length > MOST_SNAPSHOTS) this._snapshots.shift();
  }

  /** Take away frames of robots that are gone. Where all stand still, as when a world is paused, none is. */
  _forget() {
    for (const node of this.nodes.values()) {
      if (node.at > this._newest - FORGET) continue;
      this.nodes.delete(node.name);
      this._names = null;
      this._cache.clear();
      this.version += 1;
    }
  }

  _snapshotAt(time) {
    let found = null;
    for (const each of this._snapshots) {
      if (each.time > time) break;
      found = each;
    }
    return found ?? this._snapshots[0] ?? null;
  }
}

function bare(name) { return name.startsWith("/") ? name.slice(1) : name; }
