"""Quality of service: a ship that comes late, reads the rules and sees flashes, SIGHTS in all: ship.py -s SIGHTS."""

import argparse
import sys

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rclpy.utilities import remove_ros_args
from std_msgs.msg import String


def main():
    parser = argparse.ArgumentParser(description='Sails past the lighthouse.')
    parser.add_argument('-s', '--sights', type=int, default=20)
    wanted = parser.parse_args(remove_ros_args(sys.argv)[1:]).sights
    rclpy.init(args=sys.argv)
    ship = rclpy.create_node('ship')
    log = ship.get_logger().info
    posted = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    for topic, quality in {'rules': posted, 'flashes': qos_profile_sensor_data}.items():
        ship.create_subscription(String, topic, lambda sight: log('saw ' + sight.data), quality)
    for _ in range(wanted):
        rclpy.spin_once(ship)
    log('past it')
    ship.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
