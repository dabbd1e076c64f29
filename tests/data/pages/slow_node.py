"""Node whose callback takes as long as five messages of /scan need: it drops some."""

import time

import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class SlowNode(Node):
    def __init__(self):
        super().__init__("slow_node")
        self.create_subscription(LaserScan, "scan", lambda scan: time.sleep(0.5), 1)


def main():
    rclpy.init()
    rclpy.spin(SlowNode())


if __name__ == "__main__":
    main()
