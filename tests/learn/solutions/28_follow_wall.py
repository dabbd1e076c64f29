import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class WallFollower(Node):
    def __init__(self):
        super().__init__("follow_wall")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        right = min(r for r in scan.ranges[0:60] if 0 < r < 10)
        ahead = min(r for r in scan.ranges[70:111] if 0 < r < 10)
        twist = Twist()
        if ahead < 0.7:
            twist.angular.z = 0.5
        else:
            twist.linear.x = 0.3
            twist.angular.z = max(-0.6, min(0.6, -2.0 * (right - 0.5)))
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(WallFollower())


if __name__ == "__main__":
    main()
