"""Listener to /tf and /tf_static, which fills a buffer."""

from __future__ import annotations

import contextlib
import itertools
import threading
from typing import TYPE_CHECKING, Any, cast

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.exceptions import ExternalShutdownException
from robolink.executors import Executor, SingleThreadedExecutor
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.parameter import Parameter
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.tf2.buffer import Buffer

if TYPE_CHECKING:
    from robolink.node import BaseNode, Node

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"

DEPTH = 100
"""Default depth of the subscriptions, in messages."""
WHO = "default_authority"
"""Authority of all transforms that come from the network."""


class TransformListener:
    """Listener that fills a buffer with published transforms while its node is spun.

    Args:
        buffer: A Buffer, or any object with `set_transform` and `set_transform_static`.
        node: Node that subscribes. None makes one, `node`, which a thread of its own spins: upstream's is spun by
            nobody unless `spin_thread` says so.
        spin_thread: True spins the node, with all its callbacks, in a thread of its own, until the node is spun
            otherwise or the context ends; `executor` is that thread's.
        qos: Profile or depth of the subscription to `tf_topic`; depth 100 by default.
        static_qos: Profile or depth of the subscription to `tf_static_topic`; depth 100 and TRANSIENT_LOCAL by default.
        tf_topic: Topic of the transforms that change.
        tf_static_topic: Topic of the static transforms.
        static_only: True leaves `tf_topic` out.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: BaseNode | None,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = DEFAULT_TF_TOPIC,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
        static_only: bool = False,
    ) -> None:
        spin_thread = spin_thread or node is None
        self._own = node is None
        self.node = node = _node() if node is None else node
        self._buffer: Any = None
        self.buffer = buffer
        latched = QoSProfile(depth=DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.group = ReentrantCallbackGroup()
        if not static_only:
            self.tf_sub = node.create_subscription(
                TFMessage, tf_topic, self.callback, DEPTH if qos is None else qos, **node._in_group_(self.group)
            )
            self.tf_sub.serves = True  # it goes on while a callback of the same executor waits for a transform
        self.tf_static_sub = node.create_subscription(
            TFMessage,
            tf_static_topic,
            self.static_callback,
            latched if static_qos is None else static_qos,
            **node._in_group_(self.group),
        )
        self.tf_static_sub.serves = True
        if spin_thread:
            self.executor = SingleThreadedExecutor(context=node.context)
            self.executor.add_node(cast("Node", node))  # TypeError for an AsyncNode
            self.dedicated_listener_thread = threading.Thread(
                target=_spin, args=(self.executor,), name="robolink tf listener", daemon=True
            )
            self.dedicated_listener_thread.start()

    @property
    def buffer(self) -> Any:
        """The buffer that is filled: a Buffer, or any object with set_transform and set_transform_static."""
        return self._buffer

    @buffer.setter
    def buffer(self, buffer: Any) -> None:
        if isinstance(self._buffer, Buffer):
            self._buffer.remove_source(self)
        self._buffer = buffer
        if isinstance(buffer, Buffer):
            buffer.add_source(self)

    def callback(self, data: TFMessage) -> None:
        """Insert the transforms of the message `data` into the buffer."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, WHO)

    def static_callback(self, data: TFMessage) -> None:
        """Insert the static transforms of the message `data` into the buffer."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, WHO)

    def unregister(self) -> None:
        """Destroy the subscriptions, and the node and its thread if it made them. Safe to call twice."""
        if hasattr(self, "tf_sub"):
            self.node.destroy_subscription(self.tf_sub)
        self.node.destroy_subscription(self.tf_static_sub)
        if self._own:
            self.executor.shutdown()
            self.node.destroy_node()


_numbers = itertools.count()


def _node() -> Node:
    """Return a node of a listener's own. Upstream numbers them by addresses, which no run repeats."""
    from robolink.node import Node

    return Node(
        f"transform_listener_impl_{next(_numbers):010x}",
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("use_sim_time", value=False)],
    )


def _spin(executor: Executor) -> None:
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):  # the main thread is told of these
        executor.spin()
