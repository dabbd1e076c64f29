import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameter("speed", 0.3)
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.timer = self.create_timer(0.1, self.drive)

    def drive(self):
        twist = Twist()
        twist.linear.x = self.get_parameter("speed").value
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Driver())


if __name__ == "__main__":
    main()
