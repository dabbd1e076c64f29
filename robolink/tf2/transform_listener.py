"""Listening to /tf and /tf_static, and filling a buffer with what comes."""

from __future__ import annotations

import contextlib
import threading
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.exceptions import ExternalShutdownException
from robolink.executors import Executor, SingleThreadedExecutor
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.tf2.buffer import Buffer

if TYPE_CHECKING:
    from robolink.node import Node

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"

DEPTH = 100
WHO = "default_authority"


class TransformListener:
    """Fills a buffer with the transforms that others publish, while something spins the node.

    With `spin_thread` a thread of its own spins it, all its callbacks, until the node is spun otherwise or the context
    ends; `executor` is what that thread spins.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: Node,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        self.node = node
        self._buffer: Any = None
        self.buffer = buffer
        latched = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.group = ReentrantCallbackGroup()
        self.tf_sub = node.create_subscription(
            TFMessage, tf_topic, self.callback, DEPTH if qos is None else qos, callback_group=self.group
        )
        self.tf_static_sub = node.create_subscription(
            TFMessage,
            tf_static_topic,
            self.static_callback,
            latched if static_qos is None else static_qos,
            callback_group=self.group,
        )
        # Both go on while a callback of the same executor waits for a transform.
        self.tf_sub.serves = self.tf_static_sub.serves = True
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.executor.add_node(node)
            self.dedicated_listener_thread = threading.Thread(
                target=_spin, args=(self.executor,), name="robolink tf listener", daemon=True
            )
            self.dedicated_listener_thread.start()

    @property
    def buffer(self) -> Any:
        """What is filled: a Buffer, or anything that has its set_transform and set_transform_static."""
        return self._buffer

    @buffer.setter
    def buffer(self, buffer: Any) -> None:
        if isinstance(self._buffer, Buffer):
            self._buffer.not_fed_by(self)
        self._buffer = buffer
        if isinstance(buffer, Buffer):
            buffer.fed_by(self)

    def callback(self, data: TFMessage) -> None:
        """Take in what moves."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, WHO)

    def static_callback(self, data: TFMessage) -> None:
        """Take in what stands still."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, WHO)

    def unregister(self) -> None:
        """Listen no longer. Safe to call twice."""
        self.node.destroy_subscription(self.tf_sub)
        self.node.destroy_subscription(self.tf_static_sub)


def _spin(executor: Executor) -> None:
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):  # the main thread is told of these
        try:
            executor.spin()
        except Exception as error:
            if not getattr(error, "__robolink_logged__", False):
                raise
