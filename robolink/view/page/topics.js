// Topics of the page: channel, statistics and latest message of each, decoded only when somebody looks.

import { Ring } from "./ring.js";
import { Emitter } from "./dom.js";

/** Most bytes of the last minute that the page keeps, over all topics. */
export const MEMORY = 48e6;

/** One topic. Its `view` and `latest` are those of the page's time: now, or where the timeline was dragged to. */
export class Topic {
  constructor(name, topics) {
    this.name = name;
    this._topics = topics;
    this.channel = null;
    this.statistics = null;
    this.error = "";
    this.listeners = new Set();
    this.ring = new Ring();
    this.subscription = 0;
    this.rate = 0;
    this._newest = null;
    this._newestTime = 0;
    this._decodedFrom = null;
    this._decoded = null;
  }

  /** Type name, such as "std_msgs/msg/String"; "" while it is not known. */
  get type() { return this.channel?.schemaName ?? this._topics.connection.graph.types.get(this.name) ?? ""; }

  /** Schema of the messages, or null. */
  get schema() {
    const { channel } = this;
    return channel && (channel.read ??= this._topics.connection.schemaOf(channel.schemaName, channel.schema));
  }

  /** Bytes of the message at the page's time (DataView), or null: another object for another message. */
  get view() {
    const { time } = this._topics;
    return time.live ? this._newest : (this.ring.at(time.at)?.view ?? null);
  }

  /** When that message was received, in milliseconds. */
  get time() {
    const { time } = this._topics;
    return time.live ? this._newestTime : (this.ring.at(time.at)?.time ?? 0);
  }

  /** That message, decoded; null if there is none, or if it cannot be decoded: see `error`. */
  get latest() {
    const { view } = this;
    if (view !== this._decodedFrom) {
      this._decodedFrom = view;
      this._decoded = this.decode(view);
    }
    return this._decoded;
  }

  /** Decode bytes of this topic; null with `error` set if that fails. */
  decode(view) {
    this.error = "";
    if (!view) return null;
    try {
      return this.schema.decode(view);
    } catch (error) {
      this.error = error.message;
      return null;
    }
  }

  take(time, view) {
    this._newest = view;
    this._newestTime = time;
    this.ring.add(time, view, this._topics.share);
    for (const { every } of this.listeners) {
      try {
        every?.(view, time, this);
      } catch (error) { // of a type that this listener does not expect: the other messages of its batch go on
        this.error = `${error}`;
      }
    }
  }
}

/** All topics by name. Events: change (a topic came or went), statistics, forget (a bag was moved to another place). */
export class Topics extends Emitter {
  /** @param time {live, at}: the page's time */
  constructor(connection, time) {
    super();
    this.connection = connection;
    this.time = time;
    this.map = new Map();
    this._bySubscription = new Map();
    this.share = MEMORY;
    this.messages = 0;
    connection.on("channels", (added, gone) => this._channels(added, gone));
    connection.onmessage = (id, at, view) => this._message(id, at, view);
    connection.on("statistics", (told) => this._statistics(told));
    connection.on("graph", () => this._graph());
    connection.on("close", () => this._lost());
  }

  /** Topic of a name; it is made if it is new, and comes alive when it is advertised. */
  get(name) {
    if (!this.map.has(name)) this.map.set(name, new Topic(name, this));
    return this.map.get(name);
  }

  /** Topics that exist, by name, without hidden ones. */
  list() {
    return [...this.map.values()]
      .filter((each) => (each.channel && !each.channel.hidden) || (!each.channel && each.type))
      .sort((a, b) => (a.name < b.name ? -1 : 1));
  }

  /**
   * Subscribe to a topic, also to one that comes later. `every(view, time, topic)` is called with each message;
   * `rate` (Hz) is how often at most messages come, 0 for all. Returns {topic, close()}.
   */
  listen(name, { rate = 0, every } = {}) {
    const topic = this.get(name), listener = { rate, every };
    topic.listeners.add(listener);
    if (every && topic.subscription && topic._newest) queueMicrotask(() => every(topic._newest, topic._newestTime, topic)); // it may be latched
    this._update(topic);
    return { topic, close: () => { if (topic.listeners.delete(listener)) this._update(topic); } };
  }

  get memory() {
    let sum = 0;
    for (const topic of this.map.values()) sum += topic.ring.bytes;
    return sum;
  }

  /** Forget what was received: a bag was moved to another place. */
  forget() {
    for (const topic of this.map.values()) topic.ring.clear();
    this.emit("forget");
  }

  _update(topic) {
    const rates = [...topic.listeners].map((each) => each.rate);
    const wanted = topic.channel && rates.length > 0;
    const rate = rates.includes(0) ? 0 : Math.max(0, ...rates);
    if (topic.subscription && (!wanted || rate !== topic.rate)) {
      this.connection.unsubscribe(topic.subscription);
      this._bySubscription.delete(topic.subscription);
      topic.subscription = 0;
    }
    if (wanted && !topic.subscription) {
      topic.rate = rate;
      topic.subscription = this.connection.subscribe(topic.channel.id, rate);
      this._bySubscription.set(topic.subscription, topic);
    }
    this.share = MEMORY / Math.max(1, this._bySubscription.size);
  }

  _channels(added, gone) {
    for (const channel of gone) {
      const topic = this.map.get(channel.topic);
      if (topic?.channel?.id === channel.id) this._leave(topic);
    }
    for (const channel of added) {
      if (channel.encoding !== "cdr" || !channel.schemaName) continue;
      const topic = this.get(channel.topic);
      topic.channel = channel;
      topic._decodedFrom = null;
      this._update(topic);
    }
    this.emit("change");
  }

  _leave(topic) {
    topic.channel = null;
    topic.statistics = null;
    this._bySubscription.delete(topic.subscription);
    topic.subscription = 0;
  }

  _lost() {
    for (const topic of this.map.values()) this._leave(topic);
    this.emit("change");
  }

  _message(id, at, view) {
    this.messages += 1;
    this._bySubscription.get(id)?.take(at, view);
  }

  _statistics({ topics }) {
    const byChannel = new Map([...this.map.values()].filter((each) => each.channel).map((each) => [each.channel.id, each]));
    for (const each of topics) {
      const topic = byChannel.get(each.channelId);
      if (topic) topic.statistics = each;
    }
    this.emit("statistics");
  }

  _graph() {
    for (const name of this.connection.graph.types.keys()) this.get(name);
    this.emit("change");
  }
}
