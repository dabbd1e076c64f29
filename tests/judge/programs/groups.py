"""Callback groups, and the callbacks that run at the same time."""

import threading
import time

import rclpy
from probe import show
from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor

rclpy.init()
n = rclpy.create_node("n13")


def run(groups, secs=0.65):
    n = rclpy.create_node("n13r")
    e = MultiThreadedExecutor(4)
    e.add_node(n)
    active, most, count = [0], [0], [0, 0]
    lock = threading.Lock()

    def cb(i):
        def f():
            with lock:
                active[0] += 1
                most[0] = max(most[0], active[0])
                count[i] += 1
            time.sleep(0.2)
            with lock:
                active[0] -= 1

        return f

    ts = [n.create_timer(0.05, cb(i), callback_group=g) for i, g in enumerate(groups)]
    t = time.monotonic()
    while time.monotonic() - t < secs:
        e.spin_once(timeout_sec=0.05)
    e.shutdown()
    n.destroy_node()
    return most[0]


show("default group", lambda: run([None, None]))
g = MutuallyExclusiveCallbackGroup()
show("one mutually exclusive", lambda: run([g, g]))
show("two mutually exclusive", lambda: run([MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()]))
show("reentrant capped", lambda: run([ReentrantCallbackGroup()]) > 1)
show("default type", lambda: type(n.default_callback_group).__name__)
g = MutuallyExclusiveCallbackGroup()
t = n.create_timer(9, print, callback_group=g)
show("has_entity", lambda: g.has_entity(t))
show("default has", lambda: n.default_callback_group.has_entity(t))
show("can_execute", lambda: g.can_execute(t))
show("begin", lambda: g.beginning_execution(t))
show("can now", lambda: g.can_execute(t))
show("begin again", lambda: g.beginning_execution(t))
show("end", lambda: g.ending_execution(t))
show("can", lambda: g.can_execute(t))
show("end again", lambda: g.ending_execution(t))
r = ReentrantCallbackGroup()
show("r", lambda: (r.can_execute(t), r.beginning_execution(t), r.ending_execution(t)))
show("entities", lambda: len(g.entities))
n.destroy_timer(t)
show("has after destroy", lambda: g.has_entity(t))
show("abstract", lambda: CallbackGroup())
show("wrong", lambda: n.create_timer(1, print, callback_group=3))
show("wrong str", lambda: n.create_publisher(__import__("std_msgs.msg").msg.String, "x", 1, callback_group="g"))
show("pub group", lambda: n.create_publisher(__import__("std_msgs.msg").msg.String, "x", 1).topic)
show("attributes", lambda: sorted(x for x in dir(g) if not x.startswith("_")))


def order(single):
    e = SingleThreadedExecutor() if single else MultiThreadedExecutor(1)
    n = rclpy.create_node("n13o")
    e.add_node(n)
    log = []
    ts = [n.create_timer(0.3, lambda i=i: log.append(i)) for i in range(4)]
    time.sleep(0.4)
    for _ in range(4):
        e.spin_once(timeout_sec=0.5)
    for x in ts:
        n.destroy_timer(x)
    e.shutdown()
    time.sleep(0.1)
    return log


show("timer order", lambda: order(True))
