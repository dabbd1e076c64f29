"""Robot: publishes its map."""

import rclpy
from nav_msgs.msg import OccupancyGrid
from rclpy.node import Node


class Robot(Node):
    def __init__(self):
        super().__init__("robot")
        self.map = self.create_publisher(OccupancyGrid, "/map", 1)
        self.create_timer(0.1, lambda: self.map.publish(OccupancyGrid()))
        self.get_logger().info("there is a map")


def main():
    rclpy.init()
    rclpy.spin(Robot())


if __name__ == "__main__":
    main()
