"""The counts of the other end, and wait_for_all_acked."""

import time

import rclpy
from probe import show, until
from rclpy.duration import Duration
from rclpy.qos import *
from std_msgs.msg import String

rclpy.init()
n = rclpy.create_node("n94")
m = rclpy.create_node("m94")
p = n.create_publisher(String, "t94", 10)
show("none", p.get_subscription_count)
s = [m.create_subscription(String, "t94", lambda x: None, 10) for _ in range(2)]
until(n, lambda: p.get_subscription_count() == 2, 2)
show("two", p.get_subscription_count)
show("pubs", s[0].get_publisher_count)
p.publish(String())
show("acked", lambda: p.wait_for_all_acked(Duration(seconds=1)))
show("acked float", lambda: p.wait_for_all_acked(1.0))
m.destroy_subscription(s[0])
until(n, lambda: p.get_subscription_count() == 1, 2)
show("one", p.get_subscription_count)
m.destroy_node()
until(n, lambda: p.get_subscription_count() == 0, 2)
show("zero after destroy_node", p.get_subscription_count)
b = n.create_publisher(String, "b94", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
show("acked best effort", lambda: b.wait_for_all_acked(Duration(seconds=1)))
show("assert_liveliness node", lambda: n.assert_liveliness() if hasattr(n, "assert_liveliness") else "none")
show("qos_profile of pub", lambda: p.qos_profile.depth if hasattr(p, "qos_profile") else "none")
show("qos of sub", lambda: s[1].qos_profile.depth)
show("from int", lambda: n.create_subscription(String, "x94", print, 7).qos_profile.depth)
