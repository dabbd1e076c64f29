"""Monitoring for parameter changes, also those of another node."""

import rclpy
import rclpy.node
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import parameter_value_to_python
from rclpy.parameter_event_handler import ParameterEventHandler


class NodeWithParameters(rclpy.node.Node):
    def __init__(self):
        super().__init__('node_with_parameters')
        self.declare_parameter('an_int_param', 0)
        self.handler = ParameterEventHandler(self)
        self.callback_handle = self.handler.add_parameter_callback(
            parameter_name='an_int_param', node_name='node_with_parameters', callback=self.callback
        )
        self.other_handle = self.handler.add_parameter_callback(
            parameter_name='my_parameter', node_name='minimal_param_node', callback=self.callback
        )

    def callback(self, p):
        self.get_logger().info(f'Received an update to parameter: {p.name}: {parameter_value_to_python(p.value)}')


def main():
    try:
        with rclpy.init():
            rclpy.spin(NodeWithParameters())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
