"""Wait until something is published on topics (`launch_testing_ros.wait_for_topics`)."""

from __future__ import annotations

import contextlib
import threading
import uuid
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from robolink.context import Context
from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.node import Node
from robolink.system import waits


class WaitForTopics:
    """Subscriptions of a node of its own, on a thread: a test waits until each has got a message.

    As a context manager it waits at once, and raises RuntimeError with the silent topics.

    Args:
        topic_tuples: Topics, each with its type.
        timeout: Longest wait in seconds.
        messages_received_buffer_length: Number of messages that are kept of each topic.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, type]],
        timeout: float = 5.0,
        messages_received_buffer_length: int = 10,
    ) -> None:
        self.topic_tuples, self.timeout = list(topic_tuples), timeout
        self.messages_received_buffer_length = messages_received_buffer_length
        self._received: dict[str, deque[Any]] = {}
        self._all_came = threading.Event()
        self._context = Context()
        self._context.init()
        self._node = Node(f"_test_node_{uuid.uuid4().hex[:10]}", context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._is_subscribed = False
        self._thread = threading.Thread(target=self._spin, name="wait for topics", daemon=True)
        self._thread.start()

    def wait(self) -> bool:
        """Wait for a message on each topic; return whether they came in time."""
        self._all_came.clear()
        self._received = {}
        if not self._is_subscribed:
            self._is_subscribed = True
            for name, kind in self.topic_tuples:
                self._node.create_subscription(kind, name, self._hear(name), 10)
        return waits.wait(self._all_came, self.timeout)

    def shutdown(self) -> None:
        """Leave the network."""
        self._context.try_shutdown()
        waits.join(self._thread)

    def topics_received(self) -> set[str]:
        """Return the topics that have got a message."""
        return set(self._received)

    def topics_not_received(self) -> set[str]:
        """Return the topics that have got none."""
        return {name for name, _ in self.topic_tuples} - self.topics_received()

    def received_messages(self, topic_name: str) -> list[Any]:
        """Return the last messages of a topic, `topic_name`. Raises KeyError if there was none."""
        if topic_name not in self._received:
            raise KeyError(f"no messages were received on {topic_name}")
        return list(self._received[topic_name])

    def __enter__(self) -> WaitForTopics:
        if not self.wait():
            silent = ", ".join(sorted(self.topics_not_received()))
            self.shutdown()
            raise RuntimeError(f"no message within {self.timeout:g} s on {silent}")
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()

    def _hear(self, name: str) -> Callable[[Any], None]:
        def heard(message: Any) -> None:
            kept = self._received.setdefault(name, deque(maxlen=self.messages_received_buffer_length))
            kept.append(message)
            if not self.topics_not_received():
                self._all_came.set()

        return heard

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()
