"""Logging: levels, and what is said once, now and then, or not at first."""

import rclpy
import rclpy.logging
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Diary(Node):
    def __init__(self):
        super().__init__('diary')
        self.day = 0
        self.create_timer(0.1, self.write)

    def write(self):
        pen, self.day = self.get_logger(), self.day + 1
        pen.info('dear diary', once=True)
        pen.info(f'day {self.day}')
        pen.debug('odd' if self.day % 2 else 'even')
        pen.warn('the same again', skip_first=True)
        pen.error('the roof leaks', throttle_duration_sec=100.0)
        if self.day == 3:
            rclpy.logging.set_logger_level(pen.name, rclpy.logging.LoggingSeverity.WARN)
            pen.info('a secret')
            pen.fatal('the end')


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(Diary())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
