"""Callbacks before, on and after setting parameters, and what they may return."""

import rclpy
from probe import say, show
from rcl_interfaces.msg import SetParametersResult as R
from rclpy.node import Node
from rclpy.parameter import Parameter as P

rclpy.init()
n = Node("n35")
log = []


def pre(ps):
    log.append(("pre", [p.name for p in ps]))
    return ps + [P("b", value=9)] if ps and ps[0].name == "a" else ps


def on1(ps):
    log.append(("on1", [(p.name, p.value) for p in ps]))
    return R(successful=all(p.value != 13 for p in ps), reason="no 13")


def on2(ps):
    log.append(("on2", [p.name for p in ps]))
    return R(successful=True)


def post(ps):
    log.append(("post", [(p.name, p.value) for p in ps]))


n.declare_parameters("", [("a", 1), ("b", 2), ("c", 3)])
show("add pre", lambda: n.add_pre_set_parameters_callback(pre))
show("add on1", lambda: n.add_on_set_parameters_callback(on1))
n.add_on_set_parameters_callback(on2)
n.add_post_set_parameters_callback(post)


def st(*ps, atomic=False):
    log.clear()
    show(
        "result",
        lambda: (
            [(r.successful, r.reason) for r in n.set_parameters(list(ps))]
            if not atomic
            else (lambda r: (r.successful, r.reason))(n.set_parameters_atomically(list(ps)))
        ),
    )
    say(log)
    say([n.get_parameter(x).value for x in "abc"])


st(P("a", value=5))
st(P("c", value=13))
st(P("c", value=1), P("b", value=13), P("c", value=7))
st(P("c", value=2), P("b", value=13), atomic=True)
st()
log.clear()
show("declare calls", lambda: n.declare_parameter("d", 13))
say(log)
show("has d", lambda: n.has_parameter("d"))
log.clear()
show("declare ok", lambda: n.declare_parameter("e", 1).value)
say(log)
log.clear()
n.undeclare_parameter("e")
say("undeclare", log)
show("remove", lambda: n.remove_on_set_parameters_callback(on1))
show("remove twice", lambda: n.remove_on_set_parameters_callback(on1))
show("remove pre", lambda: n.remove_pre_set_parameters_callback(pre))
show("remove post", lambda: n.remove_post_set_parameters_callback(post))
st(P("c", value=13))
n.add_on_set_parameters_callback(lambda ps: None)
st(P("c", value=1))
m = Node("m35")
m.declare_parameter("c", 1)
m.add_on_set_parameters_callback(lambda ps: True)
show("returns True", lambda: m.set_parameters([P("c", value=2)]))
m = Node("m35")
m.declare_parameter("c", 1)
m.add_on_set_parameters_callback(lambda ps: 1 / 0)
show("raises", lambda: m.set_parameters([P("c", value=2)]))
show("c", lambda: m.get_parameter("c").value)
m = Node("m35")
m.declare_parameter("c", 1)
m.add_pre_set_parameters_callback(lambda ps: [])
show("pre returns empty", lambda: [(r.successful, r.reason) for r in m.set_parameters([P("c", value=2)])])
show("c", lambda: m.get_parameter("c").value)
m = Node("m35")
m.declare_parameter("c", 1)
m.add_pre_set_parameters_callback(lambda ps: None)
show("pre returns None", lambda: [(r.successful, r.reason) for r in m.set_parameters([P("c", value=2)])])
m = Node("m35")
m.declare_parameter("c", 1)
m.add_post_set_parameters_callback(lambda ps: 1 / 0)
show("post raises", lambda: m.set_parameters([P("c", value=2)]))
show("c", lambda: m.get_parameter("c").value)
m = Node("m35")
m.declare_parameter("c", 1)
m.add_on_set_parameters_callback(lambda ps: (say("inner value", m.get_parameter("c").value), R(successful=True))[1])
m.set_parameters([P("c", value=2)])
m = Node("m35")
m.declare_parameter("c", 1)


def setin(ps):
    m.set_parameters([P("c", value=3)])
    return R(successful=True)


m.add_on_set_parameters_callback(setin)
show("set inside on_set", lambda: m.set_parameters([P("c", value=2)]))
m = Node("m35")
m.declare_parameter("c", 1)
m.declare_parameter("d", 1)


def declin(ps):
    return R(successful=True) if not m.declare_parameter("x", 1) else R(successful=True)


m.add_on_set_parameters_callback(declin)
show("declare inside on_set", lambda: m.set_parameters([P("c", value=2)]))
show("old API", lambda: m.set_parameters_callback)
order = []
m = Node("m36")
m.declare_parameter("c", 1)
for i in range(3):
    m.add_on_set_parameters_callback(lambda ps, i=i: (order.append(i), R(successful=True))[1])
m.set_parameters([P("c", value=2)])
say("order", order)
