import math

import rclpy
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import Float32
from tf2_ros import Buffer, TransformException, TransformListener


class Distance(Node):
    def __init__(self):
        super().__init__("distance")
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        self.publisher = self.create_publisher(Float32, "distance", 10)
        self.timer = self.create_timer(0.5, self.tell)

    def tell(self):
        try:
            transform = self.buffer.lookup_transform("base_link", "goal", Time())
        except TransformException:
            return
        place = transform.transform.translation
        self.publisher.publish(Float32(data=math.hypot(place.x, place.y)))


def main():
    rclpy.init()
    rclpy.spin(Distance())


if __name__ == "__main__":
    main()
