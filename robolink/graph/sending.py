"""Raw publishers: for tools that send messages of types that they do not know."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.wire import DataKey, EndpointKind, EndpointToken, attachments, format_key, format_token, gid_of

if TYPE_CHECKING:
    from robolink.graph.endpoint import Owner
    from robolink.qos import QoSProfile


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
