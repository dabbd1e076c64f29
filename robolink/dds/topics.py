"""Topics over DDS: what this session publishes and subscribes to, each with its own writer or reader.

A publisher's writer comes with its token, and its outlet finds it by the gid in the attachment; a subscription's reader
comes with whichever is first, the subscription or its token. Within the session samples are handed over directly.
"""

from __future__ import annotations

import contextlib
import itertools
import struct
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.dds.hashes import Hashes
from robolink.dds.local_topics import LocalTopic
from robolink.dds.nodes import Guids
from robolink.dds.profiles import announced, shortcomings
from robolink.dds.readings import Reading
from robolink.dds.streams import Place, Stream, stream_of
from robolink.logging import get_logger
from robolink.qos import QoSProfile
from robolink.rtps import Endpoint
from robolink.rtps.ids import VENDOR_ROBOLINK
from robolink.system import heap
from robolink.system.waits import fork_lock
from robolink.transport import lifetime
from robolink.transport.base import Sink, refuse_giant
from robolink.transport.gates import close_gate, make_gate
from robolink.wire import NO_HASH, EndpointToken, format_qos, gid_in

if TYPE_CHECKING:
    from robolink.rtps import Participant, Writer

_STAMP_AT = 8
_stamp_in: Callable[[bytes, int], tuple[int]] = struct.Struct("<q").unpack_from
_ATTACHMENT_BYTES = 33

EndT = TypeVar("EndT")


class Topics:
    """Publishers and subscriptions of one session."""

    participant: Participant
    """Participant of the session, set once before anything is declared."""

    def __init__(
        self, gids: dict[bytes, bytes], hashes: Hashes, post: Callable[[Callable[[], object]], object]
    ) -> None:
        """Make it, without any.

        Args:
            gids: Global ids of others' endpoints by their GUIDs; one that is not there goes by its GUID.
            hashes: Table in which the hashes of the session's own types are noted.
            post: Function that has something done on another thread, since the participant's must not wait.
        """
        self.gids, self.hashes, self.post = gids, hashes, post
        self.lock = fork_lock()
        self.next_order = itertools.count().__next__
        self.why_closed = ""
        self.publications: dict[bytes, Publication] = {}
        """Announced publishers, by gid."""
        self._publications_at: dict[Place, list[Publication]] = {}
        self.changes = 0
        """Number of changes of `publications`."""
        self.writers: dict[Place, dict[bytes, Endpoint]] = {}
        """Writers of others, by topic and type."""
        self.listeners: dict[Place, dict[bytes, Endpoint]] = {}
        """Readers of others, by topic and type."""
        self.readings: dict[Place, list[Reading]] = {}
        self._local: weakref.WeakValueDictionary[str, LocalTopic] = weakref.WeakValueDictionary()
        """By key, while there is an outlet or a subscription: a bridge meets ever more names."""
        self._outlets: dict[DdsOutlet, None] = {}
        self._subscriptions: dict[DdsSubscription, None] = {}

    def writer_at(self, place: Place, guid: bytes) -> Endpoint | None:
        """Return the writer of this GUID."""
        return self.writers.get(place, {}).get(guid)

    # Declarations

    def advertise(self, key: str, qos: QoSProfile) -> DdsOutlet:
        """Declare a publisher."""
        stream = stream_of(key)
        with self._declaring(stream):
            outlet = DdsOutlet(self, stream, qos, self._local_topic(key))
            self._outlets[outlet] = None
            return outlet

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> DdsSubscription:
        """Declare a subscription."""
        stream, gate = stream_of(key), make_gate(sink)
        with self._declaring(stream):
            reading = None if self._is_second(stream) else self._feed(stream, qos, gate)
            subscription = DdsSubscription(self, self._local_topic(key), gate, reading)
            self._subscriptions[subscription] = None
            subscription.local.join(gate, qos)
            return subscription

    def announce_publisher(self, token: EndpointToken, stream: Stream, gid: bytes) -> Publication:
        """Make the writer of an announced publisher."""
        with self._declaring(stream):
            publication = Publication(self, stream, token.qos, gid)
            self.publications[gid] = publication
            self._publications_at.setdefault(stream.place, []).append(publication)
            self.changes += 1
            for endpoint in [*self.listeners.get(stream.place, {}).values()]:
                publication.meet(endpoint)
            return publication

    def announce_subscription(self, token: EndpointToken, stream: Stream) -> Reading:
        """Make the reader of an announced subscription, or take that of a subscription which has no token yet."""
        profile = format_qos(token.qos)
        with self._declaring(stream):
            for reading in self.readings.get(stream.place, ()):
                if not reading.has_token and (reading.stream, reading.profile) == (stream, profile):
                    break
            else:
                reading = self._read(stream, token.qos)
            reading.has_token = True
            return reading

    def _feed(self, stream: Stream, qos: QoSProfile, gate: Sink) -> Reading:
        """Return the reader of a new subscription: one of its kind that was announced before, or its own."""
        profile = format_qos(qos)
        for reading in self.readings.get(stream.place, ()):
            if reading.is_free and (reading.stream, reading.profile) == (stream, profile):
                reading.feed(gate)
                return reading
        return self._read(stream, qos, gate)

    def _read(self, stream: Stream, qos: QoSProfile, gate: Sink | None = None) -> Reading:
        reading = Reading(self, stream, qos, gate)
        self.readings.setdefault(stream.place, []).append(reading)
        for endpoint in self.writers_at(stream.place):
            reading.meet(endpoint)
        return reading

    def writers_at(self, place: Place) -> list[Endpoint]:
        """Return the writers of others with this topic and type."""
        return [*self.writers.get(place, {}).values()]

    def _is_second(self, stream: Stream) -> bool:
        """Return whether DDS has no such key: Lyrical's for buffers, and Humble's beside the one with a hash."""
        if stream.is_buffers:
            return True
        others = self.readings.get(stream.place, ())
        return stream.type_hash == NO_HASH and any(each.stream.type_hash != NO_HASH for each in others)

    @contextlib.contextmanager
    def _declaring(self, stream: Stream) -> Any:
        with self.lock:
            self.check()
            self.hashes.note(stream.type_name, stream.type_hash)
            yield

    def check(self) -> None:
        """Raise TransportClosedError once the session is closed."""
        if self.why_closed:
            raise lifetime.closed(self.why_closed)

    def _local_topic(self, key: str) -> LocalTopic:
        return self._local.setdefault(key, LocalTopic())

    # Others

    def on_endpoint(self, endpoint: Endpoint, came: bool) -> None:
        """Note an endpoint of another participant."""
        table = self.writers if endpoint.is_writer else self.listeners
        place = endpoint.topic, endpoint.type_name
        with self.lock:
            if came:
                table.setdefault(place, {})[endpoint.guid] = endpoint
                ends = self.readings if endpoint.is_writer else self._publications_at
                for each in ends.get(place, ()):
                    each.meet(endpoint)
            elif place in table:
                table[place].pop(endpoint.guid, None)
                for reading in self.readings.get(place, ()):
                    reading.forget(endpoint.guid)
                if not table[place]:
                    del table[place]

    # The end

    def remove(self, declared: DdsOutlet | DdsSubscription | Publication | Reading) -> None:
        """Forget what is closed."""
        with self.lock:
            if isinstance(declared, DdsOutlet):
                self._outlets.pop(declared, None)
            elif isinstance(declared, DdsSubscription):
                self._subscriptions.pop(declared, None)
            elif isinstance(declared, Publication):
                self.publications.pop(declared.gid, None)
                _remove(self._publications_at, declared.stream.place, declared)
                self.changes += 1
            else:
                _remove(self.readings, declared.stream.place, declared)

    def close(self, why: str) -> None:
        """Close everything; the participant is closed after it, so that nothing is undeclared one by one."""
        with self.lock:
            self.why_closed = why
            outlets, subscriptions = [*self._outlets], [*self._subscriptions]
        for outlet in outlets:
            outlet.shut()
        for subscription in subscriptions:
            subscription.shut()


class DdsOutlet:
    """A publisher."""

    def __init__(self, topics: Topics, stream: Stream, qos: QoSProfile, local: LocalTopic) -> None:
        self._topics, self._stream, self._qos, self._local = topics, stream, qos, local
        self._latch = local.add_latch(qos)
        self._gid: bytes | None = None
        self._changes = 0
        self._writer: Writer | None = None
        self._anonymous: Writer | None = None
        self._why_closed = ""

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send to every matching subscription.

        Raises TransportClosedError after close, TransportError for more than LARGEST_PAYLOAD bytes.
        """
        if self._why_closed:
            raise lifetime.closed(self._why_closed)
        if len(payload) >= heap.LARGE:
            refuse_giant(self._stream.key, payload)
            heap.note(len(payload))
        if self._latch is not None or self._local.sinks:
            self._local.put((payload, attachment), self._latch, self._topics.next_order)
        gid = gid_in(attachment)
        if gid != self._gid or self._changes != self._topics.changes:
            self._find_writer(gid)
        if (writer := self._writer) is not None:
            stamp = _stamp_in(attachment, _STAMP_AT)[0] if len(attachment) == _ATTACHMENT_BYTES else 0
            writer.put(payload, timestamp=stamp)

    def _find_writer(self, gid: bytes) -> None:
        """Find the writer of a sender: that of the publisher with this gid, or one without a node's name."""
        topics = self._topics
        with topics.lock:
            if self._why_closed:
                raise lifetime.closed(self._why_closed)
            publication = topics.publications.get(gid)
            if publication is None:
                # One whose publisher has just been withdrawn sends no more on DDS.
                is_over = gid == self._gid and self._writer is not self._anonymous
                self._writer = None if is_over else self._without_token()
            else:
                # Another key of the same publisher, Humble's, stands for nothing on DDS: all went out by the first.
                self._writer = publication.writer if publication.stream == self._stream else None
            self._gid, self._changes = gid, topics.changes

    def _without_token(self) -> Writer | None:
        if self._anonymous is None and not self._stream.is_buffers:
            stream = self._stream
            self._anonymous = self._topics.participant.writer(
                stream.topic, stream.dds_type, announced(self._qos), user_data=stream.user_data
            )
        return self._anonymous

    @property
    def matched(self) -> bool:
        """True if a subscription is known, here or elsewhere."""
        if self._why_closed:
            return False
        return bool(self._local.sinks) or self._stream.place in self._topics.listeners

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        self.shut("it has been closed")
        if (writer := self._anonymous) is not None:
            self._anonymous = None
            writer.close()
        self._topics.remove(self)

    def shut(self, why: str = "") -> None:
        """Send nothing any more."""
        self._why_closed = self._why_closed or (
            self._topics.why_closed or f"the publisher of {self._stream.key[:200]} is of no use any more: {why}"
        )
        self._writer = None
        if self._latch is not None:
            self._local.remove_latch(self._latch)


class DdsSubscription:
    """A subscription: its place among those of this session, and the reader that feeds it."""

    def __init__(self, topics: Topics, local: LocalTopic, gate: Sink, reading: Reading | None) -> None:
        self._topics, self.local, self._gate, self._reading = topics, local, gate, reading

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        self.shut()
        if (reading := self._reading) is not None:
            self._reading = None
            reading.starve()
        self._topics.remove(self)

    def shut(self) -> None:
        """Let nothing through any more."""
        self.local.leave(self._gate)
        close_gate(self._gate)


class Publication:
    """An announced publisher: its writer, which offers what the publisher does, as ROS 2 would."""

    on_guids: Callable[[], object]

    def __init__(self, topics: Topics, stream: Stream, qos: QoSProfile, gid: bytes) -> None:
        self.stream, self.gid, self._topics = stream, gid, topics
        self.writer = topics.participant.writer(
            stream.topic, stream.dds_type, announced(qos), user_data=stream.user_data
        )

        self._offered, self._has_warned = announced(qos), False

    @property
    def guids(self) -> Guids:
        """GUIDs of what it has on DDS."""
        return Guids(writers=(self.writer.guid,))

    def meet(self, reader: Endpoint) -> None:
        """Warn once of a subscription that requests more; one of robolink's hears of it all the same."""
        lacking = shortcomings(reader.qos, self._offered)
        if not lacking or self._has_warned or reader.vendor == VENDOR_ROBOLINK:
            return
        self._has_warned = True
        warning = (
            f"{self.stream.name}: a subscription of ROS 2 requests more {' and '.join(lacking)} than a publisher here"
            " offers: over DDS it gets nothing from it"
        )
        self._topics.post(lambda: get_logger("robolink.dds").warning(warning))

    def withdraw(self) -> None:
        """End the writer, with the token."""
        self._topics.remove(self)
        self.writer.close()


def _remove(table: dict[Place, list[EndT]], place: Place, end: EndT) -> None:
    there = table.get(place, [])
    if end in there:
        there.remove(end)
        if not there:
            del table[place]
