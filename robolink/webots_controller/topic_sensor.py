"""Base classes of Webots' devices and sensors: a name, and a subscription while enabled."""

from __future__ import annotations

import math
from typing import Generic, TypeVar

from robolink.message import Message
from robolink.subscription import Subscription
from robolink.webots_controller.robot_topics import RobotTopics

MessageT = TypeVar("MessageT", bound=Message)


class Device:
    """Base class of devices: a name."""

    def __init__(self, topics: RobotTopics, name: str) -> None:
        self._topics, self._name = topics, name

    def getName(self) -> str:
        """Return the name that the device has in the world."""
        return self._name


class Sensor(Device, Generic[MessageT]):
    """Base class of sensors with topics of type `message`; a value comes once enabled, with the first message."""

    message: type[MessageT]
    any_name = False
    """True if any name means the only sensor of its kind, since the world does not keep the name."""

    def __init__(self, topics: RobotTopics, name: str) -> None:
        super().__init__(topics, name)
        self._period = 0
        self._subscription: Subscription[MessageT] | None = None
        self._latest: MessageT | None = None

    @classmethod
    def topic_of(cls, name: str) -> str:
        """Return the name of the topic of a device."""
        return name

    @classmethod
    def found(cls, topics: RobotTopics, name: str, *, or_only: bool) -> str:
        """Return the topic of a sensor of this class, or if `or_only` the only one of its type; '' for none."""
        return topics.find(cls.message, cls.topic_of(name), or_only=or_only)

    def enable(self, samplingPeriod: int) -> None:
        """Enable the sensor; the world decides how often it measures, not `samplingPeriod` (ms)."""
        self._period = int(samplingPeriod)
        self._subscribe()

    def disable(self) -> None:
        """Disable the sensor."""
        self._period, self._latest = 0, None
        if self._subscription is not None:
            self._topics.node.destroy_subscription(self._subscription)
            self._subscription = None

    def getSamplingPeriod(self) -> int:
        """Return the sampling period in ms; 0 if disabled."""
        return self._period

    def _subscribe(self) -> None:
        if self._subscription is None and self._period:
            topic = self.found(self._topics, self._name, or_only=self.any_name)
            if topic:
                name = f"{self._topics.prefix}{topic}"
                self._subscription = self._topics.node.create_subscription(self.message, name, self._on_message, 10)

    def _on_message(self, message: MessageT) -> None:
        self._latest = message

    @property
    def latest(self) -> MessageT | None:
        """The latest message; None if there is none."""
        self._subscribe()
        return self._latest


def nothing(count: int) -> list[float]:
    """Return `count` NaN: the value of a Webots sensor before its first measurement."""
    return [math.nan] * count
