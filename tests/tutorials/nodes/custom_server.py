"""A service and a topic of types of one's own."""

import rclpy
from geometry_msgs.msg import Point
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from tutorial_interfaces.msg import Num, Sphere
from tutorial_interfaces.srv import AddThreeInts


class CustomServer(Node):
    def __init__(self):
        super().__init__('custom_server')
        self.srv = self.create_service(AddThreeInts, 'add_three_ints', self.on_request)
        self.num_publisher = self.create_publisher(Num, 'sums', 10)
        self.sphere_publisher = self.create_publisher(Sphere, 'spheres', 10)

    def on_request(self, request, response):
        response.sum = request.a + request.b + request.c
        self.num_publisher.publish(Num(num=response.sum))
        self.sphere_publisher.publish(Sphere(center=Point(x=1.0, y=2.0), radius=float(response.sum)))
        return response


def main(args=None):
    try:
        with rclpy.init(args=args):
            rclpy.spin(CustomServer())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
