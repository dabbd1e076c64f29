"""A service whose callback raises."""

import rclpy
from probe import say
from std_srvs.srv import Trigger

rclpy.init()
n = rclpy.create_node("n17")


def cb(q, r):
    raise ValueError("in service")


n.create_service(Trigger, "s17", cb)
c = n.create_client(Trigger, "s17")
c.wait_for_service(2)
f = c.call_async(Trigger.Request())
say("before")
rclpy.spin_until_future_complete(n, f, timeout_sec=2)
say("not reached")
