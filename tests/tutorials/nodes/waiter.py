"""Waits for one message of a topic."""

import rclpy
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import String

rclpy.init()
node = Node('waiter')
found, message = wait_for_message(String, node, 'topic', time_to_wait=30.0)
node.get_logger().info('%s: %s' % (found, message.data[:11]))
found, message = wait_for_message(String, node, 'silence', time_to_wait=0.1)
node.get_logger().info('%s: %s' % (found, message))
rclpy.shutdown()
