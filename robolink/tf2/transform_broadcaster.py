"""Broadcaster of transforms that change."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.qos import QoSProfile

if TYPE_CHECKING:
    from robolink.node import BaseNode

DEPTH = 100
"""Default depth of the publisher, in messages."""


class TransformBroadcaster:
    """Publisher of transforms on /tf.

    Args:
        node: Node that publishes.
        qos: Profile or depth of the publisher; depth 100 by default.
    """

    def __init__(self, node: BaseNode, qos: QoSProfile | int | None = None) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", DEPTH if qos is None else qos)

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802 - tf2's name
        """Publish `transform`, one or several in one message."""
        self.pub_tf.publish(TFMessage(transforms=as_list(transform)))


def as_list(transform: TransformStamped | Iterable[TransformStamped]) -> list[TransformStamped]:
    """Return one transform, or several, as a list."""
    return list(transform) if isinstance(transform, Iterable) else [transform]
