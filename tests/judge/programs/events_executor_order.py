"""In which order an EventsExecutor runs callbacks, what groups mean to it, and what it refuses."""

import threading
import time

import rclpy
from probe import say, show, until
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.experimental import EventsExecutor
from rclpy.timer import TimerInfo
from std_msgs.msg import Int32
from std_srvs.srv import SetBool

rclpy.init()
n = rclpy.create_node("n110")
m = rclpy.create_node("m110")
e = EventsExecutor()
log = []
show("add", lambda: (e.add_node(n), e.add_node(n), e.add_node(m)))
show("its executor", lambda: n.executor is e)
a = n.create_publisher(Int32, "a", 10)
b = n.create_publisher(Int32, "b", 10)
n.create_subscription(Int32, "a", lambda x: log.append(f"a{x.data}"), 10)
n.create_subscription(Int32, "b", lambda x: log.append(f"b{x.data}"), 10)
until(e, lambda: a.get_subscription_count() == 1 and b.get_subscription_count() == 1)
until(e, lambda: False, 0.3)
for i in range(3):
    a.publish(Int32(data=i))
    time.sleep(0.03)
    b.publish(Int32(data=i))
    time.sleep(0.03)
time.sleep(0.2)
until(e, lambda: len(log) == 6, 2)
say("by turns", log)
log.clear()
for i in range(3):
    a.publish(Int32(data=i))
time.sleep(0.1)
for i in range(3):
    b.publish(Int32(data=i))
time.sleep(0.2)
until(e, lambda: len(log) == 6, 2)
say("one after the other", log)
log.clear()
for i in range(15):
    a.publish(Int32(data=i))
time.sleep(0.3)
until(e, lambda: len(log) >= 15, 1)
say("15 at a depth of 10", log)
log.clear()

k = rclpy.create_node("k110")
k.create_subscription(Int32, "a", lambda x: log.append(f"k{x.data}"), 10)
k.create_subscription(Int32, "b", lambda x: log.append(f"l{x.data}"), 10)
until(e, lambda: a.get_subscription_count() == 2 and b.get_subscription_count() == 2)
for i in range(3):
    a.publish(Int32(data=i))
    time.sleep(0.03)
    b.publish(Int32(data=i))
    time.sleep(0.03)
time.sleep(0.2)
until(e, lambda: len(log) == 6, 2)
log.clear()
e.add_node(k)
until(e, lambda: len(log) == 6, 2)
say("what waited comes topic by topic", "".join(log) in ("k0k1k2l0l1l2", "l0l1l2k0k1k2"))
e.remove_node(k)
k.destroy_node()
until(e, lambda: False, 0.2)
log.clear()

n.create_subscription(Int32, "slow", lambda x: (log.append("s"), time.sleep(0.03)), 20)
p = n.create_publisher(Int32, "slow", 20)
until(e, lambda: p.get_subscription_count())
until(e, lambda: False, 0.3)
for i in range(10):
    p.publish(Int32(data=i))
time.sleep(0.2)
t = n.create_timer(0.05, lambda: log.append("t"))
until(e, lambda: log.count("s") == 10 and "t" in log, 3)
say("a timer waits for the whole backlog", log.index("t") if "t" in log else None)
n.destroy_timer(t)
log.clear()


def note(x):
    return lambda: log.append(x)


t = n.create_timer(0.05, note("t"))
until(e, lambda: "t" in log, 2)
time.sleep(0.33)
log.clear()
for _ in range(3):
    e.spin_once(timeout_sec=0)
say("ticks for several periods", log)
n.destroy_timer(t)
log.clear()


def with_info(info: TimerInfo):
    log.append(type(info).__name__)


def with_default(number=3):
    log.append(type(number).__name__)


for callback in (with_info, with_default):
    t = n.create_timer(0.05, callback)
    until(e, lambda: log, 1)
    say(callback.__name__, log[-1])
    n.destroy_timer(t)
    log.clear()

g = MutuallyExclusiveCallbackGroup()
f = rclpy.task.Future()


async def one():
    log.append("one begins")
    t1.cancel()
    await f
    log.append("one ends")


def two():
    log.append("two")
    t2.cancel()
    f.set_result(1)


t1 = n.create_timer(0.05, one, callback_group=g)
until(e, lambda: "one begins" in log, 1)
t2 = n.create_timer(0.05, two, callback_group=g)
until(e, lambda: "one ends" in log, 1)
say("a coroutine that waits in an exclusive group", log)
log.clear()


async def held(x):
    log.append(x.data)
    await rclpy.task.Future()


n.create_subscription(Int32, "c", held, 10)
c = n.create_publisher(Int32, "c", 10)
until(e, lambda: c.get_subscription_count())
for i in range(3):
    c.publish(Int32(data=i))
until(e, lambda: len(log) == 3, 1)
say("coroutines of one subscription", log)
log.clear()

tasks = [e.create_task(note(i)) for i in range(4)]
until(e, lambda: len(log) == 4, 1)
say("tasks", log)
log.clear()
n.create_service(SetBool, "s110", lambda q, r: (log.append(q.data), r)[1])
c = m.create_client(SetBool, "s110")
c.wait_for_service(2)
fs = [c.call_async(SetBool.Request(data=bool(i % 2))) for i in range(4)]
until(e, lambda: all(f.done() for f in fs), 2)
say("requests", log)
log.clear()


def nested():
    t.cancel()
    show("spin in a callback", lambda: e.spin_once(timeout_sec=0.1))


t = m.create_timer(0.05, nested)
until(e, t.is_canceled, 1)
th = threading.Thread(target=lambda: e.spin_until_future_complete(rclpy.task.Future(), 0.5))
th.start()
time.sleep(0.1)
show("spin in two threads", lambda: e.spin_once(timeout_sec=0.1))
th.join()
show("timeout", lambda: e.spin_once(timeout_sec=0.1))
done = rclpy.task.Future()
done.set_result(3)
show("future done", lambda: e.spin_until_future_complete(done, 5))
show("remove", lambda: (e.remove_node(m), e.remove_node(m), len(e.get_nodes())))
n.create_guard_condition(note("guard")).trigger()
show("guard", lambda: until(e, lambda: "guard" in log, 0.3))
say("guard ran", log)
