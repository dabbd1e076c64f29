"""Clocks of every type, their jump callbacks and what they sleep."""

import threading

import rclpy
from probe import say, show, took
from rclpy.clock import Clock, ClockChange, ClockType, JumpThreshold, ROSClock, TimeJump
from rclpy.duration import Duration
from rclpy.time import Time

show("types", lambda: list(ClockType))
show("int", lambda: [int(x) for x in ClockType])
show("ClockType(2)", lambda: ClockType(2))
show("ClockChange", lambda: list(ClockChange))
show("repr", lambda: Clock())
show("type", lambda: type(Clock(clock_type=ClockType.ROS_TIME)).__name__)
show("str", lambda: str(ROSClock()))
show("bad", lambda: Clock(clock_type="x"))
show("bad int", lambda: Clock(clock_type=1))
show("positional", lambda: Clock(ClockType.SYSTEM_TIME))
c = ROSClock()
show("active", lambda: c.ros_time_is_active)
show("set override inactive", lambda: c.set_ros_time_override(Time(seconds=1, clock_type=ClockType.ROS_TIME)))
show("activate", lambda: c._set_ros_time_is_active(True))
show("now", c.now)
show("active", lambda: c.ros_time_is_active)
show("set", lambda: c.set_ros_time_override(Time(seconds=5, clock_type=ClockType.ROS_TIME)))
show("now", c.now)
show("set other type", lambda: c.set_ros_time_override(Time(seconds=6)))
show("now", c.now)
show("set int", lambda: c.set_ros_time_override(3))
log = []
th = JumpThreshold(min_forward=Duration(seconds=1), min_backward=Duration(seconds=-1), on_clock_change=True)
h = c.create_jump_callback(
    th,
    pre_callback=lambda: log.append("pre"),
    post_callback=lambda j: log.append(
        (j.clock_change, j.delta, j.before, j.after) if False else (j.clock_change, j.delta)
    ),
)
for s in (5.5, 7, 6.5, 4):
    c.set_ros_time_override(Time(seconds=s, clock_type=ClockType.ROS_TIME))
    say(s, log)
    log.clear()
c._set_ros_time_is_active(False)
say([x if isinstance(x, str) else x[0] for x in log])
log.clear()
c._set_ros_time_is_active(False)
say(log)
log.clear()
c._set_ros_time_is_active(True)
say([x if isinstance(x, str) else x[0] for x in log])
log.clear()
show("unregister", h.unregister)
show("twice", h.unregister)
show("threshold none", lambda: JumpThreshold(min_forward=None, min_backward=None, on_clock_change=False))
show("threshold neg", lambda: JumpThreshold(min_forward=Duration(seconds=-1), min_backward=None))
show("threshold pos", lambda: JumpThreshold(min_forward=None, min_backward=Duration(seconds=1)))
show("threshold zero", lambda: JumpThreshold(min_forward=Duration(), min_backward=None))
show("threshold str", lambda: JumpThreshold(min_forward=1, min_backward=None))
show("no callbacks", lambda: c.create_jump_callback(th))
show("bad cb", lambda: c.create_jump_callback(th, pre_callback=3))
show("sleep_until uninit", lambda: Clock().sleep_until(Clock().now()))
show("sleep_for uninit", lambda: Clock().sleep_for(Duration(seconds=0.1)))
rclpy.init()
k = Clock()
took("sleep_for", k.sleep_for, Duration(seconds=0.3))
took("neg", k.sleep_for, Duration(seconds=-1))
took("past", k.sleep_until, Time(seconds=1, clock_type=ClockType.SYSTEM_TIME))
show("mixed", lambda: k.sleep_until(Time(seconds=1, clock_type=ClockType.ROS_TIME)))
show("mixed s", lambda: Clock(clock_type=ClockType.STEADY_TIME).sleep_until(Time(seconds=1)))
show("sleep float", lambda: k.sleep_for(0.1))
show("sleep_until float", lambda: k.sleep_until(0.1))
threading.Timer(0.3, lambda: c.set_ros_time_override(Time(seconds=20, clock_type=ClockType.ROS_TIME))).start()
took("ros sleep", c.sleep_until, Time(seconds=15, clock_type=ClockType.ROS_TIME))
threading.Timer(0.3, lambda: c._set_ros_time_is_active(False)).start()
took("ros sleep, source off", c.sleep_for, Duration(seconds=3))
threading.Timer(0.3, rclpy.shutdown).start()
took("shutdown", k.sleep_for, Duration(seconds=3))
took("after", lambda: k.sleep_for(Duration(seconds=0.3)))
show("attrs", lambda: sorted(x for x in dir(ROSClock) if not x.startswith("_")))
show("TimeJump attrs", lambda: sorted(x for x in dir(TimeJump) if not x.startswith("_")))
