"""Callables that may be a callback."""

import functools

import rclpy
from probe import kind, say, show, text, until
from rclpy.subscription import MessageInfo
from std_msgs.msg import String
from std_srvs.srv import Trigger

rclpy.init()
n = rclpy.create_node("n83")
got = []


class C:
    def m(self, msg):
        got.append(("method", type(msg).__name__))

    def m2(self, msg, info):
        got.append(("method2", type(info).__name__))

    def __call__(self, msg):
        got.append(("object", type(msg).__name__))

    @staticmethod
    def st(msg):
        got.append(("static", type(msg).__name__))

    @classmethod
    def cl(cls, msg):
        got.append(("class", type(msg).__name__))


async def co(msg):
    got.append(("coroutine", type(msg).__name__))


async def co2(msg, info):
    got.append(("coroutine2", type(info).__name__))


def gen(msg):
    got.append(("gen", 1))
    yield 1


cases = dict(
    method=C().m,
    method2=C().m2,
    obj=C(),
    static=C.st,
    cls=C.cl,
    lam=lambda m: got.append(("lambda", type(m).__name__)),
    default=lambda m, i=5: got.append(("default", i)),
    kwonly=lambda m, *, i=6: got.append(("kwonly", i)),
    star=lambda *a: got.append(("star", len(a))),
    starkw=lambda m, **k: got.append(("starkw", sorted(k))),
    two=lambda m, i: got.append(("two", type(i).__name__)),
    two_star=lambda m, *a: got.append(("two_star", len(a))),
    partial1=functools.partial(lambda x, m: got.append(("partial", x)), 1),
    partialkw=functools.partial(lambda m, x: got.append(("partialkw", x)), x=2),
    partial_method=functools.partial(C.m, C()),
    annotated=None,
    coroutine=co,
    coroutine2=co2,
    generator=gen,
    wrapped=functools.wraps(co)(lambda m: got.append(("wrapped", 1))),
    lst=got.append,
    prt=print,
    lru=functools.lru_cache(lambda m: got.append(("lru", 1))),
)


def annotated(m: String, info: MessageInfo):
    got.append(("annotated", type(info).__name__))


cases["annotated"] = annotated
p = n.create_publisher(String, "t83", 10)
for k, f in cases.items():
    try:
        s = n.create_subscription(String, "t83", f, 10)
    except BaseException as e:
        say(k, "creation", kind(e), text(e))
        continue
    until(n, lambda: p.get_subscription_count() == 1, 2)
    got.clear()
    p.publish(String(data="x"))
    try:
        until(n, lambda: got, 0.7)
        say(k, got if k != "lst" else [type(x).__name__ for x in got])
    except BaseException as e:
        say(k, "spin", kind(e), text(e))
    n.destroy_subscription(s)
    until(n, lambda: p.get_subscription_count() == 0, 2)
show("callback attribute", lambda: n.create_subscription(String, "c83", C().m, 1).callback.__name__)
for k, f in dict(
    three=lambda q, r, x=1: r,
    star=lambda *a: a[1],
    partial=functools.partial(lambda x, q, r: r, 1),
    obj=type("O", (), {"__call__": lambda s, q, r: r})(),
    new_response=lambda q, r: Trigger.Response(success=True),
).items():
    sv = n.create_service(Trigger, "s83", f)
    c = n.create_client(Trigger, "s83")
    c.wait_for_service(2)
    fu = c.call_async(Trigger.Request())
    try:
        until(n, fu.done, 1)
        say("service", k, fu.result())
    except BaseException as e:
        say("service", k, kind(e), text(e))
    n.destroy_service(sv)
    n.destroy_client(c)
    until(n, lambda: False, 0.1)
