"""Publishers of a player: one for each topic, with the recorded type and profile."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias

from robolink.bag.playing.offers import offered
from robolink.bag.playing.types import class_of
from robolink.bag.topic import BagTopic
from robolink.exceptions import RobolinkError
from robolink.graph.endpoint import RawPublisher
from robolink.node import Node
from robolink.publisher import Publisher
from robolink.qos import QoSProfile

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
