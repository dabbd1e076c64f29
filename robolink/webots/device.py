"""What all of Webots' devices have in common: names, and sensors that are enabled and read the world's topics."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Generic, TypeVar

from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.message import Message, type_name
from robolink.node import Node
from robolink.subscription import Subscription

MessageT = TypeVar("MessageT", bound=Message)


def plain(name: str) -> str:
    """Give a name without what ROS cannot spell, to compare: `LDS-01` is `lds_01` there.

    >>> plain("LDS-01"), plain("lds_01")
    ('lds01', 'lds01')
    """
    return "".join(filter(str.isalnum, name.lower()))


class World:
    """The topics of one robot: `prefix` is its name and a slash where there are several, else ''."""

    def __init__(self, node: Node, prefix: str) -> None:
        self.node, self.prefix = node, prefix
        self.joint_states = node.resolve_topic_name(f"{prefix}joint_states")
        self._base = self.joint_states.rpartition("/")[0]

    def topics(self, message: type[Message]) -> list[str]:
        """Give the names, without what all of the robot's begin with, of the topics of this type that there are."""
        wanted, base = type_name(message), self._base + "/"
        found = self.node.get_topic_names_and_types()
        return [name.removeprefix(base) for name, types in found if wanted in types and name.startswith(base)]

    def elsewhere(self) -> list[str]:
        """Give the topics that tell the joints of any robot."""
        wanted, found = type_name(JointState), self.node.get_topic_names_and_types()
        names = [name for name, types in found if wanted in types and name.endswith("/joint_states")]
        return [name for name in names if self.node.count_publishers(name)]

    def find(self, message: type[Message], name: str, *, or_only: bool) -> str:
        """Give the topic of a sensor by its name, or if `or_only` the only topic of this type; '' if there is none."""
        topics = self.topics(message)
        found = next((each for each in topics if plain(each) == plain(name)), "")
        return found or (topics[0] if or_only and len(topics) == 1 else "")


class Device:
    """A device by its name."""

    def __init__(self, world: World, name: str) -> None:
        self._world, self._name = world, name

    def getName(self) -> str:
        """Give the name that the device has in the world."""
        return self._name


class Sensor(Device, Generic[MessageT]):
    """A sensor that publishes `message`; it tells something once it is enabled and the world has sent a reading."""

    message: type[MessageT]
    any_name = False
    """Whether the only sensor of its kind is meant by any name: the world has not kept it."""

    def __init__(self, world: World, name: str) -> None:
        super().__init__(world, name)
        self._period = 0
        self._subscription: Subscription[MessageT] | None = None
        self._latest: MessageT | None = None

    def enable(self, samplingPeriod: int) -> None:
        """Begin to sense; the world decides how often."""
        self._period = int(samplingPeriod)
        self._subscribe()

    def disable(self) -> None:
        """Sense no more."""
        self._period, self._latest = 0, None
        if self._subscription is not None:
            self._world.node.destroy_subscription(self._subscription)
            self._subscription = None

    def getSamplingPeriod(self) -> int:
        """Give what it was enabled with, in ms; 0 when it is not."""
        return self._period

    def _subscribe(self) -> None:
        if self._subscription is None and self._period:
            topic = self._world.find(self.message, self._name, or_only=self.any_name)
            if topic:
                name = f"{self._world.prefix}{topic}"
                self._subscription = self._world.node.create_subscription(self.message, name, self._on_message, 10)

    def _on_message(self, message: MessageT) -> None:
        self._latest = message

    @property
    def latest(self) -> MessageT | None:
        """The last reading; None as long as there is none."""
        self._subscribe()
        return self._latest


def nothing(count: int) -> list[float]:
    """Give what Webots tells as long as nothing was measured."""
    return [math.nan] * count


def quoted(names: Iterable[str]) -> str:
    """Give names for a reader."""
    return ", ".join(f"'{each}'" for each in names) or "none"
