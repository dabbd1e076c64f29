import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.serialization import deserialize_message

import rosbag2_py
from std_msgs.msg import String


class SimpleBagReader(Node):

    def __init__(self, bag_filename):
        super().__init__('simple_bag_reader')
        self.reader = rosbag2_py.SequentialReader()
        self.reader.open(
            rosbag2_py.StorageOptions(uri=bag_filename, storage_id='mcap'),
            rosbag2_py.ConverterOptions('', ''))
        self.publisher = self.create_publisher(String, 'heard', 10)
        self.timer = self.create_timer(0.1, self.timer_callback)

    def timer_callback(self):
        while self.reader.has_next():
            topic, data, stamp = self.reader.read_next()
            if topic != 'chatter':
                continue
            msg = deserialize_message(data, String)
            self.publisher.publish(msg)
            self.get_logger().info('(%s)' % msg.data)
            break


def main(args=None):
    try:
        with rclpy.init(args=args):
            rclpy.spin(SimpleBagReader(sys.argv[1]))
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
