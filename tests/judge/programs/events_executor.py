"""The EventsExecutor of rclpy.experimental."""

import threading
import time

import rclpy
from probe import show, took
from rclpy.experimental import EventsExecutor
from std_msgs.msg import String

rclpy.init()
n = rclpy.create_node("n65")
e = EventsExecutor()
show("add", lambda: e.add_node(n))
got = []
n.create_timer(0.1, lambda: got.append("t"))
p = n.create_publisher(String, "t65", 10)
n.create_subscription(String, "t65", lambda m: got.append(m.data), 10)
t = time.monotonic()
while time.monotonic() - t < 1 and len(got) < 3:
    e.spin_once(timeout_sec=0.2)
show("timer", lambda: got.count("t") >= 3)
p.publish(String(data="x"))
t = time.monotonic()
while time.monotonic() - t < 1 and "x" not in got:
    e.spin_once(timeout_sec=0.2)
show("sub", lambda: "x" in got)
f = rclpy.task.Future()
took("until", lambda: e.spin_until_future_complete(f, timeout_sec=0.3))
k = e.create_task(lambda: 5)
e.spin_until_future_complete(k, 1)
show("task", k.result)


show("attributes", lambda: sorted(x for x in dir(e) if not x.startswith("_")))
