import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class TwoMetres(Node):
    def __init__(self):
        super().__init__("two_metres")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.begin = None
        self.create_subscription(Odometry, "odom", self.on_odom, 10)

    def on_odom(self, odom):
        twist = Twist()
        x = odom.pose.pose.position.x
        if self.begin is None:
            self.begin = x
        twist.linear.x = 0.4 if x - self.begin < 2.0 else 0.0
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(TwoMetres())


if __name__ == "__main__":
    main()
