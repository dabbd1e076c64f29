"""A timer beside a subscription whose slow callback never catches up with its messages."""

import threading
import time

import rclpy
from probe import say, until
from std_msgs.msg import String

rclpy.init()
n = rclpy.create_node("n31")
ticks = []
got = []
p = n.create_publisher(String, "t31", 50)


def slow(m):
    got.append(m.data)
    time.sleep(0.05)


n.create_subscription(String, "t31", slow, 50)
until(n, lambda: p.get_subscription_count())
for i in range(40):
    p.publish(String(data=str(i)))
time.sleep(0.2)
t0 = time.monotonic()
n.create_timer(0.1, lambda: ticks.append(time.monotonic() - t0))
while time.monotonic() - t0 < 1.55:
    rclpy.spin_once(n, timeout_sec=0.05)
say("messages", round(len(got) / 10) * 10)
say("first tick before 0.3 s", bool(ticks) and ticks[0] < 0.3)
say("ticks 12 or more", len(ticks) >= 12)
