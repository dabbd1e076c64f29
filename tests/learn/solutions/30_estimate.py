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
        if self.publisher.get_subscription_count() == 0:
            return
        message = PoseWithCovarianceStamped()
        message.header.frame_id = "map"
        message.header.stamp = self.get_clock().now().to_msg()
        message.pose.pose.position.x = 2.0
        message.pose.pose.position.y = 1.0
        message.pose.pose.orientation.z = math.sin(math.pi / 4)
        message.pose.pose.orientation.w = math.cos(math.pi / 4)
        message.pose.covariance[0] = 0.25
        message.pose.covariance[7] = 0.25
        message.pose.covariance[35] = 0.07
        self.publisher.publish(message)
        self.timer.cancel()


def main():
    rclpy.init()
    rclpy.spin(Estimate())


if __name__ == "__main__":
    main()
