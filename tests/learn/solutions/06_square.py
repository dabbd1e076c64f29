import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Square(Node):
    def __init__(self):
        super().__init__("square")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.tick)
        self.ticks = 0

    def tick(self):
        twist = Twist()
        part = self.ticks // 20
        if part < 8 and part % 2 == 0:
            twist.linear.x = 0.5
        elif part < 8:
            twist.angular.z = math.pi / 4
        self.publisher.publish(twist)
        self.ticks += 1


def main():
    rclpy.init()
    rclpy.spin(Square())


if __name__ == "__main__":
    main()
