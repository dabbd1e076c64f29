"""Timers, clocks and sleeps on /clock, which also jumps back."""

import threading
import time

import rclpy
from probe import say, show, until
from rclpy.clock import ClockType
from rclpy.parameter import Parameter as P
from rclpy.time import Time
from rosgraph_msgs.msg import Clock

rclpy.init()
n = rclpy.create_node("n63", parameter_overrides=[P("use_sim_time", value=True)])
g = rclpy.create_node("g63")
p = g.create_publisher(Clock, "/clock", 10)
ex = rclpy.executors.SingleThreadedExecutor()
ex.add_node(n)
show("now before clock", lambda: n.get_clock().now())
show("active", lambda: n.get_clock().ros_time_is_active)
calls = []
t = n.create_timer(1.0, lambda: calls.append(n.get_clock().now().nanoseconds / 1e9))
until(ex, lambda: p.get_subscription_count(), 2)


def tick(s):
    m = Clock()
    m.clock.sec = int(s)
    m.clock.nanosec = int((s % 1) * 1e9)
    p.publish(m)
    until(ex, lambda: abs(n.get_clock().now().nanoseconds / 1e9 - s) < 1e-3, 1)
    until(ex, lambda: False, 0.15)


for s in (10, 10.5, 11, 11.9, 12.1, 15, 15.2, 3, 3.5, 4.1):
    tick(s)
    say(s, calls)
    calls.clear()
show("time type", lambda: n.get_clock().now().clock_type)
n.set_parameters([P("use_sim_time", value=False)])
show("off", lambda: (n.get_clock().ros_time_is_active, n.get_clock().now().nanoseconds > 10**18))
n.set_parameters([P("use_sim_time", value=True)])
show("on", lambda: n.get_clock().now())
show("undeclare", lambda: n.undeclare_parameter("use_sim_time"))
show("stamp", lambda: n.get_clock().now().to_msg())
show("log throttle under sim time", lambda: "skip")
tick(20)
res = []
th = threading.Thread(target=lambda: res.append(n.get_clock().sleep_for(rclpy.duration.Duration(seconds=1))))
th.start()
time.sleep(0.3)
say(res)
tick(20.5)
say(res)
tick(21.5)
th.join(1)
say(res)
th = threading.Thread(target=lambda: res.append(n.get_clock().sleep_for(rclpy.duration.Duration(seconds=5))))
th.start()
time.sleep(0.2)
tick(1.0)
th.join(1)
say("jump back", res, th.is_alive())
if th.is_alive():
    tick(40)
    th.join(1)
