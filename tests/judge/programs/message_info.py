"""MessageInfo of a callback, and messages as bytes."""

import array

import rclpy
from probe import say, show, until
from rclpy.subscription import MessageInfo
from rclpy.wait_for_message import wait_for_message
from sensor_msgs.msg import Image
from std_msgs.msg import String

rclpy.init()
n = rclpy.create_node("n48")
got = []
p = n.create_publisher(String, "t48", 10)
s1 = n.create_subscription(String, "t48", lambda m, i: got.append(("info", type(m).__name__, i)), 10)
s2 = n.create_subscription(String, "t48", lambda m: got.append(("raw", m)), 10, raw=True)
s3 = n.create_subscription(String, "t48", lambda m, i: got.append(("rawinfo", m, i)), 10, raw=True)
until(n, lambda: p.get_subscription_count() == 3)
p.publish(String(data="a"))
until(n, lambda: len(got) == 3)
for g in sorted(got, key=lambda g: g[0]):
    if g[0] == "raw":
        say("raw", type(g[1]).__name__, bytes(g[1]).hex())
    else:
        show(
            g[0],
            lambda: (
                type(g[-1]).__name__,
                sorted(g[-1]) if isinstance(g[-1], dict) else sorted(x for x in dir(g[-1]) if not x.startswith("_")),
            ),
        )
i = [g for g in got if g[0] == "info"][0][-1]
show("source", lambda: i["source_timestamp"] > 10**18)
show("seq", lambda: (i["publication_sequence_number"], i["reception_sequence_number"]))
show("gid", lambda: type(i.get("publisher_gid")).__name__)
show("gid2", lambda: sorted(i))
show("publish raw", lambda: p.publish(bytes.fromhex("00010000020000006200")))
got.clear()
until(n, lambda: len(got) == 3)
show("got", lambda: sorted(g[0] for g in got))
show("publish bytearray", lambda: p.publish(bytearray.fromhex("00010000020000006200")))
show("publish garbage", lambda: p.publish(b"xx"))
show("spin garbage", lambda: until(n, lambda: False, 0.5))
show("wait timeout", lambda: wait_for_message(String, n, "w48", time_to_wait=0.3))
q = n.create_publisher(
    String, "w48", rclpy.qos.QoSProfile(depth=1, durability=rclpy.qos.DurabilityPolicy.TRANSIENT_LOCAL)
)
q.publish(String(data="l"))
show(
    "wait latched",
    lambda: wait_for_message(
        String,
        n,
        "w48",
        qos_profile=rclpy.qos.QoSProfile(depth=1, durability=rclpy.qos.DurabilityPolicy.TRANSIENT_LOCAL),
        time_to_wait=2,
    ),
)
show("content filter", lambda: n.create_subscription(String, "cf", print, 10, content_filter_options=None).topic_name)
show("is_cft", lambda: s1.is_cft_enabled)
g = []
n.create_subscription(Image, "im", g.append, 1)
k = n.create_publisher(Image, "im", 1)
until(n, lambda: k.get_subscription_count())
k.publish(Image(data=b"abc"))
until(n, lambda: g)
show("image data", lambda: (type(g[0].data).__name__, g[0].data.typecode, bytes(g[0].data)))
m = String(data="same")
h = []
n.create_subscription(String, "same", h.append, 10)
l = n.create_publisher(String, "same", 10)
until(n, lambda: l.get_subscription_count())
l.publish(m)
m.data = "changed"
until(n, lambda: h)
show("copy", lambda: (h[0].data, h[0] is m))
