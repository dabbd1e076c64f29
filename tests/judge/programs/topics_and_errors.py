"""Arguments that create_publisher, create_subscription and publish accept and refuse."""

import rclpy
from probe import say, show
from rclpy.node import Node
from rclpy.qos import QoSProfile
from std_msgs.msg import Int32, String

rclpy.init()
n = Node("n4")
for t in [
    "a b",
    "",
    "1a",
    "/",
    "a/",
    "a//b",
    "~",
    "~/",
    "~a",
    "/~/a",
    "a/~/b",
    "{node}",
    "{nope}",
    "a-b",
    "__a",
    "a__b",
    "{ns}/x",
    "/a/1b",
    "é",
    "_hidden",
    "a/_b",
    "a.b",
    "rostopic://x",
    "~/{node}/q",
]:
    show(f"topic {t!r}", lambda: n.create_publisher(String, t, 1).topic_name)
for t in ["a b", "~/s", "_x", ""]:
    show(f"service name {t!r}", lambda: n.create_service(__import__("std_srvs.srv").srv.Empty, t, print).srv_name)
show("qos missing", lambda: n.create_publisher(String, "t"))
show("qos string", lambda: n.create_publisher(String, "t", "10"))
show("qos float", lambda: n.create_publisher(String, "t", 1.0))
show("qos negative", lambda: n.create_publisher(String, "t", -1))
show("qos zero", lambda: n.create_publisher(String, "t", 0).topic_name)
show("qos True", lambda: n.create_publisher(String, "t", True).topic_name)
show("qos None", lambda: n.create_publisher(String, "t", None))
show("type str", lambda: n.create_publisher("std_msgs/String", "t", 1))
show("type instance", lambda: n.create_publisher(String(), "t", 1).topic_name)
show("type int", lambda: n.create_publisher(int, "t", 1))
show("type module", lambda: n.create_publisher(__import__("std_msgs.msg").msg, "t", 1))
show("srv type as topic", lambda: n.create_publisher(__import__("std_srvs.srv").srv.Empty, "t", 1))
show("msg type as srv", lambda: n.create_service(String, "t", print))
show("msg type as client", lambda: n.create_client(String, "t"))
show("args swapped", lambda: n.create_publisher("t", String, 1))
show("sub args swapped", lambda: n.create_subscription("t", String, print, 1))
show("callback None", lambda: n.create_subscription(String, "t", None, 1).topic_name)
show("callback and qos swapped", lambda: n.create_subscription(String, "t", 1, print))
p = n.create_publisher(String, "t", 1)
show("publish str", lambda: p.publish("x"))
show("publish other type", lambda: p.publish(Int32()))
show("publish None", lambda: p.publish(None))
show("publish class", lambda: p.publish(String))
show("publish nothing", lambda: p.publish())
show("publish bytes", lambda: p.publish(b"\0\1\0\0\1\0\0\0\0"))
show("topic", lambda: p.topic)
show("topic_name", lambda: p.topic_name)
show("msg_type", lambda: p.msg_type.__name__)
show("count", p.get_subscription_count)
show("logger_name", lambda: p.logger_name)
show("wait_for_all_acked", p.wait_for_all_acked)
show("assert_liveliness", p.assert_liveliness)
show("destroy", lambda: n.destroy_publisher(p))
show("destroy twice", lambda: n.destroy_publisher(p))
show("publish destroyed", lambda: p.publish(String()))
show("count destroyed", p.get_subscription_count)
s = n.create_subscription(String, "t", print, 1)
show("callback wrong arity creation", lambda: n.create_subscription(String, "t", lambda: 0, 1).topic_name)
show("callback 3 args", lambda: n.create_subscription(String, "t", lambda a, b, c: 0, 1).topic_name)
show("sub.get_publisher_count", s.get_publisher_count)
show("sub destroy", s.destroy)
show("sub destroy twice", s.destroy)
show("n.destroy_subscription destroyed", lambda: n.destroy_subscription(s))
show("foreign", lambda: n.destroy_subscription(p))
q = n.create_publisher(String, "w", 1)
with q:
    say("with publisher")
show("after with", lambda: q.publish(String()))
other = Node("other")
r = other.create_publisher(String, "w", 1)
show("destroy publisher of other node", lambda: n.destroy_publisher(r))
show("sub repr attributes", lambda: sorted(x for x in dir(s) if not x.startswith("_")))
show("pub attributes", lambda: sorted(x for x in dir(p) if not x.startswith("_")))
