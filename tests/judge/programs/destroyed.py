"""Calls to things that have been destroyed, wrong thresholds of jumps, and the timeout of a shutdown."""

import threading
import time

import rclpy
from probe import show
from rclpy.clock import JumpThreshold
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import Trigger

rclpy.init()
n = rclpy.create_node("n110")
c = n.create_client(Trigger, "s110")
p = n.create_publisher(String, "t110", 1)
s = n.create_subscription(String, "t110", print, 1)
t = n.create_timer(1.0, lambda: None)
g = n.create_guard_condition(lambda: None)
n.destroy_client(c)
n.destroy_publisher(p)
n.destroy_subscription(s)
n.destroy_timer(t)
n.destroy_guard_condition(g)
show("wait", lambda: c.wait_for_service(0.1))
show("ready", c.service_is_ready)
show("call", lambda: c.call_async(Trigger.Request()))
show("subscriptions", p.get_subscription_count)
show("publish", lambda: p.publish(String()))
show("acknowledged", lambda: p.wait_for_all_acked(Duration(seconds=0.1)))
show("liveliness", p.assert_liveliness)
show("publishers", s.get_publisher_count)
show("canceled", t.is_canceled)
show("timer ready", t.is_ready)
show("period", lambda: t.timer_period_ns)
show("trigger", g.trigger)
show("topic name", lambda: p.topic_name)
m = rclpy.create_node("m110")
m.destroy_node()
show("name", m.get_name)
show("namespace", m.get_namespace)
show("full name", m.get_fully_qualified_name)
show("topics", m.get_topic_names_and_types)
show("nodes", m.get_node_names)
show("count", lambda: m.count_publishers("t"))
show("clock", lambda: m.get_clock() is not None)
show("logger", lambda: m.get_logger() is not None)
show("again", m.destroy_node)

show("threshold", lambda: n.get_clock().create_jump_callback(3, pre_callback=print))
show(
    "jump by a number",
    lambda: n.get_clock().create_jump_callback(
        JumpThreshold(min_forward=3, min_backward=None, on_clock_change=True), pre_callback=print
    ),
)

e = MultiThreadedExecutor(2)
e.add_node(n)
n.create_timer(0.05, lambda: time.sleep(0.5))
thread = threading.Thread(target=e.spin)
thread.start()
time.sleep(0.2)
begin = time.monotonic()
show("shutdown within 0.1 s", lambda: e.shutdown(timeout_sec=0.1))
show("it took so long", lambda: time.monotonic() - begin < 0.25)
thread.join()
