"""A backlog of one slow subscription: who else gets a turn meanwhile, with one thread and with four."""

import threading
import time

import rclpy
from probe import show, until
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_msgs.msg import Int32
from std_srvs.srv import Trigger

rclpy.init()


def run(make, own_group=False):
    n = rclpy.create_node("n109")
    c = rclpy.create_node("c109")
    log = []
    ce = SingleThreadedExecutor()
    ce.add_node(c)
    n.create_subscription(Int32, "t109", lambda m: (log.append("m"), time.sleep(0.05)), 50)
    n.create_subscription(Int32, "u109", lambda m: log.append("u"), 50)
    n.create_service(Trigger, "s109", lambda q, r: (log.append("s"), r)[1])
    p = c.create_publisher(Int32, "t109", 50)
    u = c.create_publisher(Int32, "u109", 50)
    k = c.create_client(Trigger, "s109")
    until(ce, lambda: p.get_subscription_count() and u.get_subscription_count())
    k.wait_for_service(2)
    for i in range(30):
        p.publish(Int32(data=i))
    time.sleep(0.3)
    u.publish(Int32())
    f = k.call_async(Trigger.Request())
    n.create_timer(0.1, lambda: log.append("t"), callback_group=MutuallyExclusiveCallbackGroup() if own_group else None)
    time.sleep(0.3)
    e = make()
    e.add_node(n)
    th = threading.Thread(target=e.spin, daemon=True)
    th.start()
    t = time.monotonic()
    while log.count("m") < 30 and time.monotonic() - t < 5:
        time.sleep(0.02)
    e.shutdown()
    th.join(2)
    n.destroy_node()
    c.destroy_node()
    time.sleep(0.2)
    return {x: (log.index(x) < 8 if x in log else None) for x in "tus"}, "timer in between", log.count("t") > 8


show("one thread", lambda: run(SingleThreadedExecutor))
show("four threads", lambda: run(lambda: MultiThreadedExecutor(4)))
show("four threads, timer in its own group", lambda: run(lambda: MultiThreadedExecutor(4), True))
