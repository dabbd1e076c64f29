"""Discovery: which participants and endpoints there are, for how long, and which fit together.

Participants announce themselves without reliability (SPDP); each then tells the others of its endpoints, reliably, by
four built-in endpoints (SEDP). Source: RTPS 2.5, 8.5; which QoS fit: DDS 1.4, 2.2.3.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from robolink.rtps import ids
from robolink.rtps.announcements import (
    MOST_ANNOUNCED,
    EndpointData,
    ParticipantData,
    encode_endpoint,
    encode_key,
    encode_participant,
    read_endpoint,
    read_key,
    read_participant,
)
from robolink.rtps.ids import RtpsError
from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.reader import Room, StatefulReader
from robolink.rtps.submessages import (
    Data,
    Inline,
    encode_data,
    encode_header,
    encode_info_destination,
    encode_inline,
)
from robolink.rtps.types import Endpoint, Info, Peer, Qos
from robolink.rtps.writer import Send, StatefulWriter

MOST_PEERS = 250
MOST_ENDPOINTS = 20_000
"""Of all other participants together. Those beyond are not met: nonsense must not fill the memory."""
LEASE = 20.0
"""Seconds after which others take us for gone: as Fast DDS has it."""

_SHORTEST_LEASE = 1.0
_SEARCH_EVERY, _BURST_EVERY, _BURST = 1.0, 0.1, 5
_ANSWER_EVERY = 0.02
"""Seconds between answers to the announcements of one who does not know that we know it."""
_RENEW_EVERY = 3.0
"""Seconds between announcements to those who know us: some six in a lease, as Fast DDS has it."""
_GONE = Inline(ids.STATUS_DISPOSED | ids.STATUS_UNREGISTERED)
_BUILTIN_QOS = Qos(reliable=True, transient_local=True, depth=0)
_UNLIMITED = 1 << 31


class Gone(bytes):
    """GUID of something that is gone: what takes a sample's place where its instance was disposed."""


class Resolve(NamedTuple):
    """Answers of the network about addresses."""

    search: Sequence[Locator]
    """Where participants may be that are not known yet."""
    choose: Callable[[Sequence[Locator], Locator], Locator | None]
    """The one of a participant's addresses at which it is reached, given where its announcement came from; None if it
    is not to be met."""


class PeerState:
    """State of another participant, as far as it is known."""

    __slots__ = ("answered", "default", "endpoints", "head", "heard", "metatraffic", "peer")

    def __init__(self, now: float, peer: Peer, metatraffic: Locator, default: Locator, head: bytes) -> None:
        self.peer, self.metatraffic, self.default, self.head = peer, metatraffic, default, head
        self.heard = self.answered = now
        self.endpoints: set[bytes] = set()


class Remote(NamedTuple):
    """Endpoint of another participant, and how to send to it."""

    endpoint: Endpoint
    address: Locator
    head: bytes
    """With which datagrams to it begin."""


def fits(offered: Qos, requested: Qos) -> bool:
    """Return whether a writer's QoS satisfies a reader's."""
    return (
        offered.reliable >= requested.reliable
        and offered.transient_local >= requested.transient_local
        and _shorter(offered.deadline, requested.deadline)
        and offered.liveliness >= requested.liveliness
        and _shorter(offered.lease, requested.lease)
    )


def _shorter(offered: float | None, requested: float | None) -> bool:
    return requested is None or (offered is not None and offered <= requested)


class Discovery:
    """Participants and endpoints of others, and the announcements of our own."""

    def __init__(
        self,
        me: ParticipantData,
        network: Resolve,
        send: Send,
        on_peer: Callable[[Peer, bool], object],
        on_remote: Callable[[Remote, bool], object],
        room: Room,
        epoch: int = 0,
    ) -> None:
        """Begin with nobody known.

        Args:
            me: our own announcement.
            network: what the network says of addresses.
            send: gets what is to be sent.
            on_peer: is called with a participant that came (again, if what it says of itself changed) or went.
            on_remote: the same for endpoints.
            room: what may wait at all readers of the participant.
            epoch: nanoseconds since 1970 at which `now` was 0.
        """
        self.peers: dict[bytes, PeerState] = {}
        self.remotes: dict[bytes, Remote] = {}
        self.due = -math.inf
        self.refused = 0
        """Participants and endpoints that were not met because there are too many."""
        self._me, self._network, self._send = me, network, send
        self._on_peer, self._on_remote, self._epoch = on_peer, on_remote, epoch
        self._header = encode_header(me.prefix)
        self._announcement = self._header + encode_data(ids.UNKNOWN_ENTITY, ids.SPDP_WRITER, 1, encode_participant(me))
        self._announced = 0
        self._search_at = self._renew_at = -math.inf
        self._by_topic: dict[tuple[bool, str, str], dict[bytes, Remote]] = {}
        self._at: dict[Locator, bytes] = {}
        """The participant at each address for discovery."""
        self._numbers: dict[bytes, int] = {}
        """Of the samples that announce our endpoints, by GUID."""
        publications = StatefulWriter(me.prefix + ids.PUBLICATIONS_WRITER, _BUILTIN_QOS, send, _UNLIMITED)
        subscriptions = StatefulWriter(me.prefix + ids.SUBSCRIPTIONS_WRITER, _BUILTIN_QOS, send, _UNLIMITED)
        self.writers = {True: publications, False: subscriptions}
        """Those that announce our writers (True) and readers."""
        self.readers = {
            is_writer: StatefulReader(me.prefix + entity, _BUILTIN_QOS, send, take, room, MOST_ANNOUNCED)
            for is_writer, entity, take in (
                (True, ids.PUBLICATIONS_READER, self._on_publication),
                (False, ids.SUBSCRIPTIONS_READER, self._on_subscription),
            )
        }
        self._now = 0.0

    # Participants

    def announce(self, now: float) -> None:
        """Announce ourselves where it is due: to those who know us, and where others may be."""
        if now >= self._renew_at:
            self._renew_at = now + _RENEW_EVERY
            for address in self._at:
                self._send(address, [self._announcement], 0.0)
        if now >= self._search_at:
            self._announced += 1
            self._search_at = now + (_BURST_EVERY if self._announced < _BURST else _SEARCH_EVERY)
            for address in self._network.search:
                prefix = self._at.get(address)
                if prefix is None or not self._is_known_to(prefix):
                    self._send(address, [self._announcement], 0.0)

    def _is_known_to(self, prefix: bytes) -> bool:
        """Return whether a participant has met us: then it has told what it has, or asked what we have.

        Fast DDS announces itself some milliseconds before it listens: what it gets in between is lost, and it would
        meet us only by our next announcement.
        """
        writer = self.readers[True].writers.get(prefix + ids.PUBLICATIONS_WRITER)
        reader = self.writers[True].readers.get(prefix + ids.PUBLICATIONS_READER)
        return (writer is not None and writer.is_known) or (reader is not None and reader.serial is not None)

    def goodbye(self) -> None:
        """Announce to everybody that we are gone."""
        inline = encode_inline(_GONE._replace(key_hash=self._me.prefix + ids.PARTICIPANT_ENTITY))
        key = encode_key(self._me.prefix + ids.PARTICIPANT_ENTITY)
        raw = encode_data(ids.UNKNOWN_ENTITY, ids.SPDP_WRITER, 2, key, inline, is_key=True)
        for state in self.peers.values():
            self._send(state.metatraffic, [self._header, raw], 0.0)

    def on_participant(self, now: float, prefix: bytes, data: Data, source: Locator) -> None:
        """Take an announcement of a participant.

        Raises:
            RtpsError: if it is nonsense.
        """
        if data.is_key or data.inline.status:
            self.lose(prefix)
            return
        if data.payload is None:
            return
        said = read_participant(data.payload)
        if said.prefix != prefix:
            raise RtpsError("an announcement of another participant than its sender")
        state = self.peers.get(prefix)
        if state is not None:
            peer = _peer(said, state.metatraffic)
            if peer != state.peer:
                state.peer = peer
                self._on_peer(peer, True)
            # Not each one: two that do not know that they are known would answer each other's answers without end.
            if now >= state.answered + _ANSWER_EVERY and not self._is_known_to(prefix):
                state.answered = now
                self._send(state.metatraffic, [self._announcement], 0.0)
        elif said.domain is None or said.domain == self._me.domain:
            self._meet(now, said, source)

    def _meet(self, now: float, said: ParticipantData, source: Locator) -> None:
        metatraffic = self._network.choose(said.metatraffic, source)
        if metatraffic is None:
            return
        before = self._at.get(metatraffic)
        if before is not None and said.vendor in {ids.VENDOR_EPROSIMA, ids.VENDOR_ROBOLINK}:
            # Only one process can have a port: the one before is gone without a word, and its lease need not run out.
            # (Participants of one process share a port with Cyclone.)
            self.lose(before)
        if len(self.peers) >= MOST_PEERS and not self._lose_a_silent_one():
            self.refused += 1
            return
        default = self._network.choose(said.default, source) or metatraffic
        head = self._header + encode_info_destination(said.prefix)
        peer = _peer(said, metatraffic)
        self.peers[said.prefix] = PeerState(now, peer, metatraffic, default, head)
        self._at[metatraffic] = said.prefix
        self.due = min(self.due, now + peer.lease)
        self._on_peer(peer, True)
        # It has to know us before it can use what follows.
        self._send(metatraffic, [self._announcement], 0.0)
        for is_writer, reader in ((True, ids.PUBLICATIONS_READER), (False, ids.SUBSCRIPTIONS_READER)):
            self.writers[is_writer].match(now, said.prefix + reader, metatraffic, head, reliable=True, wants_old=True)
        for is_writer, writer in ((True, ids.PUBLICATIONS_WRITER), (False, ids.SUBSCRIPTIONS_WRITER)):
            base = greeting(said.vendor)
            self.readers[is_writer].match(now, said.prefix + writer, metatraffic, head, reliable=True, base=base)

    def _lose_a_silent_one(self) -> bool:
        """Forget the first participant that has never said what it has; return whether there was one.

        So whoever announces thousands that do not exist keeps nobody out who does.
        """
        for prefix in self.peers:
            proxies = (reader.writers.get(prefix + reader.entity[:3] + b"\xc2") for reader in self.readers.values())
            if not any(proxy is not None and proxy.is_known for proxy in proxies):
                self.lose(prefix)
                return True
        return False

    def lose(self, prefix: bytes) -> None:
        """Forget a participant and all it has."""
        state = self.peers.pop(prefix, None)
        if state is None:
            return
        if self._at.get(state.metatraffic) == prefix:
            del self._at[state.metatraffic]
        for guid in list(state.endpoints):
            self._drop(guid)
        for is_writer, reader in ((True, ids.PUBLICATIONS_READER), (False, ids.SUBSCRIPTIONS_READER)):
            self.writers[is_writer].unmatch(prefix + reader)
        for is_writer, writer in ((True, ids.PUBLICATIONS_WRITER), (False, ids.SUBSCRIPTIONS_WRITER)):
            self.readers[is_writer].unmatch(prefix + writer)
        self._on_peer(state.peer, False)

    def tick(self, now: float) -> float:
        """Announce what is due, and forget those whose lease is over. Returns when to call it again."""
        self.announce(now)
        for prefix, state in list(self.peers.items()):
            if now >= state.heard + state.peer.lease:  # the very sum that is due: a difference may round to less
                self.lose(prefix)
        ends = (state.heard + state.peer.lease for state in self.peers.values())
        self.due = min(self._search_at, self._renew_at if self._at else math.inf, *ends)
        return self.due

    def is_settled(self) -> bool:
        """Return whether all has been read that known participants announced to have."""
        return all(proxy.is_read for reader in self.readers.values() for proxy in reader.writers.values())

    # Endpoints

    def publish(self, now: float, data: EndpointData) -> None:
        """Announce an endpoint of our own."""
        writer = self.writers[data.is_writer]
        self._numbers[data.guid] = writer.put(now, encode_endpoint(data), timestamp=self._stamp(now))

    def _stamp(self, now: float) -> int:
        """Return the source timestamp of a sample of discovery, which never goes back.

        Fast DDS (3.2) sorts what waits at its reader of all participants by it, and by the number within a participant.
        Without one, a sample that was lost and sent again went behind those of a second participant that had lost one,
        too: it was acknowledged and never read, and the endpoint that it announced was never met.
        """
        return self._epoch + int(now * 1e9)

    def withdraw(self, now: float, guid: bytes, *, is_writer: bool) -> None:
        """Announce that an endpoint of our own is gone."""
        writer = self.writers[is_writer]
        writer.discard(self._numbers.pop(guid))
        inline = _GONE._replace(key_hash=guid)
        writer.put(now, encode_key(guid), inline, self._stamp(now), is_key=True, is_stored=False)

    def fitting(self, topic: str, type_name: str, *, is_writer: bool) -> Iterable[Remote]:
        """Return others' writers, or readers, of a topic and type."""
        return list(self._by_topic.get((is_writer, topic, type_name), {}).values())

    def _on_publication(self, payload: Buffer, info: Info) -> None:
        self._on_endpoint(payload, info, is_writer=True)

    def _on_subscription(self, payload: Buffer, info: Info) -> None:
        self._on_endpoint(payload, info, is_writer=False)

    def _on_endpoint(self, payload: Buffer, info: Info, *, is_writer: bool) -> None:
        state = self.peers.get(info.writer[: ids.PREFIX_BYTES])
        if state is None:
            return
        if isinstance(payload, Gone):
            if payload in state.endpoints:
                self._drop(payload)
            return
        try:
            said = read_endpoint(payload, is_writer=is_writer)
        except RtpsError:
            return  # one that we do not understand; the others are not worse for it
        if said.guid[: ids.PREFIX_BYTES] != state.peer.prefix:
            return
        address = self._network.choose(said.locators, state.default) or state.default
        peer = state.peer
        endpoint = Endpoint(said.guid, is_writer, said.topic, said.type_name, said.qos, said.user_data, peer.vendor)
        remote = Remote(endpoint, address, state.head)
        known = self.remotes.get(said.guid)
        if known == remote:
            return
        if known is not None:  # it changed its QoS or its user data
            self._drop(said.guid)
        if len(self.remotes) >= MOST_ENDPOINTS:
            self.refused += 1
            return
        self.remotes[said.guid] = remote
        state.endpoints.add(said.guid)
        self._by_topic.setdefault((is_writer, said.topic, said.type_name), {})[said.guid] = remote
        self._on_remote(remote, True)

    def _drop(self, guid: bytes) -> None:
        remote = self.remotes.pop(bytes(guid), None)
        if remote is None:
            return
        endpoint = remote.endpoint
        state = self.peers.get(guid[: ids.PREFIX_BYTES])
        if state is not None:
            state.endpoints.discard(endpoint.guid)
        key = (endpoint.is_writer, endpoint.topic, endpoint.type_name)
        of_topic = self._by_topic[key]
        del of_topic[endpoint.guid]
        if not of_topic:
            del self._by_topic[key]
        self._on_remote(remote, False)


def gone(data: Data) -> Gone | None:
    """Return the GUID that a sample of discovery says is gone; None if it does not say so."""
    if not data.is_key and not data.inline.status:
        return None
    if data.inline.key_hash is not None:
        return Gone(data.inline.key_hash)
    try:
        return Gone(read_key(data.payload or b""))
    except RtpsError:
        return None


def greeting(vendor: bytes) -> int:
    """Return the base of the ACKNACK by which a reader that has heard nothing asks a writer of a vendor.

    Only 0 is answered at once by Fast DDS: 1 restarts its timer of 3 s instead. Cyclone logs 0 as malformed.
    """
    return 0 if vendor == ids.VENDOR_EPROSIMA else 1


def _peer(said: ParticipantData, address: Locator) -> Peer:
    # A lease of nothing would let it come and go with each of its announcements.
    lease = max(said.lease, _SHORTEST_LEASE)
    return Peer(said.prefix, said.vendor, said.name, said.user_data, lease, address)
