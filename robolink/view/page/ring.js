// Ring buffer of one topic's last minute: thinned, so that it never holds more bytes than its share.
//
// Messages stand one behind the other in one block of memory: thousands of small buffers would keep the garbage
// collector busy, for longer than a frame.

export const MINUTE = 60_000;
const PERIOD = 100; // ms between messages that are kept, before thinning
const ENTRY = 24; // bytes of an entry beside its data
const LEAST = 1024;

export class Ring {
  constructor() {
    this._part = 0.7 + 0.3 * Math.random(); // of the share, so that not all rings make room in the same frame
    this.clear();
  }

  clear() {
    this._times = [];
    this._starts = [];
    this._sizes = [];
    this._first = 0; // those before it are older than a minute
    this._data = new Uint8Array(0);
    this._used = 0;
    this._shown = null;
    this.period = PERIOD;
  }

  /** Number of messages held. */
  get length() { return this._times.length - this._first; }

  /** Bytes that are held. */
  get bytes() { return this._data.length + ENTRY * this._times.length; }

  /** Time of the oldest in milliseconds, or Infinity. */
  get start() { return this.length ? this._times[this._first] : Infinity; }

  /** Keep a copy of a message if it is due; `share` is the most bytes that this ring may hold. */
  add(time, view, share) {
    const last = this._times[this._times.length - 1];
    if (time < last) this.clear(); // time went back: a bag was started again
    else if (time - last < this.period) return;
    const size = view.byteLength;
    while (this._times[this._first] < time - MINUTE) this._first += 1;
    if (this._used + size > this._data.length || this.bytes + ENTRY > share) {
      if (!this._room(size, share)) return;
    }
    this._data.set(new Uint8Array(view.buffer, view.byteOffset, size), this._used);
    this._times.push(time);
    this._starts.push(this._used);
    this._sizes.push(size);
    this._used += size;
  }

  /** Newest message that is not later than a time: {time, view}, or null. The same object while it is the same one. */
  at(time) {
    let low = this._first, high = this._times.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this._times[middle] <= time) low = middle + 1;
      else high = middle;
    }
    if (low === this._first) return null;
    if (this._shown?.time !== this._times[low - 1]) this._shown = this._item(low - 1);
    return this._shown;
  }

  /** Messages between two times, oldest first. */
  *between(start, end) {
    for (let i = this._first; i < this._times.length; i++) {
      if (this._times[i] > end) return;
      if (this._times[i] >= start) yield this._item(i);
    }
  }

  /** A copy: what is held moves in its block. */
  _item(i) {
    const start = this._starts[i];
    return { time: this._times[i], view: new DataView(this._data.slice(start, start + this._sizes[i]).buffer) };
  }

  /** Make room for a message: forget what is old, then take more memory, then thin. False if it is too large. */
  _room(size, share) {
    this._keep((i) => i >= this._first);
    for (;;) { // a quarter stays free, so that this is done seldom
      const most = this._part * share - 2 * ENTRY * (this._times.length + 1), wanted = this._used + size;
      if (wanted <= most && (wanted <= 0.75 * most || this._times.length < 4)) {
        if (this._data.length < Math.min(most, 1.15 * wanted) || this._data.length > most) this._move(Math.min(most, Math.max(LEAST, (1 + this._part / 2) * wanted)));
        return true;
      }
      if (!this._times.length) return false;
      this.period *= 2;
      this._keep((i) => i % 2 === 1); // the newest of each two
    }
  }

  _keep(wanted) {
    const times = [], starts = [], sizes = [];
    let used = 0;
    for (let i = 0; i < this._times.length; i++) {
      if (!wanted(i)) continue;
      const start = this._starts[i], size = this._sizes[i];
      this._data.copyWithin(used, start, start + size);
      times.push(this._times[i]);
      starts.push(used);
      sizes.push(size);
      used += size;
    }
    Object.assign(this, { _times: times, _starts: starts, _sizes: sizes, _used: used, _first: 0 });
  }

  _move(capacity) {
    const data = new Uint8Array(Math.floor(capacity));
    data.set(this._data.subarray(0, this._used));
    this._data = data;
  }
}
