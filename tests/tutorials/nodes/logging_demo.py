"""Logging: levels, once, throttled and the first left out."""

import rclpy
import rclpy.logging
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class LoggerUsage(Node):
    def __init__(self):
        super().__init__('logger_usage_demo')
        self.count = 0
        self.timer = self.create_timer(0.1, self.on_timer)

    def on_timer(self):
        logger = self.get_logger()
        logger.info('Timer callback called (this will only log once)', once=True)
        logger.info('Timer callback called %d times' % self.count)
        logger.debug('Count is even' if self.count % 2 == 0 else 'Count is odd')
        logger.warn('Skips the first', skip_first=True)
        logger.error('Modulo is %d' % (self.count % 3), throttle_duration_sec=100.0)
        self.count += 1
        if self.count == 3:
            rclpy.logging.set_logger_level('logger_usage_demo', rclpy.logging.LoggingSeverity.WARN)
        if self.count == 4:
            logger.info('Not to be seen')
            logger.fatal('That was all')


def main(args=None):
    rclpy.init(args=args)
    try:
        rclpy.spin(LoggerUsage())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
