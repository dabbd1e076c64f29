"""launch_testing_ros: nodes for tests: waiting for topics, republishing, and a thread that spins."""

from __future__ import annotations

import contextlib
import sys
import threading
import uuid
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from robolink.context import Context
from robolink.event_handler import SubscriptionEventCallbacks
from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.launch.ros.launch_testing import tools as launch_testing_tools
from robolink.launch.ros.launch_testing.test_runner import LaunchTestRunner
from robolink.node import Node
from robolink.qos import QoSProfile
from robolink.system import waits

__all__ = [
    "DataRepublisher",
    "LaunchTestRunner",
    "MessagePump",
    "WaitForTopics",
    "basic_output_filter",
    "tools",
]

tools = sys.modules[__name__]
"""`launch_testing_ros.tools`, a module of its own in ROS 2: here its names are in this file, too."""


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


_ENDS_WITHIN = 5.0
"""Timeout of its end, in s."""


class MessagePump:
    """Spins a node on a thread of its own.

    Args:
        node: The node.
        context: Its context; None is the default one.
    """

    def __init__(self, node: Node, context: Context | None = None) -> None:
        self._node, self._context = node, context
        self._is_over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="message pump", daemon=True)

    def start(self) -> None:
        """Begin to spin."""
        self._thread.start()

    def stop(self) -> None:
        """Spin no more. Raises TimeoutError if a callback does not end."""
        self._is_over.set()
        if not waits.join(self._thread, _ENDS_WITHIN):
            raise TimeoutError("a callback of the node does not end")

    def _run(self) -> None:
        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)
        while not self._is_over.is_set():
            executor.spin_once(timeout_sec=0.1)
        executor.remove_node(self._node)


class WaitForTopics:
    """Subscriptions of a node of its own, on a thread: a test waits until each has got a message.

    As a context manager it waits at once, and raises RuntimeError with the silent topics.

    Args:
        topic_tuples: Topics, each with its type.
        timeout: Longest wait in seconds.
        messages_received_buffer_length: Number of messages that are stored of each topic.
        trigger: Function that makes others publish, such as by publishing itself: `wait` calls it with the node, and
            with its own arguments, once a publisher of one of the topics is connected, or once the time is over.
        node_namespace: Namespace of the node; None is the root.
        qos_profile: QoS of the subscriptions, or its depth.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, type]],
        timeout: float = 5.0,
        messages_received_buffer_length: int = 10,
        trigger: Callable[..., object] | None = None,
        node_namespace: str | None = None,
        qos_profile: QoSProfile | int = 10,
    ) -> None:
        if trigger is not None and not callable(trigger):
            raise TypeError(f"trigger is a function of the node, got {type(trigger).__name__}")
        self.topic_tuples, self.timeout = list(topic_tuples), timeout
        self.messages_received_buffer_length = messages_received_buffer_length
        self.trigger, self.node_namespace, self.qos_profile = trigger, node_namespace, qos_profile
        self._received: dict[str, deque[Any]] = {}
        self._all_came, self._is_connected = threading.Event(), threading.Event()
        self._context = Context()
        self._context.init()
        name = f"_test_node_{uuid.uuid4().hex[:10]}"
        self._node = Node(name, context=self._context, namespace=node_namespace)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._is_subscribed = False
        self._thread = threading.Thread(target=self._spin, name="wait for topics", daemon=True)
        self._thread.start()

    def wait(self, *args: Any, **kwargs: Any) -> bool:
        """Wait for a message on each topic; return whether they came in time.

        Args:
            *args: Further arguments of the trigger.
            **kwargs: Further arguments of the trigger, by name.
        """
        self._all_came.clear()
        self._received = {}
        if not self._is_subscribed:
            self._is_subscribed = True
            matched = SubscriptionEventCallbacks(matched=self._note_match)
            for name, kind in self.topic_tuples:
                self._node.create_subscription(kind, name, self._hear(name), self.qos_profile, event_callbacks=matched)
        if self.trigger is not None:
            waits.wait(self._is_connected, self.timeout)
            self.trigger(self._node, *args, **kwargs)
        return waits.wait(self._all_came, self.timeout)

    def _note_match(self, info: Any) -> None:
        if info.current_count > 0:
            self._is_connected.set()

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
            stored = self._received.setdefault(name, deque(maxlen=self.messages_received_buffer_length))
            stored.append(message)
            if not self.topics_not_received():
                self._all_came.set()

        return heard

    def _spin(self) -> None:
        with contextlib.suppress(ExternalShutdownException):
            self._executor.spin()


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None,
    filtered_patterns: Iterable[str] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[str], str]:
    """Return a function that leaves lines out of an output.

    Args:
        filtered_prefixes: As for `launch_testing.tools.basic_output_filter`.
        filtered_patterns: As there.
        filtered_rmw_implementation: Of no effect: robolink's nodes have no other middleware, and it writes no lines.
    """
    return launch_testing_tools.basic_output_filter(filtered_prefixes, filtered_patterns)
