import rclpy
from rclpy.node import Node
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float32


class SensorSubscriber(Node):
    def __init__(self):
        super().__init__("sensor_subscriber")
        self.publisher = self.create_publisher(Float32, "nearest", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan):
        nearest = min(r for r in scan.ranges if r > 0)
        self.publisher.publish(Float32(data=nearest))


def main():
    rclpy.init()
    rclpy.spin(SensorSubscriber())


if __name__ == "__main__":
    main()
