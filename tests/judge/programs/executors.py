"""Executors with nodes and tasks, before init and after shutdown too."""

import threading
import time

import rclpy
import rclpy.executors
from probe import show, took, until
from rclpy.executors import *
from rclpy.executors import (
    Executor,
    ExternalShutdownException,
    MultiThreadedExecutor,
    ShutdownException,
    SingleThreadedExecutor,
    TimeoutException,
)

show("before init", lambda: type(SingleThreadedExecutor()).__name__)
rclpy.init()
n = rclpy.create_node("n11")
m = rclpy.create_node("m11")
e = SingleThreadedExecutor()
show("add", lambda: e.add_node(n))
show("add twice", lambda: e.add_node(n))
show("get_nodes", lambda: len(e.get_nodes()))
show("node.executor", lambda: n.executor is e)
f = SingleThreadedExecutor()
show("add to second", lambda: f.add_node(n))
show("where", lambda: (n.executor is f, len(e.get_nodes()), len(f.get_nodes())))
show("remove wrong", lambda: e.remove_node(n))
show("remove", lambda: f.remove_node(n))
show("remove again", lambda: f.remove_node(n))
show("executor", lambda: n.executor)
show("set executor None", lambda: setattr(n, "executor", e))
show("nodes", lambda: len(e.get_nodes()))
setattr(n, "executor", None)
show("nodes", lambda: len(e.get_nodes()))
took("spin_once empty", e.spin_once, timeout_sec=0.3)
took("spin_once empty 0", e.spin_once, 0)
e.add_node(n)
show("create_task fn", lambda: (lambda t: (until(e, t.done), t.result()))(e.create_task(lambda a: a + 1, 2)))


async def co(a):
    return a * 2


show("create_task co fn", lambda: (lambda t: (until(e, t.done), t.result()))(e.create_task(co, 2)))
show("create_task co", lambda: (lambda t: (until(e, t.done), t.result()))(e.create_task(co(4))))
t = e.create_task(lambda: 1 / 0)
show("task raises in spin", lambda: e.spin_once(timeout_sec=0.5))
show("task exc", lambda: t.exception())
show("create_task None", lambda: e.create_task(None))
show(
    "create_task kwargs", lambda: (lambda t: (until(e, t.done), t.result()))(e.create_task(lambda a, b: (a, b), 1, b=3))
)
show("context", lambda: e.context is rclpy.get_default_context())
show("wake", e.wake)
calls = []
n.create_timer(0.1, lambda: calls.append(1))
th = threading.Thread(target=e.spin)
th.start()
time.sleep(0.55)
show("spin_once while spinning", lambda: e.spin_once(timeout_sec=0.1))
show("spin while spinning", lambda: "skip")
show("calls", lambda: 4 <= len(calls) <= 7)
took("shutdown", e.shutdown)
th.join(2)
show("thread ended", lambda: not th.is_alive())
show("shutdown twice", e.shutdown)
show("spin_once after shutdown", lambda: e.spin_once(timeout_sec=0.1))
show("add_node after shutdown", lambda: e.add_node(m))
show("create_task after shutdown", lambda: type(e.create_task(print)).__name__)
show("spin after shutdown", e.spin)
show("nodes", lambda: len(e.get_nodes()))
show("with", lambda: SingleThreadedExecutor().__enter__().__class__.__name__)
with SingleThreadedExecutor() as g:
    g.add_node(m)
show("after with", lambda: (m.executor is g, len(g.get_nodes())))
show("spin_once", lambda: g.spin_once(timeout_sec=0.1))
show("shutdown timeout arg", lambda: SingleThreadedExecutor().shutdown(0.1))
show("timeout kw", lambda: SingleThreadedExecutor().shutdown(timeout_sec=0.1))
show("add not a node", lambda: SingleThreadedExecutor().add_node(3))
show(
    "threads default",
    lambda: MultiThreadedExecutor()._executor._max_workers == max(__import__("os").cpu_count(), 2) if False else "skip",
)
show("threads 0", lambda: type(MultiThreadedExecutor(0)).__name__)
show("threads 1", lambda: type(MultiThreadedExecutor(num_threads=1)).__name__)
show("threads -1", lambda: type(MultiThreadedExecutor(-1)).__name__)
show("threads str", lambda: type(MultiThreadedExecutor("2")).__name__)
show("Executor abstract", lambda: Executor().spin_once(timeout_sec=0.1))
show("attributes", lambda: sorted(x for x in dir(SingleThreadedExecutor) if not x.startswith("_")))
show("attributes multi", lambda: sorted(x for x in dir(MultiThreadedExecutor) if not x.startswith("_")))
show(
    "module attributes",
    lambda: sorted(
        x
        for x in dir(rclpy.executors)
        if x[0].isupper() and "typ" not in str(getattr(getattr(rclpy.executors, x), "__module__", "typing"))
    ),
)
show(
    "exceptions",
    lambda: [
        c.__mro__[1].__name__
        for c in (
            ExternalShutdownException,
            ShutdownException,
            TimeoutException,
            rclpy.executors.ConditionReachedException,
        )
    ],
)
show("str", lambda: (str(ExternalShutdownException()), str(ShutdownException())))
rclpy.shutdown()
show("executor after shutdown", lambda: type(SingleThreadedExecutor()).__name__)
