"""Subscriptions of a recording: what arrives, when, and into which cache.

The collector is woken by the first arrival and then waits for a moment, so that it takes many in one go: a wake-up for
each of 6,000 messages a second would cost more than the messages.

A subscription needs no type: what is not installed is recorded as well, in bytes. All of it is best effort, since a
recorder must not slow down whoever publishes; a topic that somebody latches is listened to with transient local, so
that what was published before is recorded too.
"""

from __future__ import annotations

import functools
import queue
import struct
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.bag.recording.topics import Arrived, RecordedTopic, RecordSettings, make_arrived
from robolink.bag.recording.writing import Cache
from robolink.bag.selection import Selection
from robolink.exceptions import OverwrittenError, RobolinkError, TransportClosedError, WireError
from robolink.graph.endpoint import ALL_BEST_EFFORT, ArrivalType, keys_of, listen
from robolink.graph.graph import EVERY
from robolink.message import type_hash, type_name
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.system import waits
from robolink.transport.base import Sample
from robolink.wire import NO_HASH, Attachment, EndpointKind, EndpointToken, unpack_attachment

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.transport.base import Handle


MOMENT = 0.02
"""Time in seconds that arrivals are gathered: a thread that is woken by each costs more than they do."""

_STAMP = {1: struct.Struct("<4xiI"), 0: struct.Struct(">4xiI")}
"""Layouts of a rosgraph_msgs/msg/Clock, by its byte for the byte order."""


class SimClock:
    """Target of the arrivals of /clock."""


class Switch(NamedTuple):
    """Target of an arrival that begins or ends a pause: what has come before it is not concerned."""

    paused: bool
    done: Callable[[], object]
    """Called on the collector's thread when it holds."""


class Collector:
    """Takes arrivals until it is closed.

    Args:
        read: `Transport.read`, which copies a message out of the network's memory.
        cache: Cache that gets the messages.
        on_clock: Called with the first message of /clock, before what comes behind it is taken; None where messages
            have the time of their arrival.
    """

    def __init__(
        self, read: Callable[[Any], Sample], cache: Cache, on_clock: Callable[[], object] | None = None
    ) -> None:
        self.queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        """Queue of arrivals; `put` is what the network calls."""
        self.paused = False
        """True while messages are let pass; the last ones of latched topics are kept."""
        self.malformed = 0
        """Number of messages without ROS 2's attachment."""
        self._read, self._cache, self._on_clock = read, cache, on_clock
        self._sim_time: int | None = None
        self._thread = threading.Thread(target=self._run, name="robolink bag collector", daemon=True)

    @property
    def sim_time(self) -> int | None:
        """Newest time of /clock, in ns; None before the first, and where nobody asks for it."""
        return self._sim_time

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def close(self) -> None:
        """Take what has arrived so far, and end the thread."""
        self.queue.put(None)
        waits.join(self._thread)

    def _run(self) -> None:
        get = self.queue.get_nowait
        while True:
            batch = [self.queue.get()]
            if batch[0] is not None:
                time.sleep(MOMENT)
            for _ in range(self.queue.qsize()):
                batch.append(get())
            ends = None in batch
            self._take([each for each in batch if each is not None] if ends else batch)
            if ends:
                return

    def _take(self, batch: list[Any]) -> None:
        read, taken, has_clock = self._read, list[Arrived](), self._on_clock is not None
        for arrival in batch:
            topic = arrival.target
            if type(topic) is not RecordedTopic:
                taken = self._obey(topic, arrival.content, taken)
                continue
            try:
                data, attachment = read(arrival.content)
                sender = unpack_attachment(attachment)
            except RobolinkError as error:
                self._refuse(topic, error)
                continue
            sequence, published, gid = sender
            last = topic.last
            if last.get(gid) == sequence - 1:  # the usual case of `before`, without the call
                last[gid] = sequence
            elif self._is_copy(topic, sender):
                continue
            at = self._sim_time if has_clock else arrival.at
            if at is not None:
                sent = published if published > 0 else 0  # of a wrong clock: no MCAP has times before 1970
                taken.append(make_arrived((topic, at, sent, sequence, data)))
                if topic.retained is not None:
                    topic.retained.append(taken[-1])
        self._pass_on(taken)

    def _pass_on(self, taken: list[Arrived]) -> None:
        if taken and not self.paused:
            self._cache.put(taken)

    def _obey(self, target: Any, content: Any, taken: list[Arrived]) -> list[Arrived]:
        """Set the time, or begin or end a pause; return the messages that are still to be passed on."""
        if isinstance(target, SimClock):
            self._set_time(content)
            return taken
        self._pass_on(taken)
        self.paused = target.paused
        target.done()
        return []

    def _is_copy(self, topic: RecordedTopic, sender: Attachment) -> bool:
        """Count what is missing before a message; return whether it has come before, by another subscription."""
        last = topic.gaps.last.get(sender.gid)
        missing = topic.gaps.before(sender)
        topic.lost += missing
        return topic.comes_twice and missing == 0 and last is not None and sender.sequence <= last

    def _refuse(self, topic: RecordedTopic, error: RobolinkError) -> None:
        if isinstance(error, OverwrittenError) and error.attachment:
            topic.lost += 1
            try:
                topic.lost += topic.gaps.before(unpack_attachment(error.attachment))
            except WireError:
                self.malformed += 1
        else:
            self.malformed += 1

    def _set_time(self, content: Any) -> None:
        try:
            data = self._read(content).payload
            seconds, nanoseconds = _STAMP[data[1] & 1].unpack_from(data)
        except (RobolinkError, struct.error, IndexError):
            self.malformed += 1
            return
        is_first, self._sim_time = self._sim_time is None, max(0, seconds * 10**9 + nanoseconds)
        if is_first and self._on_clock is not None:
            self._on_clock()


LATCHED = QoSProfile(depth=1000, reliability=ReliabilityPolicy.BEST_EFFORT, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Listener:
    """Subscriptions of a node to all topics of a selection, those that come later included.

    Args:
        node: Node whose subscriptions they are.
        selection: Topics to listen to.
        settings: What else decides: profiles, discovery, topics without publishers or subscriptions.
        arrival: Class of arrivals (`timed_arrival`), whose targets will be `RecordedTopic`s.
        on_topic: Called once for each topic, before its first message, on a thread of the network: it must not wait.
        warn: Called with what is worth a warning.
    """

    def __init__(
        self,
        node: Node,
        selection: Selection,
        settings: RecordSettings,
        arrival: ArrivalType,
        on_topic: Callable[[RecordedTopic], object],
        warn: Callable[[str], object],
    ) -> None:
        self.topics: dict[str, RecordedTopic] = {}
        """Topics by name: a bag has one type for each."""
        self._node, self._selection, self._settings = node, selection, settings
        self._arrival, self._on_topic, self._warn = arrival, on_topic, warn
        self._clock = node.context.time.now
        self._lock = threading.RLock()
        self._handles: dict[str, list[Handle]] = {}
        self._following: list[Handle] = []
        self._other_types: set[tuple[str, str, str]] = set()
        self._leaves: dict[str, list[tuple[bytes, EndpointToken]]] = {}
        """Publishers of topics that nobody subscribes to, while those are to be left out."""
        self._closed = False

    def start(self) -> None:
        """Listen to what is there, and to what comes unless discovery is off."""
        self._hear_static()
        self._node.context.graph.endpoints(EndpointKind.PUBLISHER)  # waits until what was there before is known
        self.discover()
        if self._settings.no_discovery:
            self.stop_discovery()

    @property
    def discovers(self) -> bool:
        """True while it listens to topics that come, too."""
        return bool(self._following)

    def discover(self) -> None:
        """Listen to what is there, and to what comes; nothing if it does already."""
        if self._following or self._closed:
            return
        graph = self._node.context.graph
        if self._settings.include_unpublished or self._settings.ignore_leaf_topics:
            self._following.append(graph.follow(EVERY, EndpointKind.SUBSCRIPTION, self._on_subscription))
        self._following.append(graph.follow(EVERY, EndpointKind.PUBLISHER, self._on_publisher))

    def close(self) -> None:
        """End all subscriptions. Safe to call twice."""
        self.stop_discovery()
        with self._lock:
            self._closed = True
            handles = [each for handles in self._handles.values() for each in handles]
            self._handles.clear()
        for each in handles:
            each.close()

    def stop_discovery(self) -> None:
        """Listen to no topics but those that it knows. Safe to call twice."""
        for each in self._following:
            each.close()
        self._following.clear()

    def _hear_static(self) -> None:
        owner, session = self._node._owner_, self._node.context.transport.session_id
        for name, cls in self._settings.static_topics.items():
            kind = type_name(cls)
            if self._selection.takes(name, kind):
                token = EndpointToken(
                    self._node.context.get_domain_id(),
                    session,
                    owner.node_id,
                    "",
                    EndpointKind.PUBLISHER,
                    owner.enclave,
                    owner.namespace,
                    owner.node_name,
                    name,
                    kind,
                    type_hash(cls),
                    ALL_BEST_EFFORT,
                )
                with self._lock:
                    self._hear(None, token)

    def _on_publisher(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        if not alive or not self._selection.takes(token.name, token.type_name):
            return
        with self._lock:
            if self._settings.ignore_leaf_topics and not self._has_subscriptions(token.name):
                self._leaves.setdefault(token.name, []).append((gid, token))
            else:
                self._hear(gid, token)

    def _on_subscription(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        if not alive or self._is_own(token) or not self._selection.takes(token.name, token.type_name):
            return
        with self._lock:
            for waiting in self._leaves.pop(token.name, ()):
                self._hear(*waiting)
            if self._settings.include_unpublished and token.name not in self.topics:
                self._hear(None, token)

    def _has_subscriptions(self, name: str) -> bool:
        found = self._node.context.graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)
        return any(not self._is_own(each) for each in found)

    def _is_own(self, token: EndpointToken) -> bool:
        owner = self._node._owner_
        return (token.session, token.node_id) == (self._node.context.transport.session_id, owner.node_id)

    def _hear(self, gid: bytes | None, token: EndpointToken) -> None:
        """Listen to a publisher; without a gid, to whoever will publish to a subscription."""
        if self._closed:
            return
        topic = self.topics.get(token.name)
        is_new = topic is None
        if topic is None:
            topic = self.topics[token.name] = RecordedTopic(token, self._clock())
        elif not topic.token.understands(token):
            self._refuse(topic, token)
            return
        if gid is not None:
            topic.offered[gid] = token.qos
        if is_new:
            self._on_topic(topic)
        try:
            self._subscribe(topic, token)
        except TransportClosedError:  # the session ends just now
            return
        except RobolinkError as error:
            self._warn(f"cannot subscribe to topic '{token.name}': {error}")

    def _subscribe(self, topic: RecordedTopic, token: EndpointToken) -> None:
        """Listen to keys that are new; and listen anew where somebody latches what was not latched before."""
        profile = self._settings.qos_overrides.get(topic.name) or (LATCHED if topic.is_latched else ALL_BEST_EFFORT)
        keys = {each for each in keys_of(token) if topic.keys.get(each) != profile}
        if not keys:
            return
        before = [self._handles.pop(each) for each in keys if each in self._handles]
        topic.comes_twice |= bool(topic.keys)
        first = min(keys)
        self._handles[first] = listen(self._node._owner_, token, keys, profile, functools.partial(self._arrival, topic))
        topic.keys.update(dict.fromkeys(keys, profile))
        for handles in before:
            for each in handles:
                each.close()

    def _refuse(self, topic: RecordedTopic, token: EndpointToken) -> None:
        """Warn, once, of a second type of a topic."""
        other = (token.name, token.type_name, token.type_hash)
        if other in self._other_types:
            return
        self._other_types.add(other)
        same = token.type_name == topic.type_name and NO_HASH not in (token.type_hash, topic.token.type_hash)
        kind = f"another {token.type_name}" if same else token.type_name
        self._warn(
            f"topic '{token.name}' is recorded as {topic.type_name}: what {token.full_node_name} publishes there as"
            f" {kind} is left out"
        )
