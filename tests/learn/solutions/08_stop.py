import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Careful(Node):
    def __init__(self):
        super().__init__("careful")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        middle = len(scan.ranges) // 2
        ahead = min(scan.ranges[middle - 30 : middle + 30])
        twist = Twist()
        twist.linear.x = 0.3 if ahead > 0.6 else 0.0
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(Careful())


if __name__ == "__main__":
    main()
