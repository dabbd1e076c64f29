"""After an exception in a callback: do the others go on, is the message lost, does spin work again?"""

import rclpy
from probe import say, show, until
from std_msgs.msg import Int32

rclpy.init()
n = rclpy.create_node("n96")
got = []


def cb(m):
    got.append(m.data)
    if m.data % 2 == 0:
        raise ValueError(m.data)


n.create_subscription(Int32, "t96", cb, 10)
p = n.create_publisher(Int32, "t96", 10)
until(n, lambda: p.get_subscription_count())
for i in range(5):
    p.publish(Int32(data=i))
errors = []
import time

t = time.monotonic()
while len(got) < 5 and time.monotonic() - t < 3:
    try:
        rclpy.spin_once(n, timeout_sec=0.1)
    except ValueError as e:
        errors.append(str(e))
say(got, errors)
k = n.create_timer(0.05, lambda: 1 / 0)
for _ in range(3):
    show("spin", lambda: rclpy.spin(n))
n.destroy_timer(k)
show("fine again", lambda: rclpy.spin_once(n, timeout_sec=0.1))
show("executor", lambda: n.executor is None or True)
import sys

show("traceback has the callback", lambda: None)
try:
    n.create_timer(0.01, lambda: {}["x"])
    rclpy.spin(n)
except KeyError as e:
    import traceback

    say(
        traceback.extract_tb(e.__traceback__)[-1].name,
        repr(e),
        e.__cause__,
        e.__notes__ if hasattr(e, "__notes__") else "no notes",
    )
