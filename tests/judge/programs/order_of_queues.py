"""In which order messages of two topics, two nodes and a burst are served."""

import time

import rclpy
from probe import say, until
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_msgs.msg import Int32, String
from std_srvs.srv import SetBool

rclpy.init()
n = rclpy.create_node("n88")
m = rclpy.create_node("m88")
log = []
a = n.create_publisher(Int32, "a", 10)
b = n.create_publisher(Int32, "b", 10)
n.create_subscription(Int32, "a", lambda x: log.append(f"a{x.data}"), 10)
n.create_subscription(Int32, "b", lambda x: log.append(f"b{x.data}"), 10)
m.create_subscription(Int32, "a", lambda x: log.append(f"m{x.data}"), 10)
e = SingleThreadedExecutor()
e.add_node(n)
e.add_node(m)
until(e, lambda: a.get_subscription_count() == 2 and b.get_subscription_count() == 1)
for i in range(3):
    a.publish(Int32(data=i))
for i in range(3):
    b.publish(Int32(data=i))
time.sleep(0.3)
until(e, lambda: len(log) == 9, 2)
say("two topics, two nodes", log)
log.clear()
sv = n.create_service(SetBool, "s", lambda q, r: (log.append(q.data), r)[1])
c = m.create_client(SetBool, "s")
c.wait_for_service(2)
fs = [c.call_async(SetBool.Request(data=bool(i % 2))) for i in range(4)]
[f.add_done_callback(lambda f, i=i: log.append(f"r{i}")) for i, f in enumerate(fs)]
until(e, lambda: all(f.done() for f in fs), 2)
say("requests", [x for x in log if not isinstance(x, str)])
until(e, lambda: False, 0.4)
log.clear()
# a slow subscription beside another topic
s = n.create_subscription(Int32, "slow", lambda x: (log.append(f"s{x.data}"), time.sleep(0.03)), 20)
p = n.create_publisher(Int32, "slow", 20)
q = n.create_publisher(Int32, "b", 10)
until(e, lambda: p.get_subscription_count())
for i in range(8):
    p.publish(Int32(data=i))
time.sleep(0.2)
b.publish(Int32(data=100))
time.sleep(0.1)
until(e, lambda: len(log) == 9, 2)
say("b100 is not behind all of slow", "b100" in log and log.index("b100") < 5)
