"""Endpoints: publishers, subscriptions, services and clients on the wire, and raw ones for tools.

Each has its keys, its token and its matches, and warns of another type at the other end. Tools listen to and send
messages undecoded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import msgspec

from robolink.exceptions import RobolinkError, TransportClosedError
from robolink.logging import get_logger
from robolink.message import import_numpy_for, type_hash, type_name
from robolink.message.description import has_buffer_fields
from robolink.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
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
    from typing import Protocol

    from robolink.graph.graph import Graph
    from robolink.running.ports import ContextLike
    from robolink.transport.base import Sink

    class GraphContext(ContextLike, Protocol):
        """Context as seen by an endpoint: it has a graph."""

        @property
        def graph(self) -> Graph:
            """Graph of the nodes, topics and services that are announced on this domain."""


MOST_REPORTED = 10
"""Most warnings for one topic of a node; a system in which all is wrong must not drown in them."""

_ACTS = {
    EndpointKind.PUBLISHER: "publishes it",
    EndpointKind.SUBSCRIPTION: "subscribes to it",
    EndpointKind.SERVICE: "serves it",
    EndpointKind.CLIENT: "calls it",
}
_SHOWN = len("RIHS01_") + 8


class Disagreements:
    """Warnings that one node has logged: of each other node and type one, under the name of a topic or service.

    On this wire the type is a part of where messages are sent: two ends that differ in it never meet, in silence.
    Only the graph's followers call it: one at a time.
    """

    def __init__(self, logger_name: str) -> None:
        self._logger_name = logger_name
        self._reported: dict[str, set[tuple[str, frozenset[str]]]] = {}

    def tell(self, own: EndpointToken, other: EndpointToken) -> None:
        """Log one warning about an end that will never meet this one, unless that has been done."""
        reported = self._reported.setdefault(own.name, set())
        pair = (other.full_node_name, frozenset((own.type_name + own.type_hash, other.type_name + other.type_hash)))
        if pair in reported or len(reported) >= MOST_REPORTED:
            return
        reported.add(pair)
        end = "" if len(reported) < MOST_REPORTED else " (no more of these are told)"
        get_logger(self._logger_name).warning(_explained(own, other) + end)


def _explained(own: EndpointToken, other: EndpointToken) -> str:
    same_node = (own.session, own.node_id) == (other.session, other.node_id)
    node = "it also" if same_node else other.full_node_name
    here, there = _ACTS[own.kind], _ACTS[other.kind]
    if own.type_name != other.type_name:
        return (
            f"{own.name}: this node {here} as {own.type_name}, but {node} {there} as {other.type_name}:"
            " nothing gets from one to the other; give both the same type, or one of them another name"
        )
    package = own.type_name.partition("/")[0]
    return (
        f"{own.name}: this node {here} as {own.type_name}, and so {node} {there}, but the two definitions of that"
        f" type differ ({own.type_hash[:_SHOWN]}… here, {other.type_hash[:_SHOWN]}… there): nothing gets from one"
        f" to the other; bring both to the same version of {package}"
    )


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
        self.on_match: Callable[[bytes, EndpointToken, bool], object] = lambda gid, token, came: None
        """Function called likewise, before `on_other`, with the gid and the token of that endpoint."""
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
                self.on_match(gid, token, False)
                self.on_other(False)
        elif self.token.understands(token):
            self._meet(token)
            self.others[gid] = token
            self.on_match(gid, token, True)
            self.on_other(True)
        else:
            if self.warns:  # logged here, on the graph's thread: a program that only publishes never spins
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


ALL_BEST_EFFORT = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.BEST_EFFORT)
"""Profile of tools that listen to what others publish: every message counts, and nobody waits for the tool."""


def keys_of(publisher: EndpointToken) -> set[str]:
    """Return the keys on which a publisher's messages may come."""
    key = format_key(DataKey(publisher.domain, publisher.name, publisher.type_name, publisher.type_hash))
    return {key, buffer_key(key)} if publisher.names_backends else {key}


def listen(owner: Owner, publisher: EndpointToken, keys: Iterable[str], qos: QoSProfile, sink: Sink) -> list[Handle]:
    """Subscribe to keys of a publisher, and announce the subscription as one of a node's.

    Args:
        owner: Node that listens.
        publisher: Publisher whose topic, type and hash the subscription has, and is announced with.
        keys: Those of `keys_of(publisher)` that are not listened to yet.
        qos: Quality of service of the subscription.
        sink: Function that gets each arrival, on any thread; it must only enqueue.

    Returns:
        The handles that end it.
    """
    context = owner.context
    declared = [context.transport.subscribe(key, qos, sink) for key in sorted(keys)]
    token = EndpointToken(
        publisher.domain,
        context.transport.session_id,
        owner.node_id,
        context.next_id(),
        EndpointKind.SUBSCRIPTION,
        owner.enclave,
        owner.namespace,
        owner.node_name,
        publisher.name,
        publisher.type_name,
        publisher.type_hash,
        qos,
        CPU_BACKEND if publisher.names_backends else "",
    )
    return [*declared, context.graph.announce(token)]


class RawPublisher:
    """Publisher of a topic of which only the type's name and hash are known.

    Args:
        owner: Node that publishes.
        topic: Full name of the topic.
        type_name: Name of its type.
        type_hash: Hash of its type (RIHS01_...).
        qos: Quality of service.
    """

    def __init__(self, owner: Owner, topic: str, type_name: str, type_hash: str, qos: QoSProfile) -> None:
        context = owner.context
        domain = context.get_domain_id()
        token = EndpointToken(
            domain,
            context.transport.session_id,
            owner.node_id,
            context.next_id(),
            EndpointKind.PUBLISHER,
            owner.enclave,
            owner.namespace,
            owner.node_name,
            topic,
            type_name,
            type_hash,
            qos,
            "",
        )
        text = format_token(token)
        self._attachment = attachments(gid_of(text), context.time.now)
        self._outlet = context.transport.advertise(format_key(DataKey(domain, topic, type_name, type_hash)), qos)
        self._announced = context.graph.announce(token, text)

    def publish(self, data: bytes) -> None:
        """Send a serialized message."""
        self._outlet.put(data, self._attachment())

    def destroy(self) -> None:
        """End the publisher."""
        self._announced.close()
        self._outlet.close()


ArrivalType: TypeAlias = Callable[[Any, Any], Any]
"""Class of arrivals: `functools.partial(arrival_type, target)` is the sink of a subscription."""


def timed_arrival(put: Callable[[Any], object], clock: Callable[[], int]) -> ArrivalType:
    """Return a new class of arrivals; making one of it stamps it, and queues it.

    The time is taken where the network hands a message over, not where it is handled: a queue that is long because the
    reader is slow changes no figure. As in `running.inbox`, it is C from end to end: the class's default factory reads
    the clock, and its `__post_init__` is a queue's `put`.

    Args:
        put: Function of a queue, in C, that is called with each arrival: it has the fields `target`, `content` (for
            `Transport.read`) and `at`.
        clock: Function, in C, that returns the time in ns.
    """
    return msgspec.defstruct(
        "Arrival",
        ["target", "content", ("at", int, msgspec.field(default_factory=clock))],
        namespace={"__post_init__": put},
        gc=False,
    )
