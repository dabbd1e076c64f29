#!/usr/bin/env python3
"""Warns when the wheel turns too fast."""

import rclpy
from my_robot.msg import WheelState
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class WheelWatcher(Node):

    def __init__(self):
        super().__init__('wheel_watcher')
        self.limit = self.declare_parameter('warn_above', 1.0).value
        self.declare_parameter('rate', 10.0)
        self.is_fast = False
        self.create_subscription(WheelState, 'wheel_state', self.look, 10)

    def look(self, state):
        was_fast, self.is_fast = self.is_fast, abs(state.speed) > self.limit
        if self.is_fast and not was_fast:
            self.get_logger().warn(f'too fast: {state.speed} rad/s')
        if was_fast and not self.is_fast:
            self.get_logger().info('slow again')


def main():
    try:
        with rclpy.init():
            rclpy.spin(WheelWatcher())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
