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


gc.disable()
Node("bare93")
until(k, lambda: "bare93" not in k.get_node_names(), 3)
show("node gone without a collection", lambda: "bare93" in k.get_node_names())
gc.enable()
p = Node("pub93").create_publisher(__import__("std_msgs.msg").msg.String, "u93", 1)
c = Node("cli93").create_client(__import__("std_srvs.srv").srv.Trigger, "v93")
gc.collect()
until(k, lambda: False, 0.5)
show("nodes of a publisher and a client", lambda: sorted(n for n in k.get_node_names() if n in ("pub93", "cli93")))
heard = []
k.create_subscription(__import__("std_msgs.msg").msg.String, "u93", lambda m: heard.append(m.data), 1)
until(k, lambda: p.get_subscription_count(), 3)
p.publish(__import__("std_msgs.msg").msg.String(data="still here"))
until(k, lambda: heard, 3)
show("what such a publisher sends", lambda: heard)
show("such a client", lambda: c.service_is_ready())
del p
gc.collect()
until(k, lambda: "pub93" not in k.get_node_names(), 3)
show("node once the publisher is dropped", lambda: "pub93" in k.get_node_names())
