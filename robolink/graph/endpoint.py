"""Endpoint: a publisher, subscription, service or client on the wire, with its keys, its token and its matches."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from robolink.exceptions import RobolinkError, TransportClosedError
from robolink.graph.type_mismatch import Disagreements
from robolink.logging import get_logger
from robolink.message import import_numpy_for, type_hash, type_name
from robolink.message.description import has_buffer_fields
from robolink.qos import QoSProfile
from robolink.running.ports import ContextLike
from robolink.transport.base import Handle
from robolink.wire import (
    CPU_BACKEND,
    NO_HASH,
    OTHER_END,
    DataKey,
    EndpointKind,
    EndpointToken,
    attachments,
    buffer_key,
    format_key,
    format_token,
    gid_of,
)

if TYPE_CHECKING:
    from robolink.graph.graph import Graph


class GraphContext(ContextLike, Protocol):
    """Context as seen by an endpoint: it has a graph."""

    @property
    def graph(self) -> Graph:
        """Graph of the nodes, topics and services that are announced on this domain."""


class Owner(NamedTuple):
    """The node that an endpoint belongs to, as tokens name it."""

    context: GraphContext
    node_id: str
    enclave: str
    namespace: str
    node_name: str
    disagreements: Disagreements


class Endpoint:
    """Publisher, subscription, service or client on the wire: its keys, its token, its matches, the id it sends by.

    It is announced once everything behind it is there: a peer that sees it may publish or call at once.
    """

    def __init__(self, owner: Owner, kind: EndpointKind, name: str, ros_type: type[Any], qos: QoSProfile) -> None:
        self.owner, self.context, self.name, self.qos = owner, owner.context, name, qos
        self.domain_id = owner.context.get_domain_id()
        import_numpy_for(ros_type)
        self.type_name = type_name(ros_type)
        self.type_hash = NO_HASH if owner.context.speaks_humble else type_hash(ros_type)
        self.key = format_key(DataKey(self.domain_id, name, self.type_name, self.type_hash))
        has_buffers = kind is EndpointKind.SUBSCRIPTION and self.type_hash != NO_HASH and has_buffer_fields(ros_type)
        self.buffer_key = buffer_key(self.key) if has_buffers else ""
        """Key on which Lyrical's publishers may send to this subscription instead; "" where they do not."""
        self.transport = owner.context.transport
        self.token = self._make_token(kind, CPU_BACKEND if has_buffers else "")
        self._text = format_token(self.token)
        self.gid = gid_of(self._text)
        self.attachment = attachments(self.gid, owner.context.time.now)
        """Function that makes the attachment of the next thing that is sent from here."""
        self.others: dict[bytes, EndpointToken] = {}
        """Matching endpoints by their gids, as far as they are known."""
        self.on_disagreement: Callable[[], object] | None = None
        """Function called for each endpoint that comes with another type."""
        self.warns = True
        """True if the node logs a warning about such an endpoint."""
        self.on_other: Callable[[bool], object] = lambda came: None
        """Function called for each matching endpoint: True if it came, False if it went."""
        self.speak_humble: Callable[[str], object] = lambda key: None
        """Function called once, with the second key, when a Humble peer matches; for a service, when there is any."""
        self.humble_key = self.key if self.type_hash == NO_HASH else ""
        """Key that Humble peers use, once there has been one."""
        self._disagreements = owner.disagreements
        self._following: tuple[Handle, ...] = ()
        self._announced: Handle | None = None

    def _make_token(self, kind: EndpointKind, more: str) -> EndpointToken:
        owner = self.owner
        return EndpointToken(
            self.domain_id,
            self.transport.session_id,
            owner.node_id,
            owner.context.next_id(),
            kind,
            owner.enclave,
            owner.namespace,
            owner.node_name,
            self.name,
            self.type_name,
            self.type_hash,
            self.qos,
            more,
        )

    def announce(self) -> None:
        """Follow the matching endpoints, and announce this one."""
        graph = self.context.graph
        if self.token.kind is EndpointKind.SERVICE and not self.humble_key:
            # Before a Humble client of it comes: Humble calls as soon as it sees a server, and waits for ever then.
            self._following = (graph.follow_first_humble(self._on_humble),)
        self._following += (graph.follow(self.name, OTHER_END[self.token.kind], self._on_other_end),)
        self._announced = graph.announce(self.token, self._text)

    def count_others(self) -> int:
        """Return the number of matching endpoints; Humble peers count once their key is in use."""
        found = self.context.graph.gids(OTHER_END[self.token.kind], self.name)
        return sum(
            self.token.understands(other) and (other.type_hash == self.type_hash or gid in self.others)
            for gid, other in found
        )

    def _on_other_end(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        """Note, on any thread, an endpoint at the other end of this name."""
        if not alive:
            if self.others.pop(gid, None) is not None:
                self.on_other(False)
        elif self.token.understands(token):
            self._meet(token)
            self.others[gid] = token
            self.on_other(True)
        else:
            if self.warns:
                self._disagreements.tell(self.token, token)
            if self.on_disagreement is not None:
                self.on_disagreement()

    def _on_humble(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        """Note, on any thread, the first Humble peer, whatever it has."""
        self._meet(token)

    def _meet(self, token: EndpointToken) -> None:
        """Use Humble's key as well, if this is the first Humble peer."""
        if token.type_hash != NO_HASH or self.humble_key:
            return
        self.humble_key = format_key(DataKey(self.domain_id, self.name, self.type_name, NO_HASH))
        try:
            self.speak_humble(self.humble_key)
        except TransportClosedError:  # the session ends just now
            pass
        except RobolinkError as error:
            get_logger(self.logger_name).warning(f"{self.name}: cannot meet {token.full_node_name}: {error}")

    @property
    def logger_name(self) -> str:
        """Name of the node's logger."""
        return f"{self.token.namespace}/{self.token.node_name}".strip("/").replace("/", ".")

    def close(self) -> None:
        """End the announcement and the following. Safe to call twice."""
        for handle in (*self._following, self._announced):
            if handle is not None:
                handle.close()
