"""The Python types of the fields of a message that was received."""

import array
import copy
import pickle

import numpy as np
import rclpy
from nav_msgs.msg import OccupancyGrid
from probe import show, until
from sensor_msgs.msg import Image, Imu, JointState, LaserScan, PointCloud2
from std_msgs.msg import ByteMultiArray, Int32MultiArray, UInt8MultiArray

rclpy.init()
n = rclpy.create_node("n85")


def via(m):
    got = []
    s = n.create_subscription(type(m), "t85", got.append, 10)
    p = n.create_publisher(type(m), "t85", 10)
    until(n, lambda: p.get_subscription_count() == 1)
    p.publish(m)
    until(n, lambda: got)
    n.destroy_subscription(s)
    n.destroy_publisher(p)
    until(n, lambda: False, 0.1)
    return got[0]


r = via(LaserScan(ranges=[3.0, 1.0, 2.0], header=__import__("std_msgs.msg").msg.Header(frame_id="f")))
show("type", lambda: (type(r.ranges).__name__, r.ranges.typecode, len(r.ranges)))
show("min", lambda: min(r.ranges))
show("index", lambda: r.ranges.index(1.0))
show("slice", lambda: type(r.ranges[:2]).__name__)
show("neg", lambda: r.ranges[-1])
show("setitem", lambda: r.ranges.__setitem__(0, 9.0))
show("now", lambda: list(r.ranges))
show("append", lambda: (r.ranges.append(4.0), len(r.ranges))[1])
show("np.array", lambda: np.array(r.ranges).dtype)
show("asarray shares", lambda: np.asarray(r.ranges).flags.writeable)
show("tolist", lambda: r.ranges.tolist())
show("sum", lambda: sum(r.ranges))
show("add", lambda: list(r.ranges + r.ranges)[:2])
show("eq list", lambda: r.ranges == [1.0])
show("sorted", lambda: sorted(r.ranges))
show("enumerate", lambda: [i for i, x in enumerate(r.ranges)])
show("np min", lambda: float(np.min(r.ranges)))
show("mul", lambda: len(r.ranges * 2))
show("bool", lambda: bool(r.ranges))
show("reverse", lambda: (r.ranges.reverse(), r.ranges[0])[1])
show("set list", lambda: (setattr(r, "ranges", [1.0]), type(r.ranges).__name__)[1])
show("elem type", lambda: type(r.ranges[0]).__name__)
show("frame", lambda: r.header.frame_id)
i = via(Image(data=bytes(range(6)), height=2, width=3, step=3, encoding="mono8"))
show("image", lambda: (type(i.data).__name__, i.data.typecode))
show("frombuffer", lambda: np.frombuffer(i.data, np.uint8).reshape(2, 3).tolist())
show("frombuffer writeable", lambda: np.frombuffer(i.data, np.uint8).flags.writeable)
show("bytes", lambda: bytes(i.data))
show("tobytes", lambda: i.data.tobytes())
show("set bytes", lambda: (setattr(i, "data", b"ab"), type(i.data).__name__)[1])
show("data[0]", lambda: i.data[0])
show("setitem", lambda: (i.data.__setitem__(0, 7), i.data[0])[1])
show("np.array", lambda: np.array(i.data).shape)
u = via(Imu())
show(
    "cov",
    lambda: (
        type(u.orientation_covariance).__name__,
        u.orientation_covariance.flags.writeable,
        u.orientation_covariance.shape,
    ),
)
show("cov set", lambda: (u.orientation_covariance.__setitem__(0, 1.0), u.orientation_covariance[0])[1])
j = via(JointState(name=["a"], position=[1.0]))
show("names", lambda: (type(j.name).__name__, j.name.index("a")))
show("names append", lambda: (j.name.append("b"), j.name)[1])
show("dict", lambda: dict(zip(j.name, j.position)))
o = via(OccupancyGrid(data=[-1, 100]))
show("grid", lambda: (type(o.data).__name__, o.data.typecode, list(o.data)))
show("grid np", lambda: np.array(o.data, dtype=np.int8).tolist())
b = via(ByteMultiArray(data=[b"a", b"b"]))
show("bytes list", lambda: b.data)
k = via(Int32MultiArray(data=[1, 2]))
show("int32", lambda: (k.data.typecode, list(k.data)))
c = via(PointCloud2(data=b"abcd"))
show("cloud", lambda: (type(c.data).__name__, len(c.data)))
for m in (r, i, u, j, o):
    show(f"deepcopy {type(m).__name__}", lambda: copy.deepcopy(m) == m)
    show(f"pickle {type(m).__name__}", lambda: pickle.loads(pickle.dumps(m)) == m)
show("republish", lambda: via(j) == j)
show("two subs share", lambda: "skip")
show("repr", lambda: repr(via(LaserScan(ranges=[0.1]))).endswith("ranges=[0.10000000149011612], intensities=[])"))
g1, g2 = [], []
n.create_subscription(LaserScan, "two85", g1.append, 1)
n.create_subscription(LaserScan, "two85", g2.append, 1)
p = n.create_publisher(LaserScan, "two85", 1)
until(n, lambda: p.get_subscription_count() == 2)
p.publish(LaserScan(ranges=[1.0]))
until(n, lambda: g1 and g2)
g1[0].ranges[0] = 5.0
show("two subscriptions, one message each", lambda: (g2[0].ranges[0], g1[0] is g2[0]))
