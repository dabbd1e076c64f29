import rclpy
from rclpy.node import Node


class FirstNode(Node):
    def __init__(self):
        super().__init__("node")
        # {hello}


def main():
    rclpy.init()
    node = FirstNode()
    # {spin}
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
