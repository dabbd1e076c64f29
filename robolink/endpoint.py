"""One announced end of a topic or service: its key, its token, and the id that goes with all it sends."""

from __future__ import annotations

from typing import Any, NamedTuple

from robolink.context import Context
from robolink.message import type_hash, type_name
from robolink.qos import QoSProfile
from robolink.transport.base import Handle
from robolink.wire import DataKey, EndpointKind, EndpointToken, attachments, format_key, format_token, gid_of


class Owner(NamedTuple):
    """The node that an endpoint belongs to, as tokens name it."""

    context: Context
    node_id: int
    enclave: str
    namespace: str
    node_name: str


class Endpoint:
    """A publisher's, subscription's, service's or client's place on the wire.

    It is announced once everything behind it is there: whoever sees it may publish or ask at once.
    """

    def __init__(self, owner: Owner, kind: EndpointKind, name: str, ros_type: type[Any], qos: QoSProfile) -> None:
        self.context, self.name, self.qos = owner.context, name, qos
        self.domain_id = owner.context.get_domain_id()
        self.type_name = type_name(ros_type)
        self.type_hash = type_hash(ros_type)
        self.key = format_key(DataKey(self.domain_id, name, self.type_name, self.type_hash))
        self.transport = owner.context.transport
        self.token = EndpointToken(
            self.domain_id,
            self.transport.session_id,
            owner.node_id,
            owner.context.next_id(),
            kind,
            owner.enclave,
            owner.namespace,
            owner.node_name,
            name,
            self.type_name,
            self.type_hash,
            qos,
        )
        self._text = format_token(self.token)
        self.gid = gid_of(self._text)
        self.attachment = attachments(self.gid, owner.context.time.now)
        """Make the attachment of the next thing that is sent from here."""
        self._announced: Handle | None = None

    def announce(self) -> None:
        """Show it to everybody."""
        self._announced = self.transport.announce(self._text)

    @property
    def logger_name(self) -> str:
        """The name of the logger that belongs to the node."""
        return f"{self.token.namespace}/{self.token.node_name}".strip("/").replace("/", ".")

    def close(self) -> None:
        """Announce it no longer."""
        if self._announced is not None:
            self._announced.close()
