// CDR decoder and encoder of ROS 2 messages: closures made from a ros2msg text, without eval, so that a strict
// Content-Security-Policy holds. Integers of 64 bits are numbers where that is exact, else BigInt; arrays of numbers are
// typed arrays, which may share the message's memory.

const octet = [1, "Uint8", (view, at) => view.getUint8(at)];
// Size, name of DataView's methods, and the reader: a function of its own each, which the engine can inline.
const PRIMITIVES = {
  bool: [1, "Uint8", (view, at) => view.getUint8(at) !== 0], byte: octet, char: octet, uint8: octet,
  int8: [1, "Int8", (view, at) => view.getInt8(at)],
  int16: [2, "Int16", (view, at, little) => view.getInt16(at, little)],
  uint16: [2, "Uint16", (view, at, little) => view.getUint16(at, little)],
  int32: [4, "Int32", (view, at, little) => view.getInt32(at, little)],
  uint32: [4, "Uint32", (view, at, little) => view.getUint32(at, little)],
  int64: [8, "BigInt64", (view, at, little) => exact(view.getBigInt64(at, little))],
  uint64: [8, "BigUint64", (view, at, little) => exact(view.getBigUint64(at, little))],
  float32: [4, "Float32", (view, at, little) => view.getFloat32(at, little)],
  float64: [8, "Float64", (view, at, little) => view.getFloat64(at, little)],
};
const ARRAYS = {
  byte: Uint8Array, char: Uint8Array, int8: Int8Array, uint8: Uint8Array, int16: Int16Array, uint16: Uint16Array,
  int32: Int32Array, uint32: Uint32Array, int64: BigInt64Array, uint64: BigUint64Array, float32: Float32Array,
  float64: Float64Array,
};
const LITTLE_HOST = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;
const UTF8 = new TextDecoder();
const TO_UTF8 = new TextEncoder();
const FIELD = /^([A-Za-z][\w/]*)(?:<=(\d+))?(?:\[(<=)?(\d*)\])?\s+([A-Za-z]\w*)\s*(.*)$/;

/** Error of a text, message or value that does not fit its type. */
export class CdrError extends Error {}

/** Schema of a type: `fields(type)`, `constants(type)`, `decode(view)`, `encode(value)` and `zero()`. */
export class Schema {
  /** @param {string} name "pkg/msg/Name"  @param {string} text its ros2msg text, with the types that it needs */
  constructor(name, text) {
    this.name = name;
    this.root = short(name);
    this.types = parse(this.root, text);
    this._readers = new Map();
    this._writers = new Map();
  }

  /** Fields of a type: {name, type, primitive, bound, shape: "one"|"array"|"sequence", size, text (its default)}. */
  fields(type = this.root) { return this._type(type).fields; }

  /** Constants of a type: {name, type, value}. */
  constants(type = this.root) { return this._type(type).constants; }

  /** Message of a DataView that begins with the four bytes of the encapsulation. Throws CdrError. */
  decode(view) {
    if (view.byteLength < 4) throw new CdrError(`${this.name}: ${view.byteLength} bytes are no CDR message`);
    const kind = view.getUint16(0);
    if (kind > 1) throw new CdrError(`${this.name}: encapsulation 0x${kind.toString(16)} is not plain CDR`);
    try {
      return this._reader(this.root)({ view, at: 4, little: kind === 1 });
    } catch (error) {
      if (error instanceof RangeError) throw new CdrError(`${this.name}: the message ends too early`);
      throw error;
    }
  }

  /** Little-endian bytes (Uint8Array) of a message; fields that are missing have their default. Throws CdrError. */
  encode(value) {
    const out = new Output();
    this._writer(this.root)(out, value ?? {}, this.root);
    return out.bytes.slice(0, out.at);
  }

  /** Message with the defaults of its type. */
  zero(type = this.root) {
    return Object.fromEntries(this.fields(type).map((field) => [field.name, this.initial(field)]));
  }

  initial(field) {
    if (field.shape === "sequence" && !field.text) return [];
    if (field.text) return literal(field);
    const one = () => (field.primitive ? (field.type === "bool" ? false : isText(field) ? "" : 0) : this.zero(field.type));
    return field.shape === "one" ? one() : Array.from({ length: field.size }, one);
  }

  _type(name) {
    const found = this.types.get(short(name));
    if (!found) throw new CdrError(`${this.name}: the text has no type '${name}'`);
    return found;
  }

  _reader(type) {
    let read = this._readers.get(type);
    if (read) return read;
    let steps = null;
    let names = null;
    read = (input) => {
      steps ??= this.fields(type).map((field) => this._fieldReader(field));
      names ??= this.fields(type).map((field) => field.name);
      const out = {};
      if (!steps.length) input.at += 1; // ROS 2 puts one byte where a message has no fields
      for (let i = 0; i < steps.length; i++) out[names[i]] = steps[i](input);
      return out;
    };
    this._readers.set(type, read);
    return read;
  }

  _fieldReader(field) {
    const one = isText(field) ? (field.type === "string" ? readString : readWide)
      : field.primitive ? primitiveReader(field.type) : this._reader(field.type);
    if (field.shape === "one") return one;
    const numbers = ARRAYS[field.type] && numbersReader(ARRAYS[field.type]);
    return (input) => {
      const count = field.shape === "array" ? field.size : readCount(input);
      if (numbers) return numbers(input, count);
      if (count > input.view.byteLength) throw new RangeError(); // each takes a byte at least
      const out = new Array(count);
      for (let i = 0; i < count; i++) out[i] = one(input);
      return out;
    };
  }

  _writer(type) {
    let write = this._writers.get(type);
    if (write) return write;
    let steps = null;
    write = (out, value, path) => {
      steps ??= this.fields(type).map((field) => [field, this._fieldWriter(field)]);
      if (!steps.length) out.number("Uint8", 1, 0);
      if (typeof value !== "object") throw new CdrError(`${path}: expected a ${type}, got '${value}'`);
      for (const [field, step] of steps) step(out, value[field.name] ?? this.initial(field), `${path}.${field.name}`);
    };
    this._writers.set(type, write);
    return write;
  }

  _fieldWriter(field) {
    const one = isText(field) ? textWriter(field) : field.primitive ? primitiveWriter(field.type) : this._writer(field.type);
    if (field.shape === "one") return one;
    return (out, value, path) => {
      if (typeof value === "string" || value.length === undefined) throw new CdrError(`${path}: expected a list, got '${value}'`);
      const count = value.length;
      if (field.shape === "array" && count !== field.size) throw new CdrError(`${path}: expected ${field.size} elements, got ${count}`);
      if (field.shape === "sequence") {
        if (field.size && count > field.size) throw new CdrError(`${path}: expected at most ${field.size} elements, got ${count}`);
        out.number("Uint32", 4, count);
      }
      for (let i = 0; i < count; i++) one(out, value[i], `${path}[${i}]`);
    };
  }
}

/** Type name as schemas have it: "pkg/Name". */
export function short(name) { return name.replace(/\/(msg|srv|action)\//, "/"); }

function isText(field) { return field.type === "string" || field.type === "wstring"; }

function parse(root, text) {
  const [head, ...rest] = text.split(/^=+\r?\nMSG: /m);
  const types = new Map([[root, section(head, root)]]);
  for (const part of rest) {
    const end = part.indexOf("\n");
    const name = short((end < 0 ? part : part.slice(0, end)).trim());
    types.set(name, section(end < 0 ? "" : part.slice(end + 1), name));
  }
  return types;
}

function section(text, name) {
  const fields = [], constants = [], own = name.split("/")[0];
  for (const raw of text.split("\n")) {
    const found = FIELD.exec(raw.trim());
    if (!found) continue; // a comment, a blank line
    const [, type, bound, limit, size, field, rest] = found;
    if (rest.startsWith("=")) {
      constants.push({ name: field, type, value: scalar(type, uncommented(rest.slice(1)).trim()) });
      continue;
    }
    const primitive = type in PRIMITIVES || type === "string" || type === "wstring";
    const full = primitive ? type : type.includes("/") ? short(type) : type === "Header" ? "std_msgs/Header" : `${own}/${type}`;
    const shape = size === undefined ? "one" : limit || size === "" ? "sequence" : "array";
    fields.push({ name: field, type: full, primitive, bound: Number(bound ?? 0), shape, size: Number(size || 0), text: uncommented(rest).trim() });
  }
  return { fields, constants };
}

/** The text before a comment; a # inside quotes is none. */
function uncommented(text) {
  return (/^(?:"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|[^#"'])*/.exec(text) ?? [""])[0];
}

function scalar(type, text) {
  if (type === "bool") return /^(true|1)$/i.test(text);
  if (type === "string" || type === "wstring") return unquoted(text);
  if (type.endsWith("int64")) return exact(BigInt(text));
  return Number(text);
}

const ESCAPE = /\\(?:x([0-9a-fA-F]{2})|u([0-9a-fA-F]{4})|U([0-9a-fA-F]{8})|([0-7]{1,3})|(.))/g;
const ESCAPED = { a: "\x07", b: "\b", f: "\f", n: "\n", r: "\r", t: "\t", v: "\v" };

function unquoted(text) {
  const inner = /^(["'])(.*)\1$/.exec(text);
  return (inner ? inner[2] : text).replace(ESCAPE, (_, x, u, long, octal, letter) => {
    if (letter) return ESCAPED[letter] ?? letter;
    return String.fromCodePoint(octal ? parseInt(octal, 8) : parseInt(x ?? u ?? long, 16));
  });
}

function literal(field) {
  if (field.shape === "one") return scalar(field.type, field.text);
  const inner = field.text.replace(/^\[|\]$/g, "");
  const parts = inner.match(/"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|[^,\s]+/g) ?? [];
  return parts.map((part) => scalar(field.type, part));
}

function exact(big) { return big >= -9007199254740991n && big <= 9007199254740991n ? Number(big) : big; }

function align(input, size) {
  const over = (input.at - 4) % size;
  if (over) input.at += size - over;
}

function readCount(input) {
  align(input, 4);
  const count = input.view.getUint32(input.at, input.little);
  input.at += 4;
  return count;
}

function primitiveReader(type) {
  const [size, , get] = PRIMITIVES[type];
  if (size === 1) return (input) => get(input.view, input.at++);
  return (input) => {
    align(input, size);
    const value = get(input.view, input.at, input.little);
    input.at += size;
    return value;
  };
}

function numbersReader(Numbers) {
  const size = Numbers.BYTES_PER_ELEMENT;
  return (input, count) => {
    if (count) align(input, size);
    const { view, little } = input;
    const at = view.byteOffset + input.at;
    input.at += count * size;
    if (input.at > view.byteLength) throw new RangeError();
    if (size > 1 && little !== LITTLE_HOST) return swapped(view.buffer, at, count, Numbers);
    return at % size ? new Numbers(view.buffer.slice(at, at + count * size)) : new Numbers(view.buffer, at, count);
  };
}

function swapped(buffer, at, count, Numbers) {
  const size = Numbers.BYTES_PER_ELEMENT;
  const bytes = new Uint8Array(buffer.slice(at, at + count * size));
  for (let i = 0; i < bytes.length; i += size) bytes.subarray(i, i + size).reverse();
  return new Numbers(bytes.buffer);
}

function readString(input) {
  const count = readCount(input), start = input.at, { view } = input;
  input.at += count;
  if (input.at > view.byteLength) throw new RangeError();
  return count > 1 ? UTF8.decode(new Uint8Array(view.buffer, view.byteOffset + start, count - 1)) : "";
}

function readWide(input) { // UTF-16 units, each in four bytes, and no NUL behind them
  const count = readCount(input);
  if (count * 4 > input.view.byteLength) throw new RangeError();
  let text = "";
  for (let i = 0; i < count; i++, input.at += 4) text += String.fromCharCode(input.view.getUint32(input.at, input.little));
  return text;
}

/** Growing buffer of the encoder. */
class Output {
  constructor() {
    this._room(256);
    this.bytes.set([0, 1, 0, 0]);
    this.at = 4;
  }

  number(kind, size, value) {
    this.reserve(size + size);
    const over = (this.at - 4) % size;
    if (over) this.at += size - over;
    this.view[`set${kind}`](this.at, value, true);
    this.at += size;
  }

  raw(bytes) {
    this.reserve(bytes.length);
    this.bytes.set(bytes, this.at);
    this.at += bytes.length;
  }

  reserve(more) { if (this.at + more > this.bytes.length) this._room(2 * (this.at + more)); }

  _room(size) {
    const old = this.bytes;
    this.bytes = new Uint8Array(size);
    if (old) this.bytes.set(old);
    this.view = new DataView(this.bytes.buffer);
  }
}

function primitiveWriter(type) {
  const [size, kind] = PRIMITIVES[type];
  if (type === "bool") return (out, value) => out.number(kind, 1, value ? 1 : 0);
  if (kind.startsWith("Float")) {
    return (out, value, path) => {
      if (typeof value !== "number") throw new CdrError(`${path}: expected a number, got '${value}'`);
      out.number(kind, size, value);
    };
  }
  const bits = BigInt(8 * size), signed = !kind.includes("Uint");
  const low = signed ? -(1n << (bits - 1n)) : 0n, high = signed ? (1n << (bits - 1n)) - 1n : (1n << bits) - 1n;
  return (out, value, path) => {
    const whole = typeof value === "bigint" || Number.isInteger(value);
    if (!whole || value < low || value > high) throw new CdrError(`${path}: expected ${type} (${low} to ${high}), got '${value}'`);
    out.number(kind, size, size === 8 ? BigInt(value) : Number(value));
  };
}

function textWriter(field) {
  const wide = field.type === "wstring";
  return (out, value, path) => {
    if (typeof value !== "string") throw new CdrError(`${path}: expected a text, got '${value}'`);
    const bytes = wide ? null : TO_UTF8.encode(value);
    const length = wide ? value.length : bytes.length;
    if (field.bound && length > field.bound) throw new CdrError(`${path}: expected at most ${field.bound} ${wide ? "characters" : "bytes"}, got ${length}`);
    out.number("Uint32", 4, wide ? length : length + 1);
    if (wide) for (let i = 0; i < length; i++) out.number("Uint32", 4, value.charCodeAt(i));
    else { out.raw(bytes); out.number("Uint8", 1, 0); }
  };
}
