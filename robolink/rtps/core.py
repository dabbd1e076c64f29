"""The participant without sockets, threads and clocks: it takes datagrams and the time, and gives datagrams and calls.

`receive` and `tick` take the time, in seconds of any steady clock. What is to be sent goes to a function. What a
program is to be told waits in `calls`, so that who holds a lock around this can release it first.
Source: RTPS 2.5, 8.2 and 8.3.4.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from robolink.rtps import ids
from robolink.rtps.announcements import EndpointData, ParticipantData
from robolink.rtps.discovery import Discovery, Remote, Resolve, fits, gone, greeting
from robolink.rtps.ids import RtpsError
from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.reader import Room, StatefulReader
from robolink.rtps.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    InfoDestination,
    InfoSource,
    InfoTimestamp,
    Inline,
    NackFrag,
    parse,
)
from robolink.rtps.types import Endpoint, Info, Peer, Qos
from robolink.rtps.writer import Send, StatefulWriter

Sink = Callable[[bytes, Info], object]
OnMatch = Callable[[Endpoint, bool], object]
Accepts = Callable[[Endpoint], bool]

MOST_MATCHES = 2_000
"""Endpoints of others that one of ours is matched with. Those beyond are left out: each costs time again and again."""

_EVERYBODY = bytes(ids.PREFIX_BYTES)
_DISCOVERY_WRITERS = {ids.PUBLICATIONS_WRITER, ids.SUBSCRIPTIONS_WRITER}


class LocalWriter(StatefulWriter):
    """A writer of a program."""

    def __init__(self, data: EndpointData, send: Send, accepts: Accepts | None, on_match: OnMatch | None) -> None:
        super().__init__(data.guid, data.qos, send)
        self.data, self.accepts, self.on_match = data, accepts, on_match


class LocalReader(StatefulReader):
    """A reader of a program."""

    def __init__(
        self,
        data: EndpointData,
        send: Send,
        deliver: Callable[[Buffer, Info], object],
        accepts: Accepts | None,
        on_match: OnMatch | None,
        room: Room,
    ) -> None:
        super().__init__(data.guid, data.qos, send, deliver, room)
        self.data, self.accepts, self.on_match = data, accepts, on_match


class Core:
    """A participant: its endpoints, those of others, and what goes between them."""

    def __init__(
        self,
        me: ParticipantData,
        network: Resolve,
        send: Send,
        *,
        on_peer: Callable[[Peer, bool], object] | None = None,
        on_endpoint: Callable[[Endpoint, bool], object] | None = None,
        epoch: int = 0,
    ) -> None:
        """Make a participant without endpoints, which nobody knows yet: the first `tick` announces it.

        Args:
            me: what it says of itself.
            network: what the network says of addresses.
            send: gets what is to be sent.
            on_peer: is called with other participants that came or went.
            on_endpoint: is called with their endpoints that came or went.
            epoch: nanoseconds since 1970 at which the time that it is told was 0.
        """
        self.prefix = me.prefix
        self.due = -math.inf
        """When `tick` is to be called: with anything that happens it may become earlier."""
        self.calls: list[tuple[Callable[[Any, Any], object], Any, Any]] = []
        """Calls of programs that are due: functions and their two arguments."""
        self.nonsense = 0
        """Datagrams that were not RTPS, or contradicted themselves."""
        self._me, self._send = me, send
        self._on_peer, self._on_endpoint = on_peer, on_endpoint
        self._room = Room()
        self._discovery = Discovery(me, network, send, self._peer_changed, self._remote_changed, self._room, epoch)
        self._writers: dict[bytes, StatefulWriter] = {}
        """By entity id."""
        self._readers_of: dict[bytes, list[StatefulReader]] = {}
        """Readers by the GUID of each writer with which they are matched."""
        self._local: dict[tuple[bool, str, str], dict[bytes, LocalWriter | LocalReader]] = {}
        """Endpoints of programs, by whether they are writers, topic and type; then by GUID."""
        self._busy: set[StatefulWriter | StatefulReader] = set()
        """Those that may have something due."""
        self._entities = 0
        self._now = 0.0
        for writer in self._discovery.writers.values():
            self._writers[writer.entity] = writer
        self._builtin = {
            ids.PUBLICATIONS_WRITER: [self._discovery.readers[True]],
            ids.SUBSCRIPTIONS_WRITER: [self._discovery.readers[False]],
        }
        """Readers of discovery by the entity id of those whom they read."""
        self._handlers: dict[type, Callable[[float, bytes, Any], object]] = {
            Heartbeat: self._on_heartbeat,
            AckNack: self._on_acknack,
            Gap: self._on_gap,
            NackFrag: self._on_nack_frag,
        }

    # Time

    def tick(self, now: float) -> float:
        """Do what is due: announcements, leases, heartbeats, requests. Returns when to call it again."""
        self._now = now
        for endpoint in [*self._busy]:
            endpoint.tick(now)
            if endpoint.due == math.inf:
                self._busy.discard(endpoint)
        due = self._discovery.tick(now)
        self.due = min((endpoint.due for endpoint in self._busy), default=due)
        self.due = min(self.due, due)
        return self.due

    def _arm(self, endpoint: StatefulWriter | StatefulReader) -> None:
        if endpoint.due < math.inf:
            self._busy.add(endpoint)
            self.due = min(self.due, endpoint.due)

    def _arm_discovery(self) -> None:
        for writer in self._discovery.writers.values():
            self._arm(writer)
        for reader in self._discovery.readers.values():
            self._arm(reader)
        self.due = min(self.due, self._discovery.due)

    # Endpoints of programs

    def add_writer(
        self,
        now: float,
        topic: str,
        type_name: str,
        qos: Qos,
        user_data: bytes = b"",
        accepts: Accepts | None = None,
        on_match: OnMatch | None = None,
    ) -> LocalWriter:
        """Make a writer, announce it, and match it with the readers that are known."""
        data = self._endpoint(ids.KEYLESS_WRITER, topic, type_name, qos, user_data)
        writer = LocalWriter(data, self._send, accepts, on_match)
        self._writers[writer.entity] = writer
        self._add(now, writer)
        return writer

    def add_reader(
        self,
        now: float,
        topic: str,
        type_name: str,
        qos: Qos,
        sink: Sink,
        user_data: bytes = b"",
        accepts: Accepts | None = None,
        on_match: OnMatch | None = None,
    ) -> LocalReader:
        """Make a reader, announce it, and match it with the writers that are known."""
        data = self._endpoint(ids.KEYLESS_READER, topic, type_name, qos, user_data)
        add = self.calls.append

        def deliver(payload: Buffer, info: Info) -> None:
            add((sink, payload, info))

        reader = LocalReader(data, self._send, deliver, accepts, on_match, self._room)
        self._add(now, reader)
        return reader

    def _endpoint(self, kind: int, topic: str, type_name: str, qos: Qos, user_data: bytes) -> EndpointData:
        self._entities += 1
        guid = self.prefix + self._entities.to_bytes(3, "big") + bytes([kind])
        is_writer = kind == ids.KEYLESS_WRITER
        return EndpointData(guid, is_writer, topic, type_name, qos, self._me.default, user_data)

    def _add(self, now: float, local: LocalWriter | LocalReader) -> None:
        data = local.data
        self._local.setdefault((data.is_writer, data.topic, data.type_name), {})[data.guid] = local
        self._discovery.publish(now, data)
        for remote in self._discovery.fitting(data.topic, data.type_name, is_writer=not data.is_writer):
            self._match(now, local, remote)
        self._arm_discovery()

    def remove(self, now: float, local: LocalWriter | LocalReader) -> None:
        """Withdraw an endpoint. Does nothing the second time."""
        data = local.data
        key = (data.is_writer, data.topic, data.type_name)
        if self._local.get(key, {}).pop(data.guid, None) is None:
            return
        if not self._local[key]:
            del self._local[key]
        if isinstance(local, LocalReader):
            for guid in [*local.writers]:
                self._unmatch(local, guid)
        else:
            del self._writers[local.entity]
            for guid in [*local.readers]:
                local.unmatch(guid)
        self._busy.discard(local)
        self._discovery.withdraw(now, data.guid, is_writer=data.is_writer)
        self._arm_discovery()

    def put(
        self,
        now: float,
        writer: StatefulWriter,
        payload: Buffer,
        related: tuple[bytes, int] | None = None,
        timestamp: int = 0,
    ) -> int:
        """Send a sample, and return its number."""
        number = writer.put(now, payload, Inline(related=related) if related else None, timestamp)
        if writer.due < math.inf:
            self._arm(writer)
        return number

    def expect(self, now: float, reader: StatefulReader) -> None:
        """See to it that a reader gets what it expects, though its writers may not say soon that they sent it."""
        reader.expect(now)
        self._arm(reader)

    def goodbye(self) -> None:
        """Announce to everybody that this participant is gone."""
        self._discovery.goodbye()

    def peers(self) -> list[Peer]:
        """Return the other participants."""
        return [state.peer for state in self._discovery.peers.values()]

    def endpoints(self) -> list[Endpoint]:
        """Return their endpoints."""
        return [remote.endpoint for remote in self._discovery.remotes.values()]

    def is_settled(self) -> bool:
        """Return whether all has been read that known participants announced to have."""
        return self._discovery.is_settled()

    # Matching

    def _match(self, now: float, local: LocalWriter | LocalReader, remote: Remote) -> None:
        endpoint = remote.endpoint
        qos = endpoint.qos
        if local.accepts is not None and not local.accepts(endpoint):
            return
        if isinstance(local, LocalWriter):
            # Topics with keys have other kinds; a sample without a key would be of no instance there.
            if endpoint.guid[-1] != ids.KEYLESS_READER or not fits(local.qos, qos):
                return
            if len(local.readers) >= MOST_MATCHES:
                return
            wants_old = qos.transient_local
            local.match(now, endpoint.guid, remote.address, remote.head, reliable=qos.reliable, wants_old=wants_old)
        else:
            if endpoint.guid[-1] != ids.KEYLESS_WRITER or not fits(qos, local.qos):
                return
            if len(local.writers) >= MOST_MATCHES:
                return
            base = greeting(endpoint.vendor)
            local.match(now, endpoint.guid, remote.address, remote.head, reliable=qos.reliable, base=base)
            self._readers_of.setdefault(endpoint.guid, []).append(local)
        self._arm(local)
        if local.on_match is not None:
            self.calls.append((local.on_match, endpoint, True))

    def _unmatch(self, local: LocalWriter | LocalReader, guid: bytes) -> bool:
        if not local.unmatch(guid):
            return False
        if isinstance(local, LocalReader):
            readers = self._readers_of[guid]
            readers.remove(local)
            if not readers:
                del self._readers_of[guid]
        return True

    def _peer_changed(self, peer: Peer, came: bool) -> None:
        if self._on_peer is not None:
            self.calls.append((self._on_peer, peer, came))

    def _remote_changed(self, remote: Remote, came: bool) -> None:
        endpoint = remote.endpoint
        # First the endpoint, then what it is matched with, and the other way round when it goes.
        if came and self._on_endpoint is not None:
            self.calls.append((self._on_endpoint, endpoint, True))
        local = self._local.get((not endpoint.is_writer, endpoint.topic, endpoint.type_name), {})
        for mine in [*local.values()]:
            if came:
                self._match(self._now, mine, remote)
            elif self._unmatch(mine, endpoint.guid) and mine.on_match is not None:
                self.calls.append((mine.on_match, endpoint, False))
        if not came and self._on_endpoint is not None:
            self.calls.append((self._on_endpoint, endpoint, False))

    # Receiving

    def receive(self, now: float, datagram: Buffer, source: Locator) -> None:
        """Take a datagram. Nonsense is counted, and otherwise nothing comes of it.

        Args:
            now: seconds.
            datagram: what came; it is not needed any more afterwards.
            source: the address it came from.
        """
        try:
            message = parse(datagram)
        except RtpsError:
            self.nonsense += 1
            return
        prefix, timestamp, is_ours = message.prefix, 0, True
        self._now = now
        self._heard(now, prefix)
        for part in message.submessages:
            if isinstance(part, InfoTimestamp):
                timestamp = part.timestamp
            elif isinstance(part, InfoDestination):
                is_ours = part.prefix in {self.prefix, _EVERYBODY}
            elif isinstance(part, InfoSource):
                prefix = part.prefix
            elif not is_ours or prefix == self.prefix:
                continue
            elif isinstance(part, Data):
                self._on_data(now, prefix, part, timestamp, source)
            elif isinstance(part, DataFrag):
                self._on_fragments(now, prefix, part, timestamp)
            elif (handler := self._handlers.get(type(part))) is not None:
                handler(now, prefix, part)

    def _heard(self, now: float, prefix: bytes) -> None:
        state = self._discovery.peers.get(prefix)
        if state is not None:
            state.heard = now

    def _on_data(self, now: float, prefix: bytes, data: Data, timestamp: int, source: Locator) -> None:
        if data.writer == ids.SPDP_WRITER:
            self._on_participant(now, prefix, data, source)
            return
        guid = prefix + data.writer
        readers = self._matched_readers(guid, data.reader)
        if not readers:
            return
        payload: Buffer | None = None
        if data.writer in _DISCOVERY_WRITERS:
            # What is gone takes its turn among what has come: an endpoint that goes must not come back by a repair.
            payload = gone(data)
        if payload is None and data.payload is not None and not data.is_key and not data.inline.status:
            payload = bytes(data.payload)
        info = Info(guid, data.number, timestamp, data.inline.related)
        for reader in readers:
            reader.on_data(now, guid, payload, info)
            self._arm(reader)

    def _on_participant(self, now: float, prefix: bytes, data: Data, source: Locator) -> None:
        try:
            self._discovery.on_participant(now, prefix, data, source)
        except RtpsError:
            self.nonsense += 1
        self._arm_discovery()

    def _on_fragments(self, now: float, prefix: bytes, fragments: DataFrag, timestamp: int) -> None:
        guid = prefix + fragments.writer
        info = Info(guid, fragments.number, timestamp, fragments.inline.related)
        for reader in self._matched_readers(guid, fragments.reader):
            reader.on_fragments(now, guid, fragments, info)
            self._arm(reader)

    def _on_heartbeat(self, now: float, prefix: bytes, beat: Heartbeat) -> None:
        guid = prefix + beat.writer
        for reader in self._matched_readers(guid, beat.reader):
            reader.on_heartbeat(now, guid, beat.first, beat.last, final=beat.final)
            self._arm(reader)

    def _on_gap(self, now: float, prefix: bytes, gap: Gap) -> None:
        guid = prefix + gap.writer
        for reader in self._matched_readers(guid, gap.reader):
            reader.on_gap(now, guid, gap.first, gap.base, gap.others)
            self._arm(reader)

    def _matched_readers(self, guid: bytes, entity: bytes) -> list[StatefulReader]:
        """Return the readers of a writer's samples that a submessage is for: one, or all that are matched with it."""
        readers = self._readers_of.get(guid) or self._builtin.get(guid[ids.PREFIX_BYTES :], [])
        return [reader for reader in readers if entity in {reader.entity, ids.UNKNOWN_ENTITY}]

    def _on_acknack(self, now: float, prefix: bytes, ack: AckNack) -> None:
        writer = self._writers.get(ack.writer)
        if writer is not None:
            _, _, base, missing, count, final = ack
            writer.on_acknack(now, prefix + ack.reader, base, missing, count, final=final)
            self._arm(writer)

    def _on_nack_frag(self, now: float, prefix: bytes, nack: NackFrag) -> None:
        writer = self._writers.get(nack.writer)
        if writer is not None:
            writer.on_nack_frag(now, prefix + nack.reader, nack.number, nack.missing)
            self._arm(writer)
