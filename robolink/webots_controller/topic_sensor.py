"""What all of Webots' sensors have in common: a name, and that they are enabled and then read a topic."""

from __future__ import annotations

import math
from typing import Generic, TypeVar

from robolink.message import Message
from robolink.subscription import Subscription
from robolink.webots_controller.robot_topics import RobotTopics

MessageT = TypeVar("MessageT", bound=Message)


class Device:
    """A device by its name."""

    def __init__(self, topics: RobotTopics, name: str) -> None:
        self._topics, self._name = topics, name

    def getName(self) -> str:
        """Give the name that the device has in the world."""
        return self._name


class Sensor(Device, Generic[MessageT]):
    """A sensor that publishes `message`; it tells something once it is enabled and the world has sent a reading."""

    message: type[MessageT]
    any_name = False
    """Whether the only sensor of its kind is meant by any name: the world has not kept it."""

    def __init__(self, topics: RobotTopics, name: str) -> None:
        super().__init__(topics, name)
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
            self._topics.node.destroy_subscription(self._subscription)
            self._subscription = None

    def getSamplingPeriod(self) -> int:
        """Give what it was enabled with, in ms; 0 when it is not."""
        return self._period

    def _subscribe(self) -> None:
        if self._subscription is None and self._period:
            topic = self._topics.find(self.message, self._name, or_only=self.any_name)
            if topic:
                name = f"{self._topics.prefix}{topic}"
                self._subscription = self._topics.node.create_subscription(self.message, name, self._on_message, 10)

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
