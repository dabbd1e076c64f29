"""Services: scales that add what lies in their two pans."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Scales(Node):
    weighings = 0

    def weigh(self, pans, answer):
        self.weighings += 1
        answer.sum = pans.a + pans.b
        self.get_logger().info(f'weighing {self.weighings}:\nleft {pans.a}, right {pans.b}')
        return answer


def main():
    try:
        with rclpy.init():
            scales = Scales('scales')
            scales.create_service(AddTwoInts, 'weigh', scales.weigh)
            rclpy.spin(scales)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
