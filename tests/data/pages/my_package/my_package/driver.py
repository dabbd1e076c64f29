"""Driver: drives straight on at a speed that its launch file gives it."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameter("speed", 0.2)
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.drive)
        self.get_logger().info(f"driving at {self.get_parameter('speed').value} m/s")

    def drive(self):
        twist = Twist()
        twist.linear.x = self.get_parameter("speed").value
        self.cmd_vel.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Driver())
