"""Listener to /tf_static alone, under the name that it had in Kilted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.tf2.transform_listener import DEFAULT_STATIC_TF_TOPIC, DEFAULT_TF_TOPIC, TransformListener

if TYPE_CHECKING:
    from robolink.node import BaseNode
    from robolink.qos import QoSProfile
    from robolink.tf2.buffer import Buffer

__all__ = ["DEFAULT_STATIC_TF_TOPIC", "DEFAULT_TF_TOPIC", "StaticTransformListener"]


class StaticTransformListener(TransformListener):
    """TransformListener with `static_only`.

    Args:
        buffer: A Buffer, or any object with `set_transform_static`.
        node: Node that subscribes; None makes one.
        spin_thread: True spins the node in a thread of its own.
        static_qos: Profile or depth of the subscription; depth 100 and TRANSIENT_LOCAL by default.
        tf_static_topic: Topic of the static transforms.
    """

    def __init__(
        self,
        buffer: Buffer,
        node: BaseNode | None,
        *,
        spin_thread: bool = False,
        static_qos: QoSProfile | int | None = None,
        tf_static_topic: str = DEFAULT_STATIC_TF_TOPIC,
    ) -> None:
        super().__init__(
            buffer,
            node,
            spin_thread=spin_thread,
            static_qos=static_qos,
            tf_static_topic=tf_static_topic,
            static_only=True,
        )
