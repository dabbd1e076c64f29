import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class ReactiveControl(Node):
    def __init__(self):
        super().__init__("reactive_control")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.timer = self.create_timer(0.1, self.control)
        self.ahead = 0.0

    def on_scan(self, scan):
        middle = len(scan.ranges) // 2
        self.ahead = min(r for r in scan.ranges[middle - 30 : middle + 30] if r > 0)

    def control(self):
        twist = Twist()
        if self.ahead < 1.0:
            twist.angular.z = 0.5
        else:
            twist.linear.x = 0.3
        self.publisher.publish(twist)


def main():
    rclpy.init()
    rclpy.spin(ReactiveControl())


if __name__ == "__main__":
    main()
