import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Safe(Node):
    def __init__(self):
        super().__init__("safe")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.timer = self.create_timer(0.1, self.look)

    def on_scan(self, scan):
        twist = Twist()
        twist.linear.x = 0.3 if min(scan.ranges) > 0.5 else 0.0
        self.publisher.publish(twist)

    def look(self):
        # {silent}
        pass


def main():
    rclpy.init()
    rclpy.spin(Safe())


if __name__ == "__main__":
    main()
