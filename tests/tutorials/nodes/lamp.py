"""Parameters: a lamp that is white again soon, whatever colour it was given."""

import rclpy
import rclpy.node
from rcl_interfaces.msg import ParameterDescriptor
from rclpy.executors import ExternalShutdownException


class Lamp(rclpy.node.Node):
    def __init__(self):
        super().__init__('lamp')
        about = ParameterDescriptor(description='of the light')
        self.declare_parameter('colour', 'white', about)
        self.create_timer(0.2, self.shine)

    @property
    def colour(self):
        return self.get_parameter('colour').get_parameter_value().string_value

    def shine(self):
        self.get_logger().info(f'shines {self.colour}')
        white = rclpy.parameter.Parameter('colour', rclpy.Parameter.Type.STRING, 'white')
        for answer in self.set_parameters([white]):
            assert answer.successful, answer.reason


def main():
    try:
        with rclpy.init():
            rclpy.spin(Lamp())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
