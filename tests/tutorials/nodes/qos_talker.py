"""Quality of service: says things before anybody listens, on a topic that keeps them."""

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data
from std_msgs.msg import String


class TalkerQos(Node):
    def __init__(self):
        super().__init__('talker_qos')
        latched = QoSProfile(
            depth=2,
            history=QoSHistoryPolicy.KEEP_LAST,
            reliability=QoSReliabilityPolicy.RELIABLE,
            durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
        )
        self.map = self.create_publisher(String, 'map', latched)
        for i in range(4):
            self.map.publish(String(data='Map %d' % i))
        self.get_logger().info('Published the map')
        self.i = 0
        self.pub = self.create_publisher(String, 'scan', qos_profile_sensor_data)
        self.tmr = self.create_timer(0.05, self.timer_callback)

    def timer_callback(self):
        self.i += 1
        self.pub.publish(String(data='Scan %d' % self.i))


def main(args=None):
    try:
        with rclpy.init(args=args):
            rclpy.spin(TalkerQos())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


if __name__ == '__main__':
    main()
