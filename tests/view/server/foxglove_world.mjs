// Foxglove's own client library looks at a simulated world: what it reads of each topic, as one line of JSON.
import { createRequire } from "node:module";
const require = createRequire(process.env.ROBOLINK_TESTS_NODE + "/");
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const WebSocket = require("ws");

const [, , address, ...topics] = process.argv;
const client = new FoxgloveClient({ ws: new WebSocket(address, ["foxglove.sdk.v1"]) });
const channels = new Map();
const found = {};

client.on("error", (error) => { throw error; });
client.on("advertise", (list) => {
  for (const each of list) {
    if (!topics.includes(each.topic)) continue;
    channels.set(client.subscribe(each.id), { ...each, reader: new MessageReader(parse(each.schema, { ros2: true })) });
  }
});
client.on("message", ({ subscriptionId, data }) => {
  const { topic, schemaName, encoding, reader } = channels.get(subscriptionId);
  found[topic] ??= { schemaName, encoding, message: told(reader.readMessage(data)) };
  if (topics.some((each) => !(each in found))) return;
  console.log(JSON.stringify(found));
  process.exit(0);
});

/** A message with the lengths of its arrays of numbers, points and colours in place of them. */
function told(value, key = "") {
  if (typeof value === "bigint") return Number(value);
  if (ArrayBuffer.isView(value) || key === "points" || key === "colors") return value.length;
  if (Array.isArray(value)) return value.map((each) => told(each));
  if (value && typeof value === "object") return Object.fromEntries(Object.entries(value).map(([name, each]) => [name, told(each, name)]));
  return value;
}
