"""Asks for a sum of three and hears of it in messages of one's own."""

import rclpy
from rclpy.node import Node
from tutorial_interfaces.msg import Num, Sphere
from tutorial_interfaces.srv import AddThreeInts


class CustomClient(Node):
    def __init__(self):
        super().__init__('custom_client')
        self.heard = 0
        self.create_subscription(Num, 'sums', self.on_num, 10)
        self.create_subscription(Sphere, 'spheres', self.on_sphere, 10)
        self.cli = self.create_client(AddThreeInts, 'add_three_ints')
        self.cli.wait_for_service()

    def on_num(self, msg):
        self.heard += 1
        self.get_logger().info('The sum is %d' % msg.num)

    def on_sphere(self, msg):
        self.heard += 1
        self.get_logger().info('A sphere at x=%.1f of radius %.1f' % (msg.center.x, msg.radius))


def main(args=None):
    with rclpy.init(args=args):
        node = CustomClient()
        future = node.cli.call_async(AddThreeInts.Request(a=1, b=2, c=3))
        rclpy.spin_until_future_complete(node, future)
        node.get_logger().info('Answered: %d' % future.result().sum)
        while rclpy.ok() and node.heard < 2:
            rclpy.spin_once(node)


if __name__ == '__main__':
    main()
