// Series of the plot panel: times and values of one field, in typed arrays that grow, and their lines on a canvas.

const FIRST = 1024, MOST = 1 << 17; // points of a series

export class Series {
  /** @param axis 0 left, 1 right  @param colour of the line */
  constructor(topic, path, axis, colour) {
    Object.assign(this, { topic, path, axis, colour });
    this.parts = path.match(/[^.[\]]+/g) ?? [];
    this.clear();
  }

  clear() {
    this.times = new Float64Array(FIRST);
    this.values = new Float64Array(FIRST);
    this.count = 0;
  }

  get name() { return `${this.topic} ${this.path}`; }

  /** Take the field of a message; nothing where the message has no such number. */
  take(time, message) {
    let value = message;
    for (const part of this.parts) value = value?.[part];
    if (value === undefined || value === null) return;
    if (this.count && time < this.times[this.count - 1]) this.clear(); // a bag was started again
    if (this.count === this.times.length) this._grow();
    this.times[this.count] = time;
    this.values[this.count++] = Number(value);
  }

  _grow() {
    const full = this.count >= MOST, from = full ? this.count >> 1 : 0, size = full ? MOST : 2 * this.count;
    for (const name of ["times", "values"]) {
      const old = this[name];
      this[name] = new Float64Array(size);
      this[name].set(old.subarray(from, this.count));
    }
    this.count -= from;
  }

  /** Index of the first point that is not before a time. */
  from(time) {
    let low = 0, high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Value at a time: that of the last point before it, or NaN. */
  at(time) {
    const i = this.from(time + 1e-6) - 1;
    return i < 0 ? NaN : this.values[i];
  }

  /** Widen [low, high] to the values between two times. */
  extent(range, start, end) {
    const { values } = this;
    let [low, high] = range;
    for (let i = Math.max(0, this.from(start) - 1), last = this.from(end); i < last; i++) {
      const value = values[i];
      if (value < low && value > -Infinity) low = value;
      if (value > high && value < Infinity) high = value;
    }
    range[0] = low;
    range[1] = high;
  }

  /** Add the line between two times to a path: at most four points for each column of pixels. `right` and `up` are pixels a millisecond and a unit. */
  trace(context, start, end, left, right, bottom, up) {
    const { times, values } = this, first = Math.max(0, this.from(start) - 1), stop = Math.min(this.count, this.from(end) + 1);
    let low = 0, high = 0, last = 0, down = false, x = 0, points = 0;
    const flush = () => { if (low !== high) for (const value of [low, high, last]) context.lineTo(x, bottom - value * up); };
    for (let i = first; i < stop; i++) {
      const value = values[i], at = left + (times[i] - start) * right;
      if (value - value !== 0) { // no number, or infinite: the line has a gap
        if (down) flush();
        down = false;
      } else if (!down || at - x >= 1) {
        if (down) flush();
        x = at;
        if (down) context.lineTo(x, bottom - value * up);
        else context.moveTo(x, bottom - value * up);
        low = high = last = value;
        down = true;
        points += 1;
      } else {
        if (value < low) low = value;
        else if (value > high) high = value;
        last = value;
      }
    }
    if (down) flush();
    if (points === 1) context.lineTo(x + 1, bottom - last * up); // else it would not be seen
  }
}

/** Units of ROS 2's own messages (REP 103), by the end of the type and path of a field. */
const UNITS = [
  [/(linear_acceleration|Accel\S* .*linear)\.\w$/, "m/s²"], [/(Twist\S*|Odometry) .*linear\.\w$/, "m/s"], [/((Twist\S*|Odometry) .*angular|angular_velocity)\.\w$|JointState vel/, "rad/s"],
  [/(position|translation)\.\w$|(LaserScan|Range) range|Point\S* .*\b[xyz]$/, "m"], [/LaserScan angle_|JointState pos|theta$/, "rad"], [/voltage/, "V"], [/BatteryState current$/, "A"], [/temperature$/, "°C"],
];

/** Unit of a field, or "" where it is not known. */
export function unitOf(type, path) { return UNITS.find(([field]) => field.test(`${type} ${path}`))?.[1] ?? ""; }

/** Round numbers between two bounds, about `count` of them. */
export function ticks(low, high, count) {
  const rough = (high - low) / Math.max(1, count), power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((each) => each * power >= rough), found = [];
  for (let at = Math.ceil(low / step) * step; at <= high && found.length < 100; at += step) found.push(Math.abs(at) < step / 1e6 ? 0 : at);
  return { step, found };
}

/** Table of all points as CSV: one column for the time in seconds and one for each series. */
export function csv(series) {
  const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
  const rows = new Map();
  series.forEach((each, k) => {
    for (let i = 0; i < each.count; i++) {
      const time = each.times[i];
      if (!rows.has(time)) rows.set(time, new Array(series.length).fill(""));
      rows.get(time)[k] = each.values[i];
    }
  });
  const lines = [...rows].sort((a, b) => a[0] - b[0]).map(([time, values]) => `${(time / 1000).toFixed(6)},${values.join(",")}`);
  return `${["time", ...series.map(({ name }) => quoted(name))].join(",")}\n${lines.join("\n")}\n`;
}
