"""Services: has two things weighed, whose grams are its arguments."""

import sys

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class Grocer(Node):
    def __init__(self, *grams):
        super().__init__('grocer')
        self.scales = self.create_client(AddTwoInts, 'weigh')
        self.order = AddTwoInts.Request(a=grams[0], b=grams[1])

    def ask(self):
        while not self.scales.wait_for_service(timeout_sec=1.0):
            self.get_logger().warning('where are the scales?')
        return self.scales.call_async(self.order)


if __name__ == '__main__':
    rclpy.init()
    grocer = Grocer(*map(int, sys.argv[1:]))
    weight = grocer.ask()
    rclpy.spin_until_future_complete(grocer, weight)
    grocer.get_logger().info(f'together they weigh {weight.result().sum} g')
    grocer.destroy_node()
    rclpy.shutdown()
