"""Diagnostics of topics: how often is published, and how old are the stamps."""

from __future__ import annotations

from typing import Any

from robolink.companions.diagnostic_updater.tasks import CompositeDiagnosticTask
from robolink.companions.diagnostic_updater.updater import Updater
from robolink.companions.diagnostic_updater.watching import (
    FrequencyStatus,
    FrequencyStatusParam,
    TimeStampStatus,
    TimeStampStatusParam,
)
from robolink.publisher import Publisher
from robolink.time import Time


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """Task for a topic whose messages have no header; it adds itself to an updater.

    Args:
        name: Name of the topic.
        diag: The updater.
        freq: Bounds of its frequency.
    """

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag, self.freq = diag, FrequencyStatus(freq)
        self.addTask(self.freq)
        diag.add(self)

    def tick(self) -> None:
        """Note that a message was published."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Forget what was counted."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """Task for a topic whose messages have a header.

    Args:
        name: Name of the topic.
        diag: The updater.
        freq: Bounds of its frequency.
        stamp: Bounds of the age of its stamps.
    """

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam, stamp: TimeStampStatusParam) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp)
        self.addTask(self.stamp)

    def tick(self, stamp: float | Time) -> None:  # type: ignore[override]
        """Note that a message with a `stamp` was published: a Time, or seconds."""
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """Publisher whose topic has diagnostics.

    Args:
        pub: The publisher; its messages have a header.
        diag: The updater.
        freq: Bounds of its frequency.
        stamp: Bounds of the age of its stamps.
    """

    def __init__(
        self, pub: Publisher[Any], diag: Updater, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(pub.topic_name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: Any) -> None:
        """Publish a `message`, and note its stamp."""
        stamp = message.header.stamp
        self.tick(Time.from_msg(stamp) if stamp.sec >= 0 else stamp.sec + stamp.nanosec / 1e9)  # no Time is before 1970
        self.publisher.publish(message)
