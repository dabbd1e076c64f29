"""Parameters: a caretaker who hears of every change, at the lamp and at himself."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_event_handler import ParameterEventHandler


class Caretaker(rclpy.node.Node):
    def __init__(self, **options):
        super().__init__('caretaker', **options)
        self.rounds = self.declare_parameter('rounds', 0)
        self.events = ParameterEventHandler(self)
        self.watched = [
            self.events.add_parameter_callback('colour', 'lamp', self.changed),
            self.events.add_parameter_callback(parameter_name='rounds', node_name='caretaker', callback=self.changed),
        ]
        self.create_timer(0.3, self.walk)

    def walk(self):
        walked = self.get_parameter('rounds').value + 1
        self.set_parameters([Parameter('rounds', value=walked)])

    def changed(self, parameter):
        now = parameter_value_to_python(parameter.value)
        self.get_logger().info(f'{parameter.name} is {now} now')


def main():
    try:
        with rclpy.init():
            rclpy.spin(Caretaker())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
