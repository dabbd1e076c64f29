"""Driver: drives ahead while nothing is near."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.get_logger().info("waiting for scans")

    def on_scan(self, scan):
        twist = Twist()
        twist.linear.x = 0.3 if min(scan.ranges) > 0.5 else 0.0
        self.cmd_vel.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
