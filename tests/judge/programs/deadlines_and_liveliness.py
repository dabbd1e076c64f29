"""Events of deadlines and of liveliness: when they begin, what they count, and what ends them."""

import time

import rclpy
from probe import say, until
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import LivelinessPolicy, QoSProfile
from std_msgs.msg import Int32

rclpy.init()
a = rclpy.create_node("a111")
b = rclpy.create_node("b111")
e = SingleThreadedExecutor()
e.add_node(a)
e.add_node(b)
FIELDS = "total_count total_count_change alive_count alive_count_change not_alive_count not_alive_count_change"


def spin(seconds):
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        e.spin_once(timeout_sec=left)


def note(log):
    return lambda i: log.append([getattr(i, f) for f in FIELDS.split() if hasattr(i, f)])


def make(topic, offered, requested=None):
    pub, sub = [], []
    s = b.create_subscription(
        Int32,
        topic,
        lambda m: None,
        requested or offered,
        event_callbacks=SubscriptionEventCallbacks(deadline=note(sub), liveliness=note(sub)),
    )
    p = a.create_publisher(
        Int32, topic, offered, event_callbacks=PublisherEventCallbacks(deadline=note(pub), liveliness=note(pub))
    )
    until(e, lambda: p.get_subscription_count() == 1 and s.get_publisher_count() == 1)
    return p, pub, sub


def both(label, pub, sub):
    say(f"{label}, publisher", pub)
    say(f"{label}, subscription", sub)
    pub.clear()
    sub.clear()


def deadline(seconds):
    return QoSProfile(depth=10, deadline=Duration(seconds=seconds))


def lease(seconds, kind=LivelinessPolicy.MANUAL_BY_TOPIC):
    return QoSProfile(depth=10, liveliness=kind, liveliness_lease_duration=Duration(seconds=seconds))


p, pub, sub = make("deadline", deadline(0.3))
spin(0.8)
both("before the first message", pub, sub)
p.publish(Int32())
spin(1.05)
both("deadlines of 0.3 s in 1.05 s", pub, sub)
p.publish(Int32())
spin(0.1)
time.sleep(1.0)
spin(0.01)
both("missed in 1 s without spinning", pub, sub)
for _ in range(4):
    p.publish(Int32())
    spin(0.15)
both("met", pub, sub)
a.destroy_publisher(p)
spin(0.7)
both("destroyed", pub, sub)

p, pub, sub = make("two_deadlines", deadline(0.2), deadline(0.5))
p.publish(Int32())
spin(1.1)
both("deadlines of 0.2 and 0.5 s in 1.1 s", pub, sub)

p, pub, sub = make("manual", lease(0.4))
spin(0.8)
both("before the first assertion", pub, sub)
p.publish(Int32())
spin(1.0)
both("a message", pub, sub)
say("returns", p.assert_liveliness())
spin(1.0)
both("an assertion", pub, sub)
for _ in range(6):
    p.assert_liveliness()
    spin(0.15)
both("six assertions", pub, sub)
spin(1.0)
both("no more of them", pub, sub)
p.publish(Int32())
spin(0.1)
a.destroy_publisher(p)
spin(0.2)
both("destroyed while alive", pub, sub)

p, pub, sub = make("manual_and_longer", lease(0.3), lease(0.8, LivelinessPolicy.AUTOMATIC))
p.publish(Int32())
spin(0.6)
both("leases of 0.3 and 0.8 s after 0.6 s", pub, sub)
spin(0.6)
both("after 1.2 s", pub, sub)
a.destroy_publisher(p)
spin(0.2)
both("destroyed while not alive", pub, sub)

p, pub, sub = make("without", QoSProfile(depth=10, liveliness=LivelinessPolicy.MANUAL_BY_TOPIC))
p.publish(Int32())
spin(0.5)
a.destroy_publisher(p)
spin(0.2)
both("without a lease", pub, sub)
