"""Raw subscriptions: for tools that take the undecoded messages of whatever publishers the graph has."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robolink.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from robolink.wire import CPU_BACKEND, DataKey, EndpointKind, EndpointToken, buffer_key, format_key

if TYPE_CHECKING:
    from robolink.graph.endpoint import Owner
    from robolink.transport.base import Handle, Sink

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
