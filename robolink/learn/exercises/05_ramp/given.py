import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class RobotPublisher(Node):
    def __init__(self):
        super().__init__("robot_publisher")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(0.5, self.publish_speed)
        self.speed = 0.0

    def publish_speed(self):
        twist = Twist()
        twist.linear.x = self.speed
        self.publisher.publish(twist)
        self.speed = 0.1
        # {again}


def main():
    rclpy.init()
    rclpy.spin(RobotPublisher())


if __name__ == "__main__":
    main()
