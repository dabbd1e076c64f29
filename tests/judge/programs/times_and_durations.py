"""Arithmetic, comparison and conversion of Time and Duration."""

import builtin_interfaces.msg as b
from probe import show
from rclpy.clock import ClockType
from rclpy.duration import Duration, Infinite
from rclpy.time import Time

show("t", lambda: Time(seconds=1, nanoseconds=5))
show("str", lambda: str(Time(seconds=1.5)))
show("d", lambda: Duration(seconds=1.5))
show("str d", lambda: str(Duration(seconds=-1.5)))
show("empty", lambda: (Time(), Duration()))
show("ros", lambda: Time(seconds=1, clock_type=ClockType.ROS_TIME))
show("positional", lambda: Time(1))
show("positional d", lambda: Duration(1))
show("neg time", lambda: Time(seconds=-1))
show("neg ns", lambda: Time(nanoseconds=-1))
show("huge", lambda: Time(nanoseconds=2**63))
show("huge-1", lambda: Time(nanoseconds=2**63 - 1))
show("huge s", lambda: Time(seconds=1e10))
show("huge d", lambda: Duration(nanoseconds=2**63))
show("min d", lambda: Duration(nanoseconds=-(2**63)))
show("below", lambda: Duration(nanoseconds=-(2**63) - 1))
show("huge s d", lambda: Duration(seconds=1e20))
show("str seconds", lambda: Duration(seconds="1"))
show("None", lambda: Duration(seconds=None))
show("nan", lambda: Duration(seconds=float("nan")))
show("inf", lambda: Duration(seconds=float("inf")))
show("clock type bad", lambda: Time(seconds=1, clock_type=1))
show("clock type str", lambda: Time(clock_type="ros"))
t, u, d = Time(seconds=10), Time(seconds=12, nanoseconds=7), Duration(seconds=3)
r = Time(seconds=10, clock_type=ClockType.ROS_TIME)
import operator as o

for name in "add sub eq ne lt le gt ge mul truediv floordiv mod".split():
    f = getattr(o, name)
    for ln, l in (("t", t), ("d", d), ("r", r)):
        for rn, x in (("u", u), ("d", d), ("r", r), ("2", 2), ("2.5", 2.5), ("None", None), ("'x'", "x")):
            show(f"{ln} {name} {rn}", f, l, x)
show("2*d", lambda: 2 * d)
show("neg", lambda: -d)
show("abs", lambda: abs(d))
show("bool", lambda: (bool(d), bool(Duration()), bool(Time())))
show("hash t", lambda: hash(t) == hash(Time(seconds=10)))
show("hash d", lambda: hash(d) == hash(Duration(seconds=3)))
show("sum", lambda: sum([d, d], Duration()))
show("max", lambda: max(t, u))
show("sorted", lambda: sorted([Duration(seconds=2), Duration(seconds=1)]))
show("t overflow", lambda: Time(nanoseconds=2**63 - 1) + Duration(nanoseconds=1))
show("t underflow", lambda: Time() - Duration(nanoseconds=1))
show("d overflow", lambda: Duration(nanoseconds=2**63 - 1) + Duration(nanoseconds=1))
show("to_msg", t.to_msg)
show("d to_msg", lambda: Duration(seconds=-1.5).to_msg())
show("from_msg", lambda: Time.from_msg(b.Time(sec=1, nanosec=2)))
show("from_msg ct", lambda: Time.from_msg(b.Time(sec=1), clock_type=ClockType.STEADY_TIME))
show("d from", lambda: Duration.from_msg(b.Duration(sec=-2, nanosec=500000000)))
show("from wrong", lambda: Time.from_msg(3))
show("from dur", lambda: Time.from_msg(b.Duration(sec=1)))
show("d from time", lambda: Duration.from_msg(b.Time(sec=1)))
show("big to_msg", lambda: Time(seconds=2**31).to_msg())
show("neg from", lambda: Time.from_msg(b.Time(sec=-1)))
show("s_ns", lambda: Time(seconds=1, nanoseconds=5).seconds_nanoseconds())
show("ns", lambda: Time(seconds=0.1).nanoseconds)
show(
    "float s",
    lambda: (
        Time(seconds=1.000000001).nanoseconds,
        Duration(seconds=0.3).nanoseconds,
        Duration(seconds=1e-9).nanoseconds,
        Duration(seconds=0.1 + 0.2).nanoseconds,
        Duration(nanoseconds=1.9).nanoseconds,
        Duration(seconds=-0.0000000015).nanoseconds,
    ),
)
show("clock_type", lambda: t.clock_type)
show("set", lambda: setattr(t, "nanoseconds", 3))
show("set ct", lambda: setattr(t, "clock_type", 3))
show("Infinite", lambda: Infinite)
show("int()", lambda: int(d))
show("float()", lambda: float(d))
show("Duration kw", lambda: Duration(sec=1))
show("attrs", lambda: sorted(x for x in dir(Time) if not x.startswith("_")))
show("attrs d", lambda: sorted(x for x in dir(Duration) if not x.startswith("_")))
show("numpy", lambda: Duration(seconds=__import__("numpy").float32(0.5)))
show("numpy i", lambda: Duration(nanoseconds=__import__("numpy").int64(5)))
show("copy", lambda: __import__("copy").copy(t) == t)
show("deepcopy", lambda: __import__("copy").deepcopy(d) == d)
show("get_c_duration", lambda: type(d.get_c_duration()).__name__)
