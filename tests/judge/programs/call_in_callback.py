"""A synchronous call inside a callback, with groups that allow it."""

import threading
import time

import rclpy
from probe import show
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_srvs.srv import Trigger

rclpy.init()
n = rclpy.create_node("n71")
g = ReentrantCallbackGroup()
log = []
n.create_service(Trigger, "s71", lambda q, r: (setattr(r, "message", "m"), r)[1], callback_group=g)
c = n.create_client(Trigger, "s71", callback_group=g)
e = MultiThreadedExecutor(3)
e.add_node(n)
th = threading.Thread(target=e.spin, daemon=True)
th.start()
c.wait_for_service(2)
t = n.create_timer(
    0.1, lambda: (t.cancel(), log.append(c.call(Trigger.Request(), timeout_sec=2).message)), callback_group=g
)
time.sleep(0.8)
show("reentrant", lambda: log)
c2 = n.create_client(Trigger, "s71", callback_group=MutuallyExclusiveCallbackGroup())
log.clear()
u = n.create_timer(
    0.1,
    lambda: (u.cancel(), log.append(c2.call(Trigger.Request(), timeout_sec=2).message)),
    callback_group=MutuallyExclusiveCallbackGroup(),
)
time.sleep(0.8)
show("two exclusive groups", lambda: log)
log.clear()
v = n.create_timer(0.1, lambda: (v.cancel(), log.append(c2.wait_for_service(1.0))))
time.sleep(0.5)
show("wait_for_service in callback", lambda: log)
