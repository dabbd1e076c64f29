"""Hasty: drives on until something is near, and turns away."""

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan


class Hasty(Node):
    def __init__(self) -> None:
        super().__init__("hasty")
        self.declare_parameter("near", 0.5)
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        twist = Twist()
        if min(scan.ranges) > self.get_parameter("near").value:
            twist.linear.x = 0.5
        else:
            twist.angular.z = 1.0
        self.cmd_vel.publish(twist)
