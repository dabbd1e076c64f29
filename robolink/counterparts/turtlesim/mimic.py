"""mimic: drives a turtle as another one swims; input/pose is the one's, output/cmd_vel the other's."""

from __future__ import annotations

import math
from typing import Any

from robolink import Node
from robolink.counterparts.turtlesim.turtlesim_node import DEPTH
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.turtlesim.msg import Pose


class Mimic(Node):
    """A node that sends the speeds of a turtle as the command of another one."""

    def __init__(self, **options: Any) -> None:
        super().__init__("turtle_mimic", **options)
        self.cmd_vel = self.create_publisher(Twist, "output/cmd_vel", DEPTH)
        self.create_subscription(Pose, "input/pose", self.on_pose, DEPTH)

    def on_pose(self, pose: Pose) -> None:
        """Command the speeds of the pose, unless they are not finite."""
        if not (math.isfinite(pose.linear_velocity) and math.isfinite(pose.angular_velocity)):
            self.get_logger().warning("ignored a pose whose speeds are not finite", once=True)
            return
        twist = Twist()
        twist.linear.x, twist.angular.z = pose.linear_velocity, pose.angular_velocity
        self.cmd_vel.publish(twist)
