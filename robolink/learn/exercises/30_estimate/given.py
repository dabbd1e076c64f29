import math

import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from rclpy.node import Node


class Estimate(Node):
    def __init__(self):
        super().__init__("estimate")
        self.publisher = self.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)
        self.timer = self.create_timer(0.5, self.tell)

    def tell(self):
        # {once}
        message = PoseWithCovarianceStamped()
        # {pose}
        self.publisher.publish(message)


def main():
    rclpy.init()
    rclpy.spin(Estimate())


if __name__ == "__main__":
    main()
