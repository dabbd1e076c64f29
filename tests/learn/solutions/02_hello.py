import rclpy
from rclpy.node import Node


class FirstNode(Node):
    def __init__(self):
        super().__init__("first_node")
        self.get_logger().info("hello")


def main():
    rclpy.init()
    node = FirstNode()
    rclpy.spin(node)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
