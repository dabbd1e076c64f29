import rclpy
from rclpy.node import Node


class Counter(Node):
    def __init__(self):
        super().__init__("counter")
        self.count = 0
        self.timer = self.create_timer(1.0, self.tick)

    def tick(self):
        self.count += 1
        self.get_logger().info(f"count {self.count}")


def main():
    rclpy.init()
    rclpy.spin(Counter())


if __name__ == "__main__":
    main()
