"""Broadcaster of static transforms: sent once, and kept for late subscriptions."""

from __future__ import annotations

from collections.abc import Iterable
from copy import deepcopy
from typing import TYPE_CHECKING

from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.tf2.transform_broadcaster import as_list

if TYPE_CHECKING:
    from robolink.node import BaseNode


class StaticTransformBroadcaster:
    """Publisher of transforms on /tf_static; each message has all that were ever sent, the newest of each child frame.

    Args:
        node: Node that publishes.
        qos: Profile or depth of the publisher; depth 1 and TRANSIENT_LOCAL by default.
    """

    def __init__(self, node: BaseNode, qos: QoSProfile | int | None = None) -> None:
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", latched if qos is None else qos)
        self.net_message = TFMessage()

    def sendTransform(self, transform: TransformStamped | Iterable[TransformStamped]) -> None:  # noqa: N802 - tf2's name
        """Publish `transform`, one or several; it replaces an earlier one of the same child frame."""
        retained = {each.child_frame_id: each for each in self.net_message.transforms}
        retained.update({each.child_frame_id: deepcopy(each) for each in as_list(transform)})
        self.net_message.transforms = list(retained.values())
        self.pub_tf.publish(self.net_message)
