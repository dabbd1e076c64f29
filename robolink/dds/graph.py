"""Graph of the other participants of a DDS domain, as tokens: what SEDP tells of endpoints, joined with who owns them.

Which node an endpoint belongs to comes on ros_discovery_info, before or after SEDP: a token is announced when both are
there. All is called on the worker's thread.
"""

from __future__ import annotations

import itertools
from collections import Counter
from typing import NamedTuple

from robolink.dds.entities import ParticipantEntities
from robolink.dds.hashes import Hashes
from robolink.dds.names import BARE_NODE, Role, RosName, enclave_in, hash_in, ros_name
from robolink.dds.profiles import profile_of
from robolink.dds.tokens import Tokens
from robolink.exceptions import WireError
from robolink.rtps import Endpoint, Peer
from robolink.wire import (
    NO_HASH,
    RUNNING,
    BridgeToken,
    EndpointKind,
    EndpointToken,
    NodeToken,
    format_bridge,
    format_token,
    gid_of,
    mark_in,
)

Pair = tuple[bytes, str, str, bool]
"""Half of a service: the participant, the service's name and type, and True for writers."""


class _Node(NamedTuple):
    token: NodeToken
    text: str


class _Known(NamedTuple):
    """An endpoint, and what it stands for in ROS 2."""

    endpoint: Endpoint
    meaning: RosName

    @property
    def pair(self) -> Pair:
        return self.endpoint.guid[:12], self.meaning.name, self.meaning.type_name, self.endpoint.is_writer

    @property
    def counterpart(self) -> Pair:
        """The other half of the service: a server reads requests and writes replies, a client the other way."""
        prefix, name, type_name, is_writer = self.pair
        return prefix, name, type_name, not is_writer


class OtherNodes:
    """Nodes and endpoints of the other participants."""

    def __init__(self, domain: int, tokens: Tokens, hashes: Hashes) -> None:
        self._domain, self._tokens, self._hashes = domain, tokens, hashes
        self.gids: dict[bytes, bytes] = {}
        """Global id of each endpoint that has a token, by its GUID; read by other threads."""
        self.peers: dict[bytes, Peer] = {}
        self.endpoints: dict[bytes, Endpoint] = {}
        self.reported: set[bytes] = set()
        """Prefixes of the participants that have told their nodes."""
        self._known: dict[bytes, _Known] = {}
        self._requests: dict[Pair, set[bytes]] = {}
        self._replies: dict[Pair, set[bytes]] = {}
        self._nodes: dict[bytes, dict[tuple[str, str, int], _Node]] = {}
        self._owners: dict[bytes, dict[bytes, _Node]] = {}
        self._shown: dict[bytes, str] = {}
        self._numbers = itertools.count(1)
        self._bridges: dict[bytes, str] = {}
        """Tokens of the bridges among the participants, by their prefixes."""

    @property
    def is_complete(self) -> bool:
        """True if each participant of ROS 2 has told its nodes."""
        return all(prefix in self.reported for prefix, peer in [*self.peers.items()] if enclave_in(peer.user_data))

    # What participants tell

    def on_peer(self, peer: Peer, came: bool) -> None:
        """Note a participant; with it goes all that it had."""
        self._note_bridge(peer, came)
        if came:
            self.peers[peer.prefix] = peer
            return
        for endpoint in [each for each in self.endpoints.values() if each.guid[:12] == peer.prefix]:
            self.on_endpoint(endpoint, False)
        self.on_entities(ParticipantEntities(peer.prefix, ()))
        self.peers.pop(peer.prefix, None)
        for table in (self._owners, self._nodes):
            table.pop(peer.prefix, None)
        self.reported.discard(peer.prefix)

    def _note_bridge(self, peer: Peer, came: bool) -> None:
        """Announce a bridge, whose participant is marked: what it has came through it."""
        if before := self._bridges.pop(peer.prefix, ""):
            self._tokens.remove(before)
        if came and (mark := mark_in(peer.user_data)) is not None:
            token = BridgeToken(self._domain, peer.prefix.hex(), "zenoh", mark.host, RUNNING, mark.mark)
            self._bridges[peer.prefix] = text = format_bridge(token)
            self._tokens.add(text)

    def on_endpoint(self, endpoint: Endpoint, came: bool) -> None:
        """Note an endpoint of another participant."""
        guid = endpoint.guid
        if came:
            self.endpoints[guid] = endpoint
        else:
            self.endpoints.pop(guid, None)
        meaning = ros_name(endpoint.topic, endpoint.type_name)
        if meaning is None:
            return
        known = _Known(endpoint, meaning)
        if came:
            self._known[guid] = known
        else:
            self._known.pop(guid, None)
        if meaning.role is Role.REPLY:
            _note(self._replies, known.pair, guid, came)
            for each in [*self._requests.get(known.counterpart, ())]:
                self._refresh(each)
            return
        if meaning.role is Role.REQUEST:
            _note(self._requests, known.pair, guid, came)
        self._refresh(guid)

    def on_entities(self, entities: ParticipantEntities) -> None:
        """Note the nodes of a participant, and what belongs to which."""
        prefix = entities.guid[:12]
        if prefix not in self.peers:  # it has gone meanwhile
            return
        self.reported.add(prefix)
        left, nodes = self._nodes.get(prefix, {}), dict[tuple[str, str, int], _Node]()
        owners, namesakes = dict[bytes, _Node](), Counter[tuple[str, str]]()
        for each in entities.nodes:
            name = (each.namespace, each.name)
            node = left.pop((each.namespace, each.name, namesakes[name]), None) or self._make_node(prefix, *name)
            if node is None:
                continue
            nodes[each.namespace, each.name, namesakes[name]] = node
            namesakes[name] += 1
            owners.update((guid, node) for guid in (*each.readers, *each.writers) if guid[:12] == prefix)
        before = self._owners.get(prefix, {})
        self._nodes[prefix], self._owners[prefix] = nodes, owners
        for guid in before | owners:
            if before.get(guid) is not owners.get(guid):
                self._refresh(guid)
        for node in left.values():
            self._tokens.remove(node.text)

    def on_hash(self, type_name: str) -> None:
        """Announce anew what has this type, now that its hash is known."""
        for guid, known in [*self._known.items()]:
            if known.meaning.type_name == type_name:
                self._refresh(guid)

    # What comes of it

    def _make_node(self, prefix: bytes, namespace: str, name: str) -> _Node | None:
        enclave = enclave_in(self.peers[prefix].user_data) or "/"
        token = NodeToken(self._domain, prefix.hex(), str(next(self._numbers)), enclave, namespace, name)
        try:
            text = format_token(token)
        except WireError:  # not a name of ROS 2
            return None
        self._tokens.add(text)
        return _Node(token, text)

    def _refresh(self, guid: bytes) -> None:
        """Announce the token of an endpoint, withdraw it, or replace it, as things are now."""
        before, text = self._shown.get(guid, ""), self._text(guid)
        if text == before:
            return
        if before:
            del self._shown[guid], self.gids[guid]
            self._tokens.remove(before)
        if text:
            self._shown[guid], self.gids[guid] = text, gid_of(text)
            self._tokens.add(text)

    def _text(self, guid: bytes) -> str:
        """Return the token of an endpoint; "" while it has none."""
        known = self._known.get(guid)
        if known is None or known.meaning.role is Role.REPLY:
            return ""
        if known.meaning.role is Role.REQUEST and not self._replies.get(known.counterpart):
            return ""
        owner = self._owner(guid)
        if owner is None:
            return ""
        endpoint, meaning = known
        try:
            return format_token(
                EndpointToken(
                    self._domain,
                    owner.session,
                    owner.node_id,
                    guid[12:].hex(),
                    _kind(meaning.role, endpoint.is_writer),
                    owner.enclave,
                    owner.namespace,
                    owner.node_name,
                    meaning.name,
                    meaning.type_name,
                    self._hash(known),
                    profile_of(endpoint.qos),
                )
            )
        except WireError:  # a topic that has no name of ROS 2
            return ""

    def _owner(self, guid: bytes) -> NodeToken | None:
        prefix = guid[:12]
        node = self._owners.get(prefix, {}).get(guid)
        if node is not None:
            return node.token
        peer = self.peers.get(prefix)
        if peer is None or enclave_in(peer.user_data) is not None:
            return None
        return NodeToken(self._domain, prefix.hex(), "0", "/", "/", BARE_NODE)

    def _hash(self, known: _Known) -> str:
        announced = NO_HASH if known.meaning.role is Role.REQUEST else hash_in(known.endpoint.user_data)
        return self._hashes.of(known.meaning.type_name) if announced == NO_HASH else announced


def _kind(role: Role, is_writer: bool) -> EndpointKind:
    if role is Role.TOPIC:
        return EndpointKind.PUBLISHER if is_writer else EndpointKind.SUBSCRIPTION
    return EndpointKind.CLIENT if is_writer else EndpointKind.SERVICE


def _note(table: dict[Pair, set[bytes]], pair: Pair, guid: bytes, came: bool) -> None:
    if came:
        table.setdefault(pair, set()).add(guid)
    elif pair in table:
        table[pair].discard(guid)
        if not table[pair]:
            del table[pair]
