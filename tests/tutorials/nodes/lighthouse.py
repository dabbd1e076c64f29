"""Quality of service: a lighthouse that posts its rules before anybody reads them, and flashes to whoever looks."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data
from std_msgs.msg import String

POSTED = QoSProfile(
    reliability=QoSReliabilityPolicy.RELIABLE,
    durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
    history=QoSHistoryPolicy.KEEP_LAST,
    depth=2,
)


class Lighthouse(Node):
    def __init__(self):
        super().__init__('lighthouse')
        self.board = self.create_publisher(String, 'rules', POSTED)
        for number in range(4):
            self.board.publish(String(data=f'rule {number}'))
        self.light = self.create_publisher(String, 'flashes', qos_profile_sensor_data)
        self.create_timer(0.05, lambda: self.light.publish(String(data='flash')))
        self.get_logger().info('the rules are up')


def main():
    try:
        with rclpy.init():
            rclpy.spin(Lighthouse())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
