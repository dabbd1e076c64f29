"""Drives on until a wall is near, and turns to the left: it goes round and round."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Maze(Node):
    def __init__(self):
        super().__init__("maze")
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        twist = Twist()
        ahead = min(scan.ranges[len(scan.ranges) // 2 - 25 : len(scan.ranges) // 2 + 25])
        if ahead > 0.4:
            twist.linear.x = 0.3
        else:
            twist.angular.z = 0.8
        self.cmd_vel.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Maze())


if __name__ == "__main__":
    main()
