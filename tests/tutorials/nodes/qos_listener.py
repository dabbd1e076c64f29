"""Quality of service: comes late, hears what was kept, and the scans in best effort: qos_listener.py -n CYCLES."""

import argparse
import sys

import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


class ListenerQos(Node):
    def __init__(self):
        super().__init__('listener_qos')
        latched = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.map_sub = self.create_subscription(String, 'map', self.chatter_callback, latched)
        self.sub = self.create_subscription(String, 'scan', self.chatter_callback, qos_profile_sensor_data)

    def chatter_callback(self, msg):
        self.get_logger().info('I heard: [%s]' % msg.data)


def main(argv=sys.argv[1:]):
    parser = argparse.ArgumentParser()
    parser.add_argument('-n', '--number_of_cycles', type=int, default=20)
    args = parser.parse_args(remove_ros_args(args=argv))
    rclpy.init(args=argv)
    node = ListenerQos()
    cycle_count = 0
    while rclpy.ok() and cycle_count < args.number_of_cycles:
        rclpy.spin_once(node)
        cycle_count += 1
    node.get_logger().info('Enough')
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
