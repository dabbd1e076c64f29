// Reader of MCAP files with @mcap/core, as Foxglove and Lichtblick read them: for each path on a line of the input a
// line with the number of messages that were read by the index, and without it; or E and the error.
const { createRequire } = require("node:module");
const inTests = createRequire(process.env.ROBOLINK_TESTS_NODE + "/");
const { McapIndexedReader, McapStreamReader } = inTests("@mcap/core");
const { loadDecompressHandlers } = inTests("@mcap/support");
const fs = require("node:fs");
const readline = require("node:readline");

class FileReadable {
  constructor(path) { this.file = fs.openSync(path, "r"); }
  async size() { return BigInt(fs.fstatSync(this.file).size); }
  async read(offset, length) {
    const buffer = Buffer.alloc(Number(length));
    const count = fs.readSync(this.file, buffer, 0, Number(length), Number(offset));
    if (count !== Number(length)) { throw new Error(`read ${count} of ${length} bytes`); }
    return new Uint8Array(buffer.buffer, buffer.byteOffset, count);
  }
  close() { fs.closeSync(this.file); }
}

async function byIndex(path, decompressHandlers) {
  const readable = new FileReadable(path);
  try {
    const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
    let count = 0;
    for await (const message of reader.readMessages()) { count += 1; }
    return count;
  } finally { readable.close(); }
}

function linearly(path, decompressHandlers) {
  const reader = new McapStreamReader({ decompressHandlers });
  const file = fs.openSync(path, "r");
  let count = 0;
  try {
    const buffer = Buffer.alloc(1 << 20);
    for (;;) {
      const length = fs.readSync(file, buffer, 0, buffer.length, null);
      if (length === 0) { break; }
      reader.append(new Uint8Array(buffer.subarray(0, length)));
      for (let record; (record = reader.nextRecord()); ) { if (record.type === "Message") { count += 1; } }
    }
  } finally { fs.closeSync(file); }
  if (!reader.done()) { throw new Error("the file has no end"); }
  return count;
}

async function attempt(read) {
  try { return String(await read()); } catch (error) { return "E:" + error.message.slice(0, 80).replace(/\s+/g, "_"); }
}

async function main() {
  const handlers = await loadDecompressHandlers();
  for await (const path of readline.createInterface({ input: process.stdin })) {
    console.log(await attempt(() => byIndex(path, handlers)), await attempt(async () => linearly(path, handlers)));
  }
}

main();
