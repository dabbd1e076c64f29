"""Republisher of messages that a test changes (`launch_testing_ros.data_republisher`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.node import Node


class DataRepublisher:
    """Publishes what arrives on a topic on another one, changed.

    Args:
        node: Node of the test, which it must spin.
        listen_topic: Topic that is listened to.
        publish_topic: Topic that is published.
        msg_type: Type of both.
        transform_fn: Function of a message that returns the one to publish, or None for none.
    """

    def __init__(
        self, node: Node, listen_topic: str, publish_topic: str, msg_type: type, transform_fn: Callable[[Any], Any]
    ) -> None:
        self._node, self._change = node, transform_fn
        self._received = 0
        self._published: list[Any] = []
        self._subscription: Any = node.create_subscription(msg_type, listen_topic, self._hear, 10)
        self._publisher: Any = node.create_publisher(msg_type, publish_topic, 10)

    def shutdown(self) -> None:
        """Stop."""
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._publisher)

    def get_num_received(self) -> int:
        """Return how many messages have arrived."""
        return self._received

    def get_num_republished(self) -> int:
        """Return how many were published."""
        return len(self._published)

    def get_republished(self) -> list[Any]:
        """Return the messages that were published."""
        return self._published

    def _hear(self, message: Any) -> None:
        self._received += 1
        changed = self._change(message)
        if changed is not None:
            self._publisher.publish(changed)
            self._published.append(changed)
