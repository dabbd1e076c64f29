"""Readings: the DDS readers of one subscription, which feed one sink."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.dds.names import hash_in
from robolink.dds.nodes import Guids
from robolink.dds.profiles import announced, shortcomings
from robolink.dds.streams import Stream
from robolink.logging import get_logger
from robolink.qos import QoSProfile
from robolink.rtps import Endpoint, Info, Qos
from robolink.system import clocks, heap
from robolink.system.waits import fork_lock
from robolink.transport.base import Sink
from robolink.transport.history import Latch, latched_depth
from robolink.wire import NO_HASH, format_qos, pack_attachment

if TYPE_CHECKING:
    from robolink.dds.topics import Topics
    from robolink.rtps import Reader

_AS_REQUESTED, _RELIABLY, _AS_IT_COMES, _NOT_AT_ALL = "as requested", "reliably", "as it comes", "not at all"
_WITH_RETAINED = "with what it retains"
"""Ways by which a writer is read."""

_MOST_HELD = 100
"""Most writers whose samples are held for a sink that is still to come."""


class Reading:
    """Readers of one subscription: one that requests its profile, and others for the writers that offer less.

    DDS lets a reader and a writer that offers less never meet; over Zenoh they would, and the weaker policy hold. So
    such writers are read too, by a reader that requests no more than they offer, and a warning says what ROS 2 does.

    A subscription that is BEST_EFFORT and TRANSIENT_LOCAL, such as that of `bag record`, reads writers that offer both
    reliably: Fast DDS sends what it retains to RELIABLE readers only.
    """

    def __init__(self, topics: Topics, stream: Stream, qos: QoSProfile, gate: Sink | None = None) -> None:
        self.stream, self.profile = stream, format_qos(qos)
        self.has_token = False
        self.on_guids: Callable[[], object] = lambda: None
        """Function called when there is one more reader."""
        self._topics, self._gate = topics, gate
        self._lock = fork_lock()
        self._requested, self._depth = announced(qos), latched_depth(qos)
        self._held: dict[bytes, Latch[tuple[bytes, bytes]]] = {}
        self._others: dict[str, Reader] = {}
        """Readers of the writers that are read in another way than as requested, by that way."""
        self._sources: dict[bytes, str] = {}
        """Way by which each writer is read, by its GUID, as far as it has sent anything."""
        self._reader = self._make(self._requested, _AS_REQUESTED)

    def _make(self, qos: Qos, way: str) -> Reader:
        stream, sources = self.stream, self._sources

        def sink(payload: bytes, info: Info) -> None:
            # Each reader is matched with all writers that fit it, and acknowledges what comes: a RELIABLE writer that
            # keeps all would wait for one that does not. So it is here that a writer is read once.
            source = sources.get(info.writer) or self._find_source(info.writer)
            if source is way:
                self._on_sample(payload, info)

        return self._topics.participant.reader(stream.topic, stream.dds_type, qos, sink, user_data=stream.user_data)

    def _find_source(self, guid: bytes) -> str:
        writer = self._topics.writer_at(self.stream.place, guid)
        found = self._sources[guid] = _AS_REQUESTED if writer is None else self._way(writer)
        return found

    def _way(self, writer: Endpoint) -> str:
        """Return the way by which a writer is read: as requested, by another reader, or not."""
        if not self._has_hash(writer):
            return _NOT_AT_ALL
        requested = self._requested
        if not shortcomings(requested, writer.qos):
            is_stronger = requested.transient_local and writer.qos.reliable and not requested.reliable
            return _WITH_RETAINED if is_stronger else _AS_REQUESTED
        return _RELIABLY if writer.qos.reliable else _AS_IT_COMES

    def _has_hash(self, writer: Endpoint) -> bool:
        """Return whether a writer has the type of this hash; one that does not tell it is taken at its word."""
        announced_hash = hash_in(writer.user_data)
        return NO_HASH in (announced_hash, self.stream.type_hash) or announced_hash == self.stream.type_hash

    @property
    def is_free(self) -> bool:
        """True if no subscription has what comes here."""
        return self._gate is None or self._gate is _drop

    @property
    def guids(self) -> Guids:
        """GUIDs of the readers."""
        return Guids(readers=tuple(each.guid for each in self._readers))

    @property
    def _readers(self) -> list[Reader]:
        return [self._reader, *self._others.values()]

    def meet(self, writer: Endpoint) -> None:
        """Make the reader of a writer's way, if it is the first one of that way."""
        way = self._way(writer)
        if way in (_AS_REQUESTED, _NOT_AT_ALL) or way in self._others:
            return
        retains = way is _WITH_RETAINED
        qos = Qos(reliable=writer.qos.reliable, transient_local=retains, depth=self._requested.depth)
        self._others[way] = self._make(qos, way)
        self.on_guids()
        if not retains:
            self._warn(shortcomings(self._requested, writer.qos))

    def _warn(self, lacking: list[str]) -> None:
        warning = (
            f"{self.stream.name}: a publisher offers less {' and '.join(lacking)} than a subscription here requests:"
            " it is heard in robolink, but a subscription of ROS 2 would get nothing from it over DDS"
        )
        self._topics.post(lambda: get_logger("robolink.dds").warning(warning))

    def forget(self, writer: bytes) -> None:
        """Forget a writer that has gone."""
        self._sources.pop(writer, None)

    # What comes

    def _on_sample(self, payload: bytes, info: Info) -> None:
        gid = self._topics.gids.get(info.writer, info.writer)
        pair = payload, pack_attachment(info.number, info.timestamp or clocks.now(), gid)
        if len(payload) >= heap.LARGE:
            heap.note(len(payload))
        gate = self._gate
        if gate is None:
            self._hold(info.writer, pair)
        else:
            gate(pair)

    def _hold(self, writer: bytes, pair: tuple[bytes, bytes]) -> None:
        """Hold a latched sample for the subscription that is still to come."""
        with self._lock:
            if (gate := self._gate) is not None:
                gate(pair)
            elif self._requested.transient_local and (writer in self._held or len(self._held) < _MOST_HELD):
                self._held.setdefault(writer, Latch(self._depth)).retain(pair)

    def feed(self, gate: Sink) -> None:
        """Feed a sink from now on; with TRANSIENT_LOCAL first with what was held for it."""
        if self._gate is _drop and self._requested.transient_local:
            self._read_anew()
        with self._lock:
            held, self._held = self._held, {}
            for latch in held.values():
                for pair in latch.last():
                    gate(pair)
            self._gate = gate

    def _read_anew(self) -> None:
        """Replace the readers: what writers keep for late joiners comes once to each reader."""
        self._gate = None
        before = self._readers
        self._others = {}
        self._reader = self._make(self._requested, _AS_REQUESTED)
        for reader in before:
            reader.close()
        for writer in self._topics.writers_at(self.stream.place):
            self.meet(writer)
        self.on_guids()

    def starve(self) -> None:
        """Feed the sink no longer; without a token the readers go too."""
        self._gate = _drop
        if not self.has_token:
            self._close()

    def withdraw(self) -> None:
        """Withdraw the token; without a sink the readers go too."""
        self.has_token = False
        if self.is_free:
            self._close()

    def _close(self) -> None:
        self._topics.remove(self)
        for reader in self._readers:
            reader.close()


def _drop(_: object) -> None:
    """Take a sample that nobody wants any more."""
