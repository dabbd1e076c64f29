"""Publish velocities for a robot: faster and faster up to a top speed, then from standstill again."""

import contextlib
from typing import Any

import robolink
from robolink import Node, Parameter
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.parameters.descriptors import described

PERIOD = 0.4
"""Period of messages in seconds: less than the half second after which a robot stops without commands."""


class VelocityPublisher(Node):
    """A node that publishes a Twist on `cmd_vel` at each tick of its timer, each a little faster than the last."""

    is_driving = False

    def __init__(self, **options: Any) -> None:
        super().__init__("velocity_publisher", **options)
        self.declare_parameter("step", 0.1, described("m/s by which each message is faster", 0.0, 2.0))
        self.declare_parameter("top_speed", 1.0, described("m/s, the greatest speed ahead", 0.0, 10.0))
        self.declare_parameter("turn_speed", 0.0, described("rad/s, to the left if positive", -10.0, 10.0))
        period = self.declare_parameter("period", PERIOD, described("seconds from message to message", 0.01, 60.0))
        self.speed = 0.0
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(period.value, self.on_timer)
        self.add_post_set_parameters_callback(self.on_parameters)

    def on_timer(self) -> None:
        """Publish the speed, and compute the next."""
        twist = Twist()
        twist.linear.x = self.speed
        twist.angular.z = self.get_parameter("turn_speed").value
        self.cmd_vel.publish(twist)
        self.is_driving = True
        self.get_logger().info(f"{twist.linear.x:.2f} m/s ahead, turning at {twist.angular.z:.2f} rad/s")
        self.speed = next_speed(self.speed, self.get_parameter("step").value, self.get_parameter("top_speed").value)

    def on_parameters(self, changed: list[Parameter[Any]]) -> None:
        """Change the period of messages."""
        for each in changed:
            if each.name == "period":
                self.timer.timer_period_ns = round(each.value * 1e9)
                self.timer.reset()

    def destroy_node(self) -> None:
        """Stop the robot, which must not drive on without its node, then destroy the node."""
        if self.is_driving:
            self.is_driving = False
            with contextlib.suppress(RobolinkError):  # nobody may be there any more who could be told
                self.cmd_vel.publish(Twist())
        super().destroy_node()


def next_speed(speed: float, step: float, top_speed: float) -> float:
    """Return the speed after `speed`: a step more, or 0 if that is beyond the top.

    It is rounded, since ten times 0.1 is a little less than 1 for a computer.
    """
    faster = round(speed + step, 6)
    return faster if faster <= top_speed else 0.0


def main(args: list[str] | None = None) -> None:
    """Run the node until Ctrl-C, then stop the robot."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = VelocityPublisher()
        try:
            robolink.spin(node)
        finally:
            node.destroy_node()


if __name__ == "__main__":
    main()
