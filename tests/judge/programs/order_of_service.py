"""In which order spin_once serves a timer, two subscriptions, a service, a client, a guard condition and a task."""

import time

import rclpy
from probe import say, until
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import Trigger

rclpy.init()
n = rclpy.create_node("n14")
e = SingleThreadedExecutor()
e.add_node(n)
log = []
p = n.create_publisher(String, "t14", 10)
s = n.create_subscription(String, "t14", lambda m: log.append("sub1 " + m.data), 10)
s2 = n.create_subscription(String, "t14", lambda m: log.append("sub2 " + m.data), 10)
c = n.create_client(Trigger, "s14")
sv = n.create_service(Trigger, "s14", lambda q, r: (log.append("srv"), r)[1])
g = n.create_guard_condition(lambda: log.append("guard"))
until(n, lambda: p.get_subscription_count() == 2)
c.wait_for_service(2)
e.add_node(n)
t = n.create_timer(0.3, lambda: log.append("timer"))
for i in range(3):
    p.publish(String(data=str(i)))
f = c.call_async(Trigger.Request())
f.add_done_callback(lambda f: log.append("reply"))
g.trigger()
e.create_task(lambda: log.append("task"))
time.sleep(0.5)
n.destroy_timer(t) if False else t.reset() if False else None
for i in range(13):
    before = len(log)
    e.spin_once(timeout_sec=0.05)
    say(i, log[before:]) if i < 13 else 0
    if log[before:] == ["timer"]:
        t.cancel()
