"""Student: drives its own robot."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Student(Node):
    def __init__(self):
        super().__init__("student")
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, lambda: self.cmd_vel.publish(Twist()))
        self.get_logger().info("it drives")


def main():
    rclpy.init()
    rclpy.spin(Student())


if __name__ == "__main__":
    main()
