"""Has a slip of the pen."""

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Maze(Node):
    def __init__(self):
        super().__init__("maze")
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        twist = Twist()
        twist.linear.x = 0.2
        self.cmd_vel.publish(twits)


def main():
    rclpy.init()
    rclpy.spin(Maze())


if __name__ == "__main__":
    main()
