"""Topics: one look at the kettle, and one at a topic that nobody uses."""

import rclpy
from rclpy.node import Node
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import String

rclpy.init()
guest = Node('guest')
for topic, patience in (('water', 30.0), ('milk', 0.1)):
    there, report = wait_for_message(String, guest, topic, time_to_wait=patience)
    guest.get_logger().info(f'{topic}: {there}, {type(report).__name__}')
rclpy.shutdown()
