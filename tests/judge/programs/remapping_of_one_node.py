# args: --ros-args -r n59:/c:=/only -r n59:~/d:=/priv -r "/abs:=rel"

"""Remapping rules for one node, with absolute, private and relative names."""

import rclpy
from std_msgs.msg import String

rclpy.init()
n = rclpy.create_node("n59")
m = rclpy.create_node("m59")
print(
    n.create_publisher(String, "/c", 1).topic_name,
    m.create_publisher(String, "/c", 1).topic_name,
    n.create_publisher(String, "~/d", 1).topic_name,
    m.create_publisher(String, "~/d", 1).topic_name,
    n.create_publisher(String, "abs", 1).topic_name,
)
