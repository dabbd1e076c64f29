// WebSocket client of the view's server: Foxglove's protocol, with the batches and statistics of robolink.v1.
//
// Events: open, close, info (serverInfo), channels, services, statistics, graph, parameters, recording, stop, playback,
// time, status. Messages go to `onmessage(subscription, time, view)`. Times are milliseconds.

import { Schema } from "./cdr.js";
import { Emitter } from "./dom.js";

const RETRY = [300, 600, 1200, 2400];
const UNPAINTED = 3; // batches that may wait for a frame before the page stops to acknowledge
const ACKNOWLEDGE = Uint8Array.of(0x80);
const CALL_SECONDS = 10;

/** Services that any node has, which a person seldom calls. */
export const COMMON = /\/(describe_parameters|get_parameters|get_parameter_types|list_parameters|set_parameters|set_parameters_atomically|get_type_description|get_loggers?_levels?|set_loggers?_levels?)$/;

const milliseconds = (view, at) => (view.getUint32(at + 4, true) * 4294967296 + view.getUint32(at, true)) / 1e6;

/** Write a time in milliseconds as nanoseconds. */
function putTime(view, at, time) { view.setBigUint64(at, BigInt(Math.round(time * 1000)) * 1000n, true); }

const publisherKey = (topic, type, options) => `${topic} ${type} ${JSON.stringify(options)}`;
const emptyGraph = () => ({ published: new Map(), subscribed: new Map(), services: new Map(), types: new Map(), qos: new Map(), nodes: [] });

export class Connection extends Emitter {
  /** @param {string} address of the WebSocket */
  constructor(address) {
    super();
    this.address = address;
    this.info = null;
    this.onmessage = () => {}; // no event: it is called thousands of times a second
    this.channels = new Map();
    this.services = new Map();
    this.graph = emptyGraph();
    this._attempt = 0;
    this._next = 1;
    this._unpainted = 0;
    this._owed = 0;
    this._calls = new Map();
    this._publishers = new Map();
    this._schemas = new Map();
    this._types = {}; // what may be published though nobody advertises it
  }

  /** True while the server has been heard. */
  get isOpen() { return this.info !== null; }

  /** True if this page may not publish, call, set or record. */
  get isReadOnly() { return this.info?.robolink?.readOnly ?? false; }

  /** Connect, and connect again whenever the connection is lost. */
  open() {
    const socket = new WebSocket(this.address, ["robolink.v1"]);
    this._socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => (typeof data === "string" ? this._text(JSON.parse(data)) : this._binary(new DataView(data)));
    socket.onclose = () => this._closed();
  }

  /** Send a JSON operation; false without a connection. */
  send(operation) { return this._raw(JSON.stringify(operation)); }

  _raw(data) {
    if (this._socket?.readyState !== WebSocket.OPEN) return false;
    this._socket.send(data);
    return true;
  }

  _closed() {
    const before = this.info;
    this.info = null;
    this.channels.clear();
    this.services.clear();
    this.graph = emptyGraph();
    this._publishers.clear();
    for (const [, call] of this._calls) call.reject(new Error("connection lost"));
    this._calls.clear();
    this._unpainted = this._owed = 0;
    if (before) this._attempt = 0;
    const wait = RETRY[Math.min(this._attempt++, RETRY.length - 1)];
    this.emit("close", before);
    this.emit("graph", this.graph);
    setTimeout(() => this.open(), wait);
  }

  _text(operation) {
    const handle = TEXT[operation.op];
    if (handle) handle(this, operation);
  }

  _binary(view) {
    switch (view.getUint8(0)) {
      case 0x01:
        this.onmessage(view.getUint32(1, true), milliseconds(view, 5), new DataView(view.buffer, 13));
        break;
      case 0x02: this.emit("time", milliseconds(view, 1)); break;
      case 0x03: this._answer(view); break;
      case 0x05:
        this.emit("playback", { status: view.getUint8(1), time: milliseconds(view, 2), speed: view.getFloat32(10, true), didSeek: view.getUint8(14) === 1, id: new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + 19)) });
        break;
      case 0x80: this._batch(view); break;
    }
  }

  _batch(view) {
    for (let at = 1; at < view.byteLength;) {
      const length = view.getUint32(at, true);
      this.onmessage(view.getUint32(at + 4, true), milliseconds(view, at + 8), new DataView(view.buffer, at + 16, length));
      at += 16 + length;
    }
    this._unpainted += 1;
    if (this._unpainted <= UNPAINTED && !document.hidden) this._raw(ACKNOWLEDGE);
    else this._owed += 1;
  }

  /** Acknowledge what was held back: called once a frame, so that a slow page gets the newest and never old data. */
  painted() {
    this._unpainted = 0;
    for (; this._owed > 0; this._owed--) this._raw(ACKNOWLEDGE);
  }

  /** Subscribe to a channel; `rate` in Hz, 0 is every message. Returns the subscription's number. */
  subscribe(channelId, rate = 0) {
    const id = this._next++;
    this.send({ op: "subscribe", subscriptions: [{ id, channelId, rate }] });
    return id;
  }

  unsubscribe(id) { this.send({ op: "unsubscribe", subscriptionIds: [id] }); }

  /** Schema of a type, from a channel or from the server; null if neither has it. */
  schemaOf(type, text) {
    const known = text ?? [...this.channels.values()].find((each) => each.schemaName === type)?.schema ?? this._types[type];
    if (known === undefined) return null;
    const key = `${type}\n${known}`; // a system that was started again may have changed the type
    if (!this._schemas.has(key)) this._schemas.set(key, new Schema(type, known));
    return this._schemas.get(key);
  }

  /**
   * Publish a message. `options.stopAfter`: seconds after which the server stops a robot that hears nothing more.
   */
  publish(topic, type, message, options = {}) {
    const payload = this.schemaOf(type).encode(message);
    const key = publisherKey(topic, type, options);
    if (!this._publishers.has(key)) {
      const id = this._next++;
      if (!this.send({ op: "advertise", channels: [{ id, topic, encoding: "cdr", schemaName: type, ...options }] })) return false;
      this._publishers.set(key, id);
    }
    const data = new Uint8Array(5 + payload.length);
    data[0] = 1;
    new DataView(data.buffer).setUint32(1, this._publishers.get(key), true);
    data.set(payload, 5);
    return this._raw(data);
  }

  /** Service by its name, or undefined: {id, name, type, request, response}. */
  service(name) { return [...this.services.values()].find((each) => each.name === name); }

  /** Call a service; the promise is the decoded response, or is rejected with the server's reason, or after `seconds`. */
  call(name, request, seconds = CALL_SECONDS) {
    const service = this.service(name);
    if (!service) return Promise.reject(new Error(`no service '${name}'`));
    const payload = partSchema(service, "request").encode(request);
    const callId = this._next++;
    const data = new Uint8Array(16 + payload.length);
    const view = new DataView(data.buffer);
    view.setUint8(0, 2);
    [service.id, callId, 3].forEach((value, i) => view.setUint32(1 + 4 * i, value, true));
    data.set([0x63, 0x64, 0x72], 13); // "cdr"
    data.set(payload, 16);
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => this._settle(callId)?.reject(new Error(`'${name}' has not answered within ${seconds} s`)), seconds * 1000);
      this._calls.set(callId, { service, resolve, reject, timer });
      if (!this._raw(data)) this._settle(callId).reject(new Error("connection lost"));
    });
  }

  /** Take a call from those that wait, if it is one. */
  _settle(callId) {
    const call = this._calls.get(callId);
    this._calls.delete(callId);
    clearTimeout(call?.timer);
    return call;
  }

  _answer(view) {
    const call = this._settle(view.getUint32(5, true));
    if (!call) return;
    const start = 13 + view.getUint32(9, true);
    try {
      call.resolve(partSchema(call.service, "response").decode(new DataView(view.buffer, start)));
    } catch (error) {
      call.reject(error);
    }
  }

  /** Control the playing of a bag: {play: bool, speed, seek (ms or undefined), id (a text that comes back with the answer)}. */
  playback({ play, speed = 1, seek, id = "" }) {
    const name = new TextEncoder().encode(id), view = new DataView(new ArrayBuffer(19 + name.length));
    view.setUint8(0, 3);
    view.setUint8(1, play ? 0 : 1);
    view.setFloat32(2, speed, true);
    view.setUint8(6, seek === undefined ? 0 : 1);
    putTime(view, 7, seek ?? 0);
    view.setUint32(15, name.length, true);
    new Uint8Array(view.buffer).set(name, 19);
    this._raw(view.buffer);
  }

  /** Start or stop the recorder. */
  record(command) { this.send({ op: "record", command }); }
}

/** Schema of a service's request or response, as the server advertises it. */
export function partSchema(service, part) {
  const { schemaName, schema } = service[part] ?? { schemaName: `${service.type}_${part}`, schema: service[`${part}Schema`] };
  service[`_${part}`] ??= new Schema(schemaName, schema ?? "");
  return service[`_${part}`];
}

const TEXT = {
  serverInfo(connection, operation) {
    const isFirst = !connection.info; // it comes again when what the server can do has changed
    connection.info = operation;
    Object.assign(connection._types, operation.robolink?.types);
    if (isFirst) connection.emit("open");
    connection.emit("info", operation);
    if (!isFirst) return;
    connection.send({ op: "subscribeStatistics" });
    if (operation.capabilities?.includes("connectionGraph")) connection.send({ op: "subscribeConnectionGraph" });
  },
  advertise(connection, { channels }) {
    for (const each of channels) connection.channels.set(each.id, each);
    connection.emit("channels", channels, []);
  },
  unadvertise(connection, { channelIds }) {
    const gone = channelIds.map((id) => connection.channels.get(id)).filter(Boolean);
    for (const id of channelIds) connection.channels.delete(id);
    connection.emit("channels", [], gone);
  },
  advertiseServices(connection, { services }) {
    for (const each of services) connection.services.set(each.id, each);
    connection.emit("services");
  },
  unadvertiseServices(connection, { serviceIds }) {
    for (const id of serviceIds) connection.services.delete(id);
    connection.emit("services");
  },
  statistics(connection, operation) { connection.emit("statistics", operation); },
  parameterValues(connection, operation) { connection.emit("parameters", operation); },
  stop(connection, operation) { connection.emit("stop", operation); },
  recording(connection, operation) { connection.emit("recording", operation); },
  learn(connection, operation) { connection.learn = operation; connection.emit("learn", operation); },
  exercise(connection, operation) { connection.emit("exercise", operation); },
  status(connection, operation) { connection.emit("status", operation); },
  serviceCallFailure(connection, { callId, message }) { connection._settle(callId)?.reject(new Error(message)); },
  connectionGraphUpdate(connection, operation) { updateGraph(connection, operation); },
};

function updateGraph(connection, operation) {
  const { graph } = connection;
  for (const [key, ids] of [["published", "publisherIds"], ["subscribed", "subscriberIds"]]) {
    for (const each of operation[`${key}Topics`] ?? []) {
      graph[key].set(each.name, each[ids]);
      each[ids].forEach((node, i) => graph.qos.set(`${key} ${each.name} ${node}`, each.qos?.[i] ?? ""));
      if (each.type) graph.types.set(each.name, each.type);
    }
  }
  for (const each of operation.advertisedServices ?? []) graph.services.set(each.name, each.providerIds);
  for (const name of operation.removedTopics ?? []) for (const key of ["published", "subscribed", "types"]) graph[key].delete(name);
  for (const name of operation.removedServices ?? []) graph.services.delete(name);
  if (operation.nodes) graph.nodes = operation.nodes;
  connection.emit("graph", graph);
}
