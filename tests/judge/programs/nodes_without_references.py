"""Nodes, subscriptions and timers that nothing refers to any more."""

import gc
import weakref

import rclpy
from probe import show, until
from rclpy.node import Node

rclpy.init()
k = Node("k93")


def make():
    Node("gone93")


make()
gc.collect()
until(k, lambda: "gone93" not in k.get_node_names(), 3)
show("local node gone from graph", lambda: "gone93" in k.get_node_names())


class S(Node):
    def __init__(self):
        super().__init__("cyc93")
        self.create_timer(0.05, self.cb)

    def cb(self):
        pass


w = weakref.ref(S())
gc.collect()
show("node with a timer collected", lambda: w() is None)
until(k, lambda: "cyc93" not in k.get_node_names(), 2)
show("in graph", lambda: "cyc93" in k.get_node_names())
p = k.create_publisher(__import__("std_msgs.msg").msg.String, "t93", 1)
s = k.create_subscription(__import__("std_msgs.msg").msg.String, "t93", print, 1)
until(k, lambda: p.get_subscription_count(), 2)
del s
gc.collect()
until(k, lambda: not p.get_subscription_count(), 0.5)
show("dropped subscription still there", lambda: p.get_subscription_count())
