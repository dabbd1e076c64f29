#!/usr/bin/env python3
"""Turns a wheel at the speed that a service sets."""

import rclpy
from my_robot.msg import WheelState
from my_robot.srv import SetSpeed
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from sensor_msgs.msg import JointState


class WheelDriver(Node):

    def __init__(self):
        super().__init__('wheel_driver')
        self.speed = self.declare_parameter('speed', 0.0).value
        self.fastest = self.declare_parameter('fastest', 1.0).value
        self.period = 1.0 / self.declare_parameter('rate', 10.0).value
        self.angle = 0.0
        self.states = self.create_publisher(WheelState, 'wheel_state', 10)
        self.joints = self.create_publisher(JointState, 'joint_states', 10)
        self.create_service(SetSpeed, 'set_speed', self.set_speed)
        self.create_timer(self.period, self.turn)
        self.get_logger().info(f'turning at {self.speed} rad/s')

    def set_speed(self, request, response):
        response.accepted = abs(request.speed) <= self.fastest
        if response.accepted:
            self.speed = request.speed
        else:
            response.reason = f'{self.fastest} rad/s is the limit'
        return response

    def turn(self):
        self.angle += self.speed * self.period
        state = WheelState(angle=self.angle, speed=self.speed)
        state.header.stamp = self.get_clock().now().to_msg()
        self.states.publish(state)
        self.joints.publish(JointState(header=state.header, name=['axle'], position=[self.angle]))


def main():
    try:
        with rclpy.init():
            rclpy.spin(WheelDriver())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
