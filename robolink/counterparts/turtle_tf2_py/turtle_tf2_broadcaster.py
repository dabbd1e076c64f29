"""turtle_tf2_broadcaster: publishes the pose of the turtle `turtlename` as a transform from the frame world."""

from __future__ import annotations

import math
from typing import Any

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.turtlesim.msg import Pose
from robolink.tf2 import TransformBroadcaster

WORLD = "world"
"""Frame of the window."""


class FramePublisher(Node):
    """A node that makes a frame of a turtle."""

    def __init__(self, **options: Any) -> None:
        super().__init__("turtle_tf2_frame_publisher", **options)
        self.turtle: str = self.declare_parameter("turtlename", "turtle").value
        self.broadcaster = TransformBroadcaster(self)
        self.create_subscription(Pose, f"/{self.turtle}/pose", self.on_pose, 1)

    def on_pose(self, pose: Pose) -> None:
        """Publish the transform of a pose, unless it is not finite."""
        if not all(map(math.isfinite, (pose.x, pose.y, pose.theta))):
            self.get_logger().warning("ignored a pose that is not finite", once=True)
            return
        transform = TransformStamped(child_frame_id=self.turtle)
        transform.header.frame_id, transform.header.stamp = WORLD, self.get_clock().now().to_msg()
        moved, turned = transform.transform.translation, transform.transform.rotation
        moved.x, moved.y = pose.x, pose.y
        turned.z, turned.w = math.sin(pose.theta / 2), math.cos(pose.theta / 2)
        self.broadcaster.sendTransform(transform)
