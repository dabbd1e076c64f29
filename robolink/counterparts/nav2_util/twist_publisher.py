"""Publisher of speeds as Nav2's servers have it: a Twist, or with `enable_stamped_cmd_vel` a TwistStamped."""

from __future__ import annotations

from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from robolink.lifecycle import LifecycleNode
from robolink.parameters.descriptors import described

PARAMETER = "enable_stamped_cmd_vel"


class TwistPublisher:
    """Publisher of the topic cmd_vel of a managed node; what is published while that is not active is dropped.

    Args:
        node: The node.
        topic: Name of the topic.
        frame: Frame of the robot, for what is stamped.
    """

    def __init__(self, node: LifecycleNode, topic: str, frame: str) -> None:
        if not node.has_parameter(PARAMETER):
            node.declare_parameter(PARAMETER, False, described("publish TwistStamped instead of Twist"))
        self._node, self._frame = node, frame
        self._is_stamped = bool(node.get_parameter(PARAMETER).value)
        self._publisher = node.create_lifecycle_publisher(TwistStamped if self._is_stamped else Twist, topic, 1)

    def publish(self, v: float, w: float) -> None:
        """Publish speeds: m/s ahead, rad/s to the left."""
        twist = Twist()
        twist.linear.x, twist.angular.z = v, w
        if not self._is_stamped:
            self._publisher.publish(twist)
            return
        stamped = TwistStamped(twist=twist)
        stamped.header.stamp, stamped.header.frame_id = self._node.get_clock().now().to_msg(), self._frame
        self._publisher.publish(stamped)

    def stop(self) -> None:
        """Publish that the robot is to stand."""
        self.publish(0.0, 0.0)

    def destroy(self) -> None:
        """Withdraw the topic."""
        self._node.destroy_lifecycle_publisher(self._publisher)
