import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class MapServer(Node):
    def __init__(self):
        super().__init__("map_server")
        # {qos}
        self.publisher = self.create_publisher(String, "map_name", 10)
        self.publisher.publish(String(data="classroom"))


def main():
    rclpy.init()
    rclpy.spin(MapServer())


if __name__ == "__main__":
    main()
