"""Recorder of the last messages of every topic of a system, as bytes, for the text of a failure.

A message is decoded only when it is shown, and nobody in the system sees that there is a listener.
"""

from __future__ import annotations

import itertools
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any, NamedTuple

from robolink.exceptions import WireError
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport import Handle, Sample, Transport
from robolink.wire import (
    DataKey,
    EndpointKind,
    EndpointToken,
    format_key,
    gid_of,
    graph_pattern,
    pack_attachment,
    parse_token,
    unpack_attachment,
)

RETAINED = 20
"""Count of messages retained of each topic."""

_GID = bytes(16)
"""Of the calls: they are nobody's in the graph."""

_LATCHED = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Recorded(NamedTuple):
    """A recorded message: the system's time in ns, the raw sample, and its number among all messages."""

    time_ns: int
    arrived: Any
    number: int


class Topic:
    """One topic of one type, with its last messages."""

    def __init__(self, token: EndpointToken) -> None:
        self.token, self.name = token, token.name
        self.type_name, self.type_hash = token.type_name, token.type_hash
        self.key = format_key(DataKey(token.domain, token.name, token.type_name, token.type_hash))
        self.count = 0
        self.retained: deque[Recorded] = deque(maxlen=RETAINED)


class Recorder:
    """Recorder of all messages on a domain, from the moment when their publisher is announced.

    `transport` is a session of its own, `now` returns the time in ns that each message is noted with. `on_first` is
    called with each topic when its first message comes.
    """

    def __init__(
        self,
        transport: Transport,
        domain: int,
        now: Callable[[], int],
        on_first: Callable[[Topic], object] = lambda topic: None,
    ) -> None:
        self.topics: dict[str, Topic] = {}
        """Topics by key: two publishers of one topic may differ in type."""
        self._transport, self._now, self._on_first = transport, now, on_first
        self._senders: dict[bytes, str] = {}
        self._numbers = itertools.count()
        self._queues: list[TopicQueue] = []
        self._followers: list[Callable[[Topic], object]] = []
        self._calls: list[Handle] = []
        self._lock = threading.RLock()  # over Zenoh, news of publishers come on a thread of its own
        transport.watch(graph_pattern(domain), self._on_token)

    def named(self, name: str) -> list[Topic]:
        """Return the topics of this name: none, one, or as many as there are types."""
        with self._lock:
            return [each for each in self.topics.values() if each.name == name]

    def listen(self, name: str) -> TopicQueue:
        """Start a queue of what is published on a topic, now or later; what publishers keep for late ones is first."""
        queue = TopicQueue(name, self._transport)
        with self._lock:
            self._queues.append(queue)
            for topic in self.named(name):
                queue.hear(topic)
        return queue

    @contextmanager
    def listening(self, name: str) -> Iterator[TopicQueue]:
        """Listen for as long as a `with` lasts."""
        queue = self.listen(name)
        try:
            yield queue
        finally:
            with self._lock:
                self._queues.remove(queue)
            queue.close()

    def now(self) -> int:
        """Return a number that is above those of all that was heard so far, and below those of what comes."""
        return next(self._numbers)

    def since(self, name: str, number: int, *, but: str, seen: set[int]) -> list[tuple[Topic, Sample]]:
        """List what is still retained of a topic from this number on, in the order in which it was heard.

        What the node `but` has published is left out, and what has a number that is `seen`; all others are added to it.
        """
        retained = [
            (each, topic)
            for topic in self.named(name)
            for each in topic.retained.copy()
            if each.number >= number and each.number not in seen
        ]
        retained.sort(key=lambda one: one[0].number)
        seen.update(each.number for each, _ in retained)
        found = [(topic, self.sample(each)) for each, topic in retained]
        return [each for each in found if self.sender(each[1]) != but]

    def after(self, name: str, sample: Sample) -> int:
        """Return the number from which on all was heard later than this sample."""
        retained = [each for topic in self.named(name) for each in topic.retained.copy()] if sample.attachment else []
        numbers = (each.number for each in retained if self.sample(each).attachment == sample.attachment)
        return next(numbers, next(self._numbers)) + 1

    def follow_topics(self, follower: Callable[[Topic], object]) -> None:
        """Call `follower(topic)` for each topic that there is, and for each that comes."""
        with self._lock:
            self._followers.append(follower)
            for topic in self.topics.values():
                follower(topic)

    def hear(self, topic: Topic, callback: Callable[[bytes], object]) -> None:
        """Call `callback(payload)` with all that is published on a topic from now on, where it is published."""
        read = self._transport.read
        self._transport.subscribe(topic.key, _LATCHED, lambda arrived: callback(read(arrived).payload))

    def ask(self, key: str, payload: bytes) -> threading.Event:
        """Call a service; return an event that is set once all answers are there.

        The call leaves behind the subscriptions so far, on the same way: whoever answers knows them.
        """
        answered = threading.Event()

        def take(reply: Any) -> None:
            if reply is None:
                answered.set()

        attachment = pack_attachment(len(self._calls) + 1, self._now(), _GID)
        self._calls.append(self._transport.call(key, payload, attachment, take))
        return answered

    def arrivals(self, topic: Topic, sink: Callable[[Any], object]) -> None:
        """Call `sink` with all that arrives on a topic from now on, where it is published; `sample_of` reads it."""
        self._transport.subscribe(topic.key, _LATCHED, sink)

    def sample_of(self, arrived: Any) -> Sample:
        """Return the sample of an arrival."""
        return self._transport.read(arrived)

    def sample(self, heard: Recorded) -> Sample:
        """Return the bytes of a recorded message."""
        return self._transport.read(heard.arrived)

    def sender(self, sample: Sample) -> str:
        """Return the full name of the node that published a sample; '' if it is unknown."""
        with suppress(WireError):
            return self._senders.get(unpack_attachment(sample.attachment).gid, "")
        return ""

    def close(self) -> None:
        """Leave the network."""
        self._transport.close()

    def _on_token(self, text: str, alive: bool) -> bool:
        try:
            token = parse_token(text)
        except WireError:
            return False
        if alive and isinstance(token, EndpointToken) and token.kind is EndpointKind.PUBLISHER:
            self._senders[gid_of(text)] = token.full_node_name
            with self._lock:
                topic = Topic(token)
                if topic.key not in self.topics:
                    self.topics[topic.key] = topic
                    self._record(topic)
        return True

    def _record(self, topic: Topic) -> None:
        now, number, keep = self._now, self._numbers.__next__, topic.retained.append

        def note(arrived: Any) -> None:
            if not topic.count:
                self._on_first(topic)
            topic.count += 1
            keep(Recorded(now(), arrived, number()))

        self._transport.subscribe(topic.key, _LATCHED, note)
        for queue in self._queues:
            if queue.name == topic.name:
                queue.hear(topic)
        for follower in self._followers:
            follower(topic)


class TopicQueue:
    """Queue of the messages of one topic from now on, until they are taken."""

    def __init__(self, name: str, transport: Transport) -> None:
        self.name = name
        self._transport = transport
        self._arrived: deque[tuple[Topic, Any]] = deque()
        self._handles: list[Handle] = []

    def hear(self, topic: Topic) -> None:
        """Subscribe to the topic in this type, too."""
        put = self._arrived.append
        self._handles.append(self._transport.subscribe(topic.key, _LATCHED, lambda arrived: put((topic, arrived))))

    def take(self) -> list[tuple[Topic, Sample]]:
        """Return the samples that have come since the last call, in its order."""
        taken = []
        while self._arrived:
            topic, arrived = self._arrived.popleft()
            taken.append((topic, self._transport.read(arrived)))
        return taken

    def close(self) -> None:
        """Close the subscriptions."""
        for each in self._handles:
            each.close()
