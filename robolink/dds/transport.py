"""Transport over DDS: one session is one RTPS participant, and the real ROS 2 sees its nodes as it sees its own.

Payloads pass unchanged. The attachment of what arrives is made of what DDS says: the number of the sample at its
writer, the time of its source, and the gid of its publisher's token. Tokens of others are made of what their
participants tell.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from robolink.dds import entities
from robolink.dds.graph import OtherNodes
from robolink.dds.hashes import Hashes
from robolink.dds.names import enclave_data
from robolink.dds.nodes import Guids, OwnNodes
from robolink.dds.services import Services
from robolink.dds.streams import Stream, stream_of
from robolink.dds.tokens import Tokens
from robolink.dds.topics import Topics
from robolink.dds.worker import Worker
from robolink.exceptions import TransportError, WireError
from robolink.qos import QoSProfile
from robolink.rtps import Endpoint, Info, Peer, Qos
from robolink.system import clocks
from robolink.transport import lifetime
from robolink.transport.base import Handle, Outlet, Query, Sample, Sink, Transport, make_sample
from robolink.wire import (
    DataKey,
    EndpointKind,
    EndpointToken,
    NodeToken,
    format_key,
    gid_of,
    pair_opener,
    parse_token,
)

if TYPE_CHECKING:
    from robolink.rtps import Participant

FIRST = 0.3
"""Time within which others answer a new participant's announcement, in seconds; it takes a few milliseconds."""

LATE = 1.2
"""Age until which a new session waits for a participant that is on this machine and has not answered, in seconds."""

PATIENCE = 0.5
"""Time without news after which participants that have not told all count as frozen, in seconds."""

LONGEST = 3.0
"""Timeout of the discovery, in seconds."""

_DISCOVERY_QOS = Qos(reliable=True, transient_local=True, depth=1)
_AFTER_FORK = "DDS does not survive a fork: start processes by 'spawn', or before the first session is opened"


class DdsTransport(Transport):
    """One session on a DDS domain."""

    threaded = True

    def __init__(
        self,
        open_participant: Callable[..., Participant],
        domain: int = 0,
        enclave: str = "/",
        count_here: Callable[[], int] = lambda: 0,
    ) -> None:
        """Open a session.

        Args:
            open_participant: Function that opens a participant: it takes the domain, and what `Participant` takes.
            domain: ROS domain id, 0 to 232.
            enclave: Enclave that others are told; it gives no rights.
            count_here: Function that counts the participants which hold ports on this machine, this one among them.

        Raises:
            TransportError: if the domain cannot be joined.
        """
        self.url = "dds://"
        self._domain = domain
        self._begin = clocks.monotonic()
        self._why_closed = ""
        self._count_here = count_here
        self._worker = Worker()
        self._tokens = Tokens(self._worker)
        self._hashes = Hashes(lambda name: self._worker.post(functools.partial(self._others.on_hash, name)))
        self._others = OtherNodes(domain, self._tokens, self._hashes)
        # Before the participant, which may tell of others at once.
        self._topics = Topics(self._others.gids, self._hashes, self._worker.post)
        self._services = Services(self._others.gids, self._hashes)
        try:
            self._participant = participant = open_participant(
                domain, user_data=enclave_data(enclave), on_peer=self._on_peer, on_endpoint=self._on_endpoint
            )
        except OSError as error:
            self._worker.close()
            raise TransportError(f"cannot join DDS domain {domain}: {error.strerror or error}") from None
        self.session_id = participant.guid[:12].hex()
        self._topics.participant = self._services.participant = participant
        writer = participant.writer(entities.TOPIC, entities.TYPE, _DISCOVERY_QOS)
        self._nodes = OwnNodes(participant.guid, writer.put, self._worker)
        participant.reader(entities.TOPIC, entities.TYPE, _DISCOVERY_QOS, self._on_entities)
        lifetime.watch_over(self, says_goodbye=True)

    # Declarations

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        """Declare a publisher; its token makes the writer, the first message if it has none."""
        return self._topics.advertise(key, qos)

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key`; with TRANSIENT_LOCAL what was retained comes first."""
        return self._topics.subscribe(key, qos, sink)

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key`."""
        return self._services.serve(key, sink)

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Send a request to all servers of `key`: `sink` gets each reply, then None.

        The end comes when each server has answered or is gone. One of another process that lives and does not answer
        leaves the call open, since DDS has no sign for that.
        """
        return self._services.call(key, payload, attachment, sink)

    def announce(self, token: str) -> Handle:
        """Declare a token; those of ROS 2's nodes and endpoints are what others see on DDS."""
        self._check()
        withdraw = self._announce_on_dds(token)
        self._tokens.add(token)
        return _Announced(self._tokens, token, withdraw)

    def _announce_on_dds(self, text: str) -> Callable[[], object]:
        """Show others what a token stands for; return the function that ends it."""
        try:
            token = parse_token(text)
        except WireError:  # DDS has nothing for it: only this session sees it
            return lambda: None
        if token.domain != self._domain:
            return lambda: None
        if isinstance(token, NodeToken):
            return functools.partial(self._nodes.remove, self._nodes.add_node(token))
        entity = self._entity(token, text)
        number = self._nodes.add(token, entity.guids)
        entity.on_guids = lambda: self._nodes.change(number, token, entity.guids)

        def withdraw() -> None:
            self._nodes.remove(number)
            entity.withdraw()

        return withdraw

    def _entity(self, token: EndpointToken, text: str) -> _Entity:
        stream = _stream(token)
        match token.kind:
            case EndpointKind.PUBLISHER:
                return self._topics.announce_publisher(token, stream, gid_of(text))
            case EndpointKind.SUBSCRIPTION:
                return self._topics.announce_subscription(token, stream)
            case EndpointKind.SERVICE:
                return self._services.announce_service(token, stream)
            case EndpointKind.CLIENT:
                return self._services.announce_client(token, stream, gid_of(text))

    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches, on a thread of the session's own."""
        self._check()
        return self._tokens.watch(pattern, on_change)

    def tokens(self, pattern: str) -> list[str]:
        """Return the tokens that match `pattern`, sorted.

        A new session waits for FIRST, and until all has been read that the others have to tell. Where more participants
        hold ports on this machine than it has met, it waits for LATE: on a busy one they take their time.
        """
        self._check()
        self._wait_for_all(self._begin + FIRST)
        if clocks.monotonic() - self._begin < LATE and (here := self._count_here() - 1) > 0:
            while len(self._participant.peers()) < here and clocks.monotonic() - self._begin < LATE:
                time.sleep(0.005)
            self._wait_for_all(clocks.monotonic())  # who comes late has as much time to tell as the first ones
        return self._tokens.matching(pattern)

    def _wait_for_all(self, since: float) -> None:
        """Wait until all has been read that is known to be there; from `since` on it may be that nothing more comes."""
        while (now := clocks.monotonic()) < self._begin + LONGEST:
            if now >= since and (self._is_settled() or now - max(self._worker.latest, since) > PATIENCE):
                return
            time.sleep(0.005)

    def _is_settled(self) -> bool:
        """Return whether all has been read, and has come through the worker."""
        participant, others = self._participant, self._others
        if not participant.settled() or not self._worker.catch_up(PATIENCE) or not others.is_complete:
            return False
        known = {each.guid for each in participant.endpoints()}
        return known == {*others.endpoints} and {each.prefix for each in participant.peers()} == {*others.peers}

    def peers(self) -> list[Peer]:
        """Return the other participants of the domain."""
        return self._participant.peers()

    # What the participant tells, on its thread

    def _on_peer(self, peer: Peer, came: bool) -> None:
        self._worker.post(functools.partial(self._others.on_peer, peer, came))
        self._services.on_peer(peer, came)

    def _on_endpoint(self, endpoint: Endpoint, came: bool) -> None:
        self._worker.post(functools.partial(self._others.on_endpoint, endpoint, came))
        self._topics.on_endpoint(endpoint, came)
        self._services.on_endpoint(endpoint, came)

    def _on_entities(self, payload: bytes, info: Info) -> None:
        def note() -> None:
            try:
                listed = entities.decode(payload)
            except WireError:  # nonsense of somebody's; what was good stays
                return
            if listed.guid[:12] == info.writer[:12]:  # a participant tells of itself only
                self._others.on_entities(listed)

        self._worker.post(note)

    # What arrives

    def read(self, arrived: Any) -> Sample:
        """Return the item, a plain pair, as a Sample."""
        return make_sample(arrived)

    def opener(self, check: Callable[[bytes], object], decode: Callable[[bytes], Any]) -> Callable[[Any], Any]:
        """Return a function that does `read`, `check` and `decode` to an item, without a call of `read`."""
        return pair_opener(check, decode)

    def accept(self, arrived: Any) -> Query:
        """Return the item itself: it is a Query already."""
        query: Query = arrived
        return query

    # The end

    def _check(self) -> None:
        if self._why_closed:
            raise lifetime.closed(self._why_closed)

    def close(self) -> None:
        """Leave the domain, and tell the others so. Safe to call twice."""
        if not self._end(f"session {self.session_id} of {self.url} has been closed"):
            return
        lifetime.forget(self)
        self._participant.close()

    def disown(self) -> None:
        """Refuse every further use: in a forked child the threads do not exist, and the parent goes on."""
        self._end(_AFTER_FORK)

    def _end(self, why: str) -> bool:
        if self._why_closed:
            return False
        self._why_closed = why
        self._topics.close(why)
        self._services.close(why)
        self._tokens.close()
        self._worker.close()
        return True


class _Entity(Protocol):
    """Endpoints of DDS that an endpoint's token has."""

    on_guids: Callable[[], object]
    """Function that is called when its GUIDs have changed."""

    @property
    def guids(self) -> Guids: ...

    def withdraw(self) -> None: ...


class _Announced:
    """Handle of a token of this session."""

    def __init__(self, tokens: Tokens, token: str, withdraw: Callable[[], object]) -> None:
        self._tokens, self._token = tokens, token
        self._withdraw: Callable[[], object] | None = withdraw

    def close(self) -> None:
        """Withdraw it. Safe to call twice."""
        withdraw, self._withdraw = self._withdraw, None
        if withdraw is not None:
            self._tokens.remove(self._token)
            withdraw()


def _stream(token: EndpointToken) -> Stream:
    return stream_of(format_key(DataKey(token.domain, token.name, token.type_name, token.type_hash)))
