"""tf2: has a second turtle let in, which swims to the frame of the parameter."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import TransformException
from tf2_ros.buffer import Buffer
from tf2_ros.transform_listener import TransformListener
from turtlesim.srv import Spawn


class Chaser(Node):
    def __init__(self):
        super().__init__('chaser')
        self.declare_parameter('prey', 'turtle1')
        self.map = Buffer()
        self.ears = TransformListener(self.map, self)
        self.gate = self.create_client(Spawn, 'spawn')
        self.fins = self.create_publisher(Twist, 'turtle2/cmd_vel', 1)
        self.waiting = self.create_timer(0.05, self.enter)
        self.entry = None

    def enter(self):
        if not self.gate.service_is_ready():
            self.get_logger().info('the gate is shut', throttle_duration_sec=1.0)
            return
        self.waiting.cancel()
        self.entry = self.gate.call_async(Spawn.Request(name='turtle2', x=4.0, y=2.0))
        self.entry.add_done_callback(lambda entry: self.get_logger().info(f'{entry.result().name} is in the pond'))
        self.create_timer(0.05, self.chase)

    def chase(self):
        prey = self.get_parameter('prey').value
        try:
            way = self.map.lookup_transform('turtle2', prey, Time()).transform.translation
        except TransformException as reason:
            self.get_logger().info(f'no way to {prey}: {reason}', throttle_duration_sec=1.0)
            return
        twist = Twist()
        twist.linear.x = 3 * math.hypot(way.x, way.y)
        twist.angular.z = 2 * math.atan2(way.y, way.x)
        self.fins.publish(twist)


def main():
    rclpy.init()
    try:
        rclpy.spin(Chaser())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
