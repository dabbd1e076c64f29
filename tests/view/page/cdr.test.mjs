// Tests of cdr.js against messages that robolink encoded: `CDR_CASES=FILE node --test tests/view/page/cdr.test.mjs`.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import { CdrError, Schema } from "../../../robolink/view/page/cdr.js";

const CASES = JSON.parse(readFileSync(process.env.CDR_CASES, "utf8"));
const bytesOf = (text) => new Uint8Array(Buffer.from(text, "base64"));
const viewOf = (bytes, at = 0) => { // at any place in a buffer, as the messages of a batch are
  const buffer = new Uint8Array(bytes.length + at);
  buffer.set(bytes, at);
  return new DataView(buffer.buffer, at);
};

/** What JSON can hold, as robolink's side wrote it: numbers beyond it as text. */
function plain(value) {
  if (typeof value === "bigint") return Number.isSafeInteger(Number(value)) ? Number(value) : `${value}`;
  if (typeof value === "number") return Number.isFinite(value) ? value : String(value);
  if (ArrayBuffer.isView(value) || Array.isArray(value)) return Array.from(value, plain);
  if (value && typeof value === "object") return Object.fromEntries(Object.entries(value).map(([key, each]) => [key, plain(each)]));
  return value;
}

function same(found, expected, path) {
  if (Array.isArray(expected)) {
    assert.equal(found.length, expected.length, path);
    expected.forEach((each, i) => same(found[i], each, `${path}[${i}]`));
  } else if (expected && typeof expected === "object") {
    assert.deepEqual(Object.keys(found), Object.keys(expected), path);
    for (const key of Object.keys(expected)) same(found[key], expected[key], `${path}.${key}`);
  } else {
    assert.equal(typeof expected === "string" ? String(found) : found, expected, path);
  }
}

for (const each of CASES) {
  test(each.name, () => {
    const schema = new Schema(each.name, each.schema);
    for (const [text, big, value] of each.messages) {
      const bytes = bytesOf(text);
      const message = schema.decode(viewOf(bytes));
      same(plain(message), value, each.name);
      assert.deepEqual(schema.encode(message), bytes);
      for (const at of [1, 4, 7]) assert.deepEqual(plain(schema.decode(viewOf(bytes, at))), plain(message));
      if (big) assert.deepEqual(plain(schema.decode(viewOf(bytesOf(big)))), plain(message));
      for (let cut = 0; cut < bytes.length; cut += 1 + (bytes.length >> 4)) {
        try { schema.decode(viewOf(bytes.subarray(0, cut))); } catch (error) { assert.ok(error instanceof CdrError, `${error}`); }
      }
    }
    assert.deepEqual(schema.encode(schema.zero()), bytesOf(each.zero), "defaults");
  });
}

test("a nonsense count is refused before memory is taken", () => {
  const schema = new Schema("x/msg/X", "string[] texts\nfloat64[] numbers\n");
  assert.throws(() => schema.decode(viewOf(Uint8Array.of(0, 1, 0, 0, 255, 255, 255, 255))), CdrError);
  assert.throws(() => schema.decode(viewOf(Uint8Array.of(0, 1, 0, 0, 0, 0, 0, 0, 255, 255, 255, 31))), CdrError);
});

test("another encapsulation is refused", () => {
  assert.throws(() => new Schema("x/msg/X", "uint8 a\n").decode(viewOf(Uint8Array.of(0, 7, 0, 0, 1))), /not plain CDR/);
});

test("values that do not fit say where", () => {
  const schema = new Schema("x/msg/X", "X[] inner\nuint8 small\nstring<=3 name\nint32[2] pair\nfloat64[<=1] few\nint64 large\n");
  assert.throws(() => schema.encode({ small: 256 }), /x\/X\.small: expected uint8 \(0 to 255\), got '256'/);
  assert.throws(() => schema.encode({ name: "four" }), /at most 3 bytes, got 4/);
  assert.throws(() => schema.encode({ pair: [1] }), /expected 2 elements, got 1/);
  assert.throws(() => schema.encode({ few: [1, 2] }), /at most 1 elements, got 2/);
  assert.throws(() => schema.encode({ inner: [{ small: "x" }] }), /inner\[0\]\.small/);
  assert.throws(() => schema.encode({ large: 1.5 }), /int64/);
});

test("constants and comments of a text", () => {
  const schema = new Schema("x/msg/X", '# head\nuint8 A=1 # one\nstring B="a # b" # c\nint64 C=9223372036854775807\nbool D=true\nstring s "x # y" # z\nint8[] l [1, -2]\n');
  assert.deepEqual(schema.constants().map(({ name, value }) => [name, value]), [["A", 1], ["B", "a # b"], ["C", 9223372036854775807n], ["D", true]]);
  assert.deepEqual(schema.zero(), { s: "x # y", l: [1, -2] });
});
