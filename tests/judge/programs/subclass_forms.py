"""Forms of subclasses of Node that are seen in the wild."""

import abc
import dataclasses
import enum

import rclpy
from probe import say, show, until
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
log = []


class Mixin:
    def hello(self):
        return self.get_name()


class A(Mixin, Node):
    def __init__(self, **k):
        super().__init__("a89", **k)


show("mixin", lambda: A().hello())


class B(Node, abc.ABC):
    @abc.abstractmethod
    def f(self): ...


show("abstract", lambda: B("b"))


class C(A):
    def destroy_node(self):
        log.append("destroy")
        return super().destroy_node()

    def __del__(self):
        log.append("del")


c = C()
c.destroy_node()
del c
import gc

gc.collect()
say(log)


class D(Node):
    count: int = 0

    def __init__(self):
        super().__init__("d89")
        self.declare_parameter("rate", 10.0)
        self.rate = self.get_parameter("rate").get_parameter_value().double_value
        self.timer = self.create_timer(1 / self.rate, self.timer)

    def timer(self):
        self.count += 1


d = D()
until(d, lambda: d.count, 1)
show("attribute shadows its own method", lambda: d.count > 0)
show("get_parameter_value", lambda: d.get_parameter("rate").get_parameter_value())
show("eq", lambda: d == d)
show("hashable", lambda: {d: 1}[d])
show("node in set", lambda: len({d, d}))


class E(Node):
    def get_logger(self):
        return super().get_logger().get_child("x")


show("override get_logger", lambda: E("e89").get_logger().name)


class F(Node):
    publishers_ = []

    def __init__(self):
        super().__init__("f89")
        self.publishers_ = [self.create_publisher(String, f"t{i}", 1) for i in range(2)]


show("publishers", lambda: [p.topic_name for p in F().publishers][-2:])
show("setting property", lambda: setattr(A(), "publishers", []))
show("setting name prop", lambda: setattr(A(), "executor", None))
show("setting context", lambda: setattr(A(), "context", None))
show("setting handle", lambda: setattr(A(), "handle", 3))
show("setting clients", lambda: setattr(A(), "clients", []))
show("setting timers", lambda: setattr(A(), "timers", []))
show("setting services", lambda: setattr(A(), "services", []))
show("setting subscriptions", lambda: setattr(A(), "subscriptions", []))
show("setting guards", lambda: setattr(A(), "guards", []))
show("setting waitables", lambda: setattr(A(), "waitables", []))
show("setting default_callback_group", lambda: setattr(A(), "default_callback_group", None))
show("slots", lambda: hasattr(A(), "__dict__"))
with A() as w:
    say("with", w.get_name())
show("after with", lambda: w.create_publisher(String, "x", 1))


def run_main(args=None):
    with rclpy.init(args=args) if not rclpy.ok() else __import__("contextlib").nullcontext():
        return Node("main89").get_name()


show("main", run_main)
