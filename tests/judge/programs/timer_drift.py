"""A timer's pace after a slow callback, after a reset and with another period."""

import time

import rclpy
from probe import say, until

rclpy.init()
n = rclpy.create_node("n62")
t0 = time.monotonic()
calls = []


def cb():
    calls.append(time.monotonic() - t0)
    if len(calls) == 2:
        time.sleep(0.35)


n.create_timer(0.1, cb)
while time.monotonic() - t0 < 1.05:
    rclpy.spin_once(n, timeout_sec=0.05)
say([round(c * 20) / 20 for c in calls][:1], "calls", len(calls))
say("in step after a slow one", all(abs((c * 10) - round(c * 10)) < 0.35 for c in calls[3:]))
c2 = []
k = n.create_timer(0.2, lambda: c2.append(time.monotonic()))
time.sleep(0.9)
t = time.monotonic()
while time.monotonic() - t < 0.25:
    rclpy.spin_once(n, timeout_sec=0.01)
say("missed ticks are not caught up", len(c2))
k.cancel()
t = time.monotonic()
k.reset()
c2.clear()
until(n, lambda: c2, 1)
say("reset starts anew", round(c2[0] - t, 1))
k.timer_period_ns = 50_000_000
c2.clear()
t = time.monotonic()
while time.monotonic() - t < 0.5:
    rclpy.spin_once(n, timeout_sec=0.01)
say("period change", 8 <= len(c2) <= 11)
z = []
n.create_timer(0.0, lambda: z.append(1))
for _ in range(5):
    rclpy.spin_once(n, timeout_sec=0.1)
say("zero period", len(z) >= 2)
