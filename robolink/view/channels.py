"""Channels: topics as clients see them, each with one type, its schema, and the subscriptions of clients to it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, Protocol

from robolink.topic_or_service_is_hidden import topic_or_service_is_hidden
from robolink.wire import NO_HASH, EndpointToken

LARGEST = 32 * 2**20
"""Upper bound of a message's payload, in bytes: larger ones are not sent to clients."""

Take = Callable[[int, bytes, bytes], object]
"""Function of a message: its time of arrival in ns since the epoch, its payload, and its sender's attachment."""


class Retained(NamedTuple):
    """Message that a latched channel keeps for clients that subscribe later; its fields are those of Take."""

    at: int
    payload: bytes
    sender: bytes


class Channel:
    """A topic with one of its types.

    Args:
        number: Id of the channel, unique in the server.
        topic: Full name of the topic.
        type_name: Its type, `std_msgs/msg/String`.
        schema: Definition of the type, in the encoding ros2msg.
        type_hash: Hash of the type; "" if it is not known.
    """

    encoding = "cdr"

    def __init__(self, number: int, topic: str, type_name: str, schema: str, type_hash: str = "") -> None:
        self.id, self.topic, self.type_name, self.schema, self.type_hash = number, topic, type_name, schema, type_hash
        self.hidden = topic_or_service_is_hidden(topic)
        self.latched = False
        """True if what was published before counts for late subscribers."""
        self.takers: list[Take] = []
        self.count = self.bytes = self.too_large = 0
        """Messages and bytes that have come, and messages of those that are larger than LARGEST."""
        self.last = 0
        """Time of the last message, in ns since the epoch."""

    def fits(self, end: EndpointToken) -> bool:
        """True if an endpoint has the type of this channel; Humble's tell no hash."""
        same = end.type_hash == self.type_hash or NO_HASH in (end.type_hash, self.type_hash)
        return same and end.type_name == self.type_name

    def deliver(self, at: int, payload: bytes, sender: bytes) -> None:
        """Hand a message to all clients that have subscribed."""
        self.note(at, len(payload))
        if len(payload) > LARGEST:
            self.too_large += 1
            return
        for take in self.takers:
            take(at, payload, sender)

    def note(self, at: int, size: int) -> None:
        """Count a message of `size` bytes."""
        self.count += 1
        self.bytes += size
        self.last = at

    def advertisement(self, *, all_of_it: bool) -> dict[str, Any]:
        """Return the channel as `advertise` has it; with `all_of_it` also what is robolink's own."""
        shown: dict[str, Any] = {
            "id": self.id,
            "topic": self.topic,
            "encoding": self.encoding,
            "schemaName": self.type_name,
            "schemaEncoding": "ros2msg",
            "schema": self.schema,
        }
        if all_of_it and self.hidden:
            shown["hidden"] = True
        if all_of_it and self.latched:
            shown["latched"] = True
        return shown


class Shown(NamedTuple):
    """Definition of one half of a service: its type's name, and its schema in the encoding ros2msg."""

    type_name: str
    schema: str


class ServiceEntry(NamedTuple):
    """A service as clients see it."""

    id: int
    name: str
    type_name: str
    request: Shown
    response: Shown
    hidden: bool

    def advertisement(self, *, all_of_it: bool, legacy: bool) -> dict[str, Any]:
        """Return the service as `advertiseServices` has it; `legacy` clients read the schemas by their old names."""
        shown: dict[str, Any] = {"id": self.id, "name": self.name, "type": self.type_name}
        for part, half in (("request", self.request), ("response", self.response)):
            shown[part] = {
                "encoding": "cdr",
                "schemaName": half.type_name,
                "schemaEncoding": "ros2msg",
                "schema": half.schema,
            }
            if legacy:
                shown[f"{part}Schema"] = half.schema
        if all_of_it and self.hidden:
            shown["hidden"] = True
        return shown


class Audience(Protocol):
    """Listener to a source: it tells the clients what comes and goes. All methods are called on the server's loop."""

    def channels_came(self, channels: Iterable[Channel]) -> None:
        """Advertise channels."""

    def channels_went(self, channels: Iterable[Channel]) -> None:
        """Take channels back."""

    def services_came(self, services: Iterable[ServiceEntry]) -> None:
        """Advertise services."""

    def services_went(self, services: Iterable[ServiceEntry]) -> None:
        """Take services back."""

    def tell(self, level: int, message: str, id_: str) -> None:
        """Show a status to all clients, until it is taken back."""

    def take_back(self, id_: str) -> None:
        """Take a status back."""

    def capabilities_changed(self) -> None:
        """Announce to clients what can be done here, which has changed."""

    def time_is(self, now: int) -> None:
        """Send clients the time of the system, in ns."""

    def playback_changed(self, *, did_seek: bool) -> None:
        """Send clients the state of the playback of a bag."""


class Source(Protocol):
    """Where the messages come from: a running system, or a bag. All methods are for the server's loop."""

    channels: dict[int, Channel]
    services: dict[int, ServiceEntry]

    def begin(self, audience: Audience) -> None:
        """Begin to look for channels, in a running loop."""

    def listen(self, channel: Channel) -> None:
        """Begin to receive a channel, for its takers or for its figures."""

    def leave(self, channel: Channel) -> None:
        """Receive it no longer."""

    def retained(self, channel: Channel) -> list[Retained]:
        """Return the messages that a late subscriber of a latched channel gets."""

    def sweep(self) -> None:
        """Deliver all that has arrived."""

    def now(self) -> int:
        """Return the time by which messages are dated, in ns since the epoch: the system's, or a bag's."""

    def ends(self, channel: Channel) -> tuple[int, int]:
        """Return how many publishers and subscriptions a channel has."""

    def capabilities(self) -> list[str]:
        """Return the server's capabilities, in Foxglove's words."""

    def information(self) -> dict[str, Any]:
        """Return fields of `serverInfo`: those of `robolink`, and `dataStartTime` and `dataEndTime` of a bag."""

    def close(self) -> None:
        """Let go of everything."""
