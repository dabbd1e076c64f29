import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node


class TwoMetres(Node):
    def __init__(self):
        super().__init__("two_metres")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Odometry, "odom", self.on_odom, 10)

    def on_odom(self, odom):
        twist = Twist()
        # {enough}
        twist.linear.x = 0.4
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(TwoMetres())


if __name__ == "__main__":
    main()
