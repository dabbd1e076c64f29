// Foxglove's own client library against a view: what it sees and can do, as one line of JSON.
import { createRequire } from "node:module";
const require = createRequire(process.env.ROBOLINK_TESTS_NODE + "/");
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader, MessageWriter } = require("@foxglove/rosmsg2-serialization");
const WebSocket = require("ws");

const [, , address, subprotocol] = process.argv;
const socket = new WebSocket(address, [subprotocol]);
const client = new FoxgloveClient({ ws: socket });
const found = { errors: [], graph: {} };
const channels = new Map();
const services = new Map();
let reader, calling = false;

function step() {
  const done = ["subprotocol", "info", "scan", "echo", "answer", "parameter", "set"].every((key) => key in found);
  if (done && found.graph["/scan"]) {
    console.log(JSON.stringify(found));
    process.exit(0);
  }
}

client.on("error", (error) => found.errors.push(String(error)));
client.on("status", (status) => found.errors.push(status.message));
client.on("serverInfo", (info) => {
  found.subprotocol = socket.protocol;
  found.info = info;
  client.subscribeConnectionGraph();
  client.subscribeParameterUpdates(["/robot.speed"]);
  const channel = client.advertise({ topic: "/order", encoding: "cdr", schemaName: "geometry_msgs/msg/Twist" });
  const definition = "Vector3 linear\nVector3 angular\n" + "=".repeat(80) +
    "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
  const writer = new MessageWriter(parse(definition, { ros2: true }));
  const zero = { x: 0, y: 0, z: 0 };
  client.sendMessage(channel, writer.writeMessage({ linear: { ...zero, x: 0.25 }, angular: zero }));
});
client.on("advertise", (list) => {
  for (const each of list) {
    channels.set(each.topic, each);
    if (each.topic === "/scan" || each.topic === "/echo") {
      each.subscription = client.subscribe(each.id);
      each.reader = new MessageReader(parse(each.schema, { ros2: true }));
    }
  }
});
client.on("message", (message) => {
  for (const topic of ["/scan", "/echo"]) {
    const channel = channels.get(topic);
    if (channel && channel.subscription === message.subscriptionId) {
      const read = channel.reader.readMessage(message.data);
      if (topic === "/scan") found.scan = { frame: read.header.frame_id, beams: read.ranges.length, first: read.ranges[0] };
      else found.echo = read.data;
    }
  }
  step();
});
client.on("advertiseServices", (list) => {
  for (const each of list) services.set(each.name, each);
  const service = services.get("/light");
  if (service && !calling) {
    calling = true;
    const schema = (half) => parse(service[half] ? service[half].schema : service[half + "Schema"], { ros2: true });
    reader = new MessageReader(schema("response"));
    const request = new MessageWriter(schema("request")).writeMessage({ data: true });
    client.sendServiceCallRequest({ serviceId: service.id, callId: 7, encoding: "cdr", data: new DataView(request.buffer, request.byteOffset, request.byteLength) });
  }
  if (services.has("/robot/get_parameters") && !found.asked) {
    found.asked = true;
    client.getParameters(["/robot.speed"], "get");
  }
});
client.on("serviceCallResponse", (answer) => {
  found.answer = { call: answer.callId, ...reader.readMessage(answer.data) };
  step();
});
client.on("parameterValues", (values) => {
  const value = values.parameters.find((each) => each.name === "/robot.speed")?.value;
  if (values.id === "get") {
    found.parameter = value;
    client.setParameters([{ name: "/robot.speed", value: 2 }], "set");
  }
  if (values.id === "set") found.set = value;
  step();
});
client.on("connectionGraphUpdate", (update) => {
  for (const each of update.publishedTopics) found.graph[each.name] = each.publisherIds;
  step();
});
