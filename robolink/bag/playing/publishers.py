"""Publishers of a playback: their types and QoS, and clients for recorded requests."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, TypeAlias

from robolink.bag.selection import service_of
from robolink.bag.topic import SEPARATOR, BagTopic
from robolink.client import Client
from robolink.exceptions import DecodeError, DefinitionError, NotFoundError, RobolinkError
from robolink.graph.endpoint import RawPublisher
from robolink.interfaces import find, find_announced
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.message import Message, decode, type_hash
from robolink.message.building import build
from robolink.message.definition import parse
from robolink.node import Node
from robolink.publisher import Publisher
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

DEPTH = 10
MOST_RETAINED = 1000
"""Bound of the messages that a latched topic keeps for late subscriptions."""
TF_STATIC = "/tf_static"


def is_latched(topic: BagTopic) -> bool:
    """True if a publisher of the topic kept messages for late subscriptions (TRANSIENT_LOCAL).

    A bag without any profile for `/tf_static` (of ROS 1, or another writer) latched it all the same.
    """
    if not topic.offered_qos:
        return topic.name.endswith(TF_STATIC)
    return any(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in topic.offered_qos)


def retained_of(topic: BagTopic) -> int:
    """Return how many of its messages a latched topic keeps: those of all its publishers."""
    if not topic.offered_qos:
        return MOST_RETAINED
    latching = [each for each in topic.offered_qos if each.durability is DurabilityPolicy.TRANSIENT_LOCAL]
    if any(each.history is HistoryPolicy.KEEP_ALL for each in latching):
        return MOST_RETAINED
    return min(MOST_RETAINED, sum(max(1, each.depth) for each in latching))


def offered(topic: BagTopic) -> QoSProfile:
    """Return the profile of the publisher that stands for all publishers of a recorded topic.

    It offers the most that any of them did in reliability and durability, so that whoever could hear one of them
    hears it. Deadlines and the like are kept if all offered the same.
    """
    recorded = topic.offered_qos
    durable = is_latched(topic)
    depth = retained_of(topic) if durable else max(DEPTH, *(each.depth for each in recorded)) if recorded else DEPTH
    reliable = not recorded or any(each.reliability is not ReliabilityPolicy.BEST_EFFORT for each in recorded)
    profile = QoSProfile(
        depth=min(depth, MOST_RETAINED),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if durable else DurabilityPolicy.VOLATILE,
    )
    if recorded:
        first = recorded[0]
        for name in ("deadline", "lifespan", "liveliness_lease_duration"):
            if len({getattr(each, name).nanoseconds for each in recorded}) == 1:
                setattr(profile, name, getattr(first, name))
    return profile


PART = "MSG: "
DEEPEST = 32
"""Most types that may be nested in one another."""


def class_of(topic: BagTopic) -> type[Any] | None:
    """Return the message class by which a topic's messages are published; None where only its bytes are known.

    That is the installed one, unless the bag's messages are of another type of this name.
    """
    installed = _installed(topic.type_name)
    if installed is not None and topic.type_hash in ("", type_hash(installed)):
        return installed
    recorded = _recorded(topic)
    if recorded is None:
        return None if topic.type_hash else installed
    return installed if installed is not None and type_hash(installed) == type_hash(recorded) else recorded


def class_of_definition(text: str, type_name: str) -> type[Any]:
    """Return the message class of a definition with the types in it, as schemas of ros2msg have it.

    Raises DefinitionError (a ValueError) for a text that is wrong or lacks a type.
    """
    first, *others = text.replace("\r\n", "\n").split(SEPARATOR + "\n")
    texts = {}
    for each in others:
        head, _, body = each.partition("\n")
        if head.startswith(PART):
            texts[_full(head.removeprefix(PART).strip())] = body
    return _Classes(texts).made(type_name, first, 0)


class _Classes:
    """Classes of the parts of a definition, each built once."""

    def __init__(self, texts: dict[str, str]) -> None:
        self._texts = texts
        self._made: dict[str, type[Message]] = {}

    def made(self, name: str, text: str, depth: int) -> type[Any]:
        if depth > DEEPEST:
            raise DefinitionError(f"{name}: types are nested deeper than {DEEPEST}, or in themselves")
        return build(parse(text, name, name), lambda nested: self._resolve(nested, depth + 1))

    def _resolve(self, name: str, depth: int) -> type[Message]:
        if name not in self._made:
            if name not in self._texts:
                raise NotFoundError("message type", name, self._texts)
            self._made[name] = self.made(name, self._texts[name], depth)
        return self._made[name]


def _full(name: str) -> str:
    package, _, short = name.partition("/")
    return f"{package}/msg/{short}" if short and "/" not in short else name


def _installed(type_name: str) -> type[Any] | None:
    try:
        found: type[Any] = find_announced(type_name)
    except RobolinkError:  # there is none, or a file of the workspace is wrong
        return None
    return found if hasattr(found, "__ros_fields__") else None


def _recorded(topic: BagTopic) -> type[Any] | None:
    if topic.definition_encoding != "ros2msg" or not topic.message_definition:
        return None
    try:
        return class_of_definition(topic.message_definition, topic.type_name)
    except RobolinkError:
        return None


AnyPublisher: TypeAlias = "Publisher[Any] | RawPublisher"


class Publishers:
    """Publishers of a node for the topics of bags.

    A type that is not installed is the one that the bag describes; without a description its bytes are published.
    What cannot be published is left out, with a warning.

    Args:
        node: Node that publishes; its remappings count.
        topics: Topics of bags.
        overrides: Profiles by topic, instead of those that were recorded.
        warn: Called with one line for each topic that is left out.
    """

    def __init__(
        self,
        node: Node,
        topics: Iterable[BagTopic],
        overrides: Mapping[str, QoSProfile],
        warn: Callable[[str], object],
    ) -> None:
        self._node = node
        self._all: dict[str, AnyPublisher] = {}
        for topic in topics:
            try:
                self._all[topic.name] = self._made(topic, overrides.get(topic.name) or offered(topic))
            except RobolinkError as error:
                warn(f"topic '{topic.name}' is not played: {error}")

    def publish(self, topic: str, data: bytes | memoryview) -> bool:
        """Publish a message; False if the topic is left out."""
        publisher = self._all.get(topic)
        if publisher is None:
            return False
        publisher.publish(bytes(data))
        return True

    @property
    def topics(self) -> list[str]:
        """Names of the topics that are published."""
        return list(self._all)

    def wait_for_all_acked(self) -> None:
        """Return at once: as with rmw_zenoh, there are no acknowledgements on this network."""

    def destroy(self) -> None:
        """End all publishers."""
        for each in self._all.values():
            each.destroy()
        self._all.clear()

    def _made(self, topic: BagTopic, qos: QoSProfile) -> AnyPublisher:
        if topic.serialization_format != "cdr":
            raise RobolinkError(f"its messages are serialized as '{topic.serialization_format}', not as cdr")
        found = class_of(topic)
        if found is not None:
            return self._node.create_publisher(found, topic.name, qos)
        if not topic.type_hash:
            raise RobolinkError(
                f"its type {topic.type_name} is not installed, and the bag has neither its definition nor its hash"
            )
        name = self._node.resolve_topic_name(topic.name)
        return RawPublisher(self._node._owner_, name, topic.type_name, topic.type_hash, qos)


SOURCES = {
    "service_introspection": ServiceEventInfo.REQUEST_RECEIVED,
    "client_introspection": ServiceEventInfo.REQUEST_SENT,
}
"""Kind of the events whose requests are sent, by rosbag2's name of their source."""


class _Called(NamedTuple):
    client: Client
    event: type[Any]


class Requests:
    """Clients of a node for the services whose events bags have. Nobody waits for the responses.

    Args:
        node: Node that calls; somebody has to spin it.
        topics: Topics of bags; those that are not events of services are left alone.
        source: Which events count, a key of SOURCES.
        warn: Called with one line for each service that cannot be called, and once for each that is not there.
    """

    def __init__(self, node: Node, topics: Iterable[BagTopic], source: str, warn: Callable[[str], object]) -> None:
        self._kind, self._warn = SOURCES[source], warn
        self._called: dict[str, _Called] = {}
        self._missing: set[str] = set()
        for topic in topics:
            if topic.is_service_event:
                try:
                    kind = find(topic.type_name.removesuffix("_Event"), "srv")
                    client = node.create_client(kind, service_of(topic.name))
                    self._called[topic.name] = _Called(client, kind.Event)
                except RobolinkError as error:
                    warn(f"service '{service_of(topic.name)}' is not called: {error}")

    def send(self, topic: str, data: bytes | memoryview) -> None:
        """Call the service if this event has a request of the wanted kind; without the service, warn."""
        called = self._called.get(topic)
        if called is None:
            return
        try:
            event = decode(called.event, bytes(data))
        except DecodeError as error:
            self._warn(f"service '{service_of(topic)}': an event cannot be read: {error}")
            return
        if event.info.event_type != self._kind or not event.request:
            return
        if called.client.service_is_ready():
            called.client.call_async(event.request[0])
        elif topic not in self._missing:
            self._missing.add(topic)
            self._warn(f"service '{service_of(topic)}' is not there: its requests are left out")

    def destroy(self) -> None:
        """End the clients."""
        for each in self._called.values():
            each.client.destroy()
