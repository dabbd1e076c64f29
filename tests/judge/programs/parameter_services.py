"""The parameter services of a node, called by another one."""

import array

import rclpy
from probe import say, show, until
from rcl_interfaces.msg import *
from rcl_interfaces.srv import *
from rclpy.node import Node
from rclpy.parameter import Parameter as P
from rclpy.parameter import get_parameter_value, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from rclpy.parameter_event_handler import ParameterEventHandler

rclpy.init()
n = Node("n60")
g = Node("g60")
ex = rclpy.executors.SingleThreadedExecutor()
ex.add_node(n)
ex.add_node(g)
ev = []
g.create_subscription(ParameterEvent, "/parameter_events", lambda m: ev.append(m) if m.node == "/n60" else None, 100)
until(ex, lambda: False, 0.5)
n.declare_parameters("", [("a", 1), ("b.c", "x"), ("r", 1, ParameterDescriptor(read_only=True)), ("d", [1.0])])
until(ex, lambda: len(ev) >= 4, 1)
say([[(p.name, p.value.type) for p in m.new_parameters] for m in ev], [len(m.changed_parameters) for m in ev])
ev.clear()


def call(t, name, req):
    c = g.create_client(t, f"/n60/{name}")
    c.wait_for_service(2)
    f = c.call_async(req)
    until(ex, f.done)
    r = f.result()
    g.destroy_client(c)
    return r


V = ParameterValue
show(
    "get",
    lambda: [
        v.type for v in call(GetParameters, "get_parameters", GetParameters.Request(names=["a", "zz", "b.c"])).values
    ],
)
show(
    "get all ok",
    lambda: [v.type for v in call(GetParameters, "get_parameters", GetParameters.Request(names=["a", "b.c"])).values],
)
show(
    "types", lambda: call(GetParameterTypes, "get_parameter_types", GetParameterTypes.Request(names=["a", "zz"])).types
)
show(
    "types ok",
    lambda: call(GetParameterTypes, "get_parameter_types", GetParameterTypes.Request(names=["a", "d"])).types,
)
show(
    "describe",
    lambda: call(DescribeParameters, "describe_parameters", DescribeParameters.Request(names=["a", "zz"])).descriptors,
)
show(
    "describe ok",
    lambda: call(DescribeParameters, "describe_parameters", DescribeParameters.Request(names=["r"])).descriptors,
)
show("list", lambda: call(ListParameters, "list_parameters", ListParameters.Request()))
show("list depth1", lambda: call(ListParameters, "list_parameters", ListParameters.Request(depth=1)))
show("list prefix", lambda: call(ListParameters, "list_parameters", ListParameters.Request(prefixes=["b"])))


def sp(*ps, atomic=False):
    ms = [Parameter(name=k, value=v) for k, v in ps]
    return (
        [
            (r.successful, r.reason)
            for r in call(SetParameters, "set_parameters", SetParameters.Request(parameters=ms)).results
        ]
        if not atomic
        else (lambda r: (r.successful, r.reason))(
            call(
                SetParametersAtomically, "set_parameters_atomically", SetParametersAtomically.Request(parameters=ms)
            ).result
        )
    )


show(
    "set",
    lambda: sp(
        ("a", V(type=2, integer_value=5)),
        ("zz", V(type=2)),
        ("r", V(type=2, integer_value=3)),
        ("a", V(type=4, string_value="s")),
    ),
)
show("a", lambda: n.get_parameter("a").value)
until(ex, lambda: ev, 1)
say([[(p.name, p.value.integer_value) for p in m.changed_parameters] for m in ev])
ev.clear()
show("atomic", lambda: sp(("a", V(type=2, integer_value=6)), ("r", V(type=2)), atomic=True))
show("delete", lambda: sp(("a", V(type=0))))
show(
    "array",
    lambda: (
        sp(("d", V(type=8, double_array_value=[2.0]))),
        type(n.get_parameter("d").value).__name__,
        list(n.get_parameter("d").value),
    ),
)
ev.clear()
n.undeclare_parameter("b.c")
until(ex, lambda: ev, 1)
say([[p.name for p in m.deleted_parameters] for m in ev])
n.add_on_set_parameters_callback(lambda ps: None)
show("callback None", lambda: sp(("a", V(type=2, integer_value=8))))
show(
    "node still answers",
    lambda: [v.type for v in call(GetParameters, "get_parameters", GetParameters.Request(names=["a"])).values],
)
c = AsyncParameterClient(g, "n60")
show("wait", lambda: c.wait_for_services(2))
show("ready", c.services_are_ready)


def ac(f):
    until(ex, f.done)
    return f.result()


show("client get", lambda: ac(c.get_parameters(["a"])).values[0].integer_value)
show("client list", lambda: ac(c.list_parameters()).result.names)
show("client types", lambda: ac(c.get_parameter_types(["a"])).types)
show("client describe", lambda: ac(c.describe_parameters(["r"])).descriptors[0].read_only)
show(
    "value_to_python",
    lambda: [
        parameter_value_to_python(x)
        for x in (
            V(type=1, bool_value=True),
            V(type=5, byte_array_value=[b"a"]),
            V(type=7, integer_array_value=[1]),
            V(),
            V(type=9, string_array_value=["a"]),
        )
    ],
)
show("bad type", lambda: parameter_value_to_python(V(type=99)))
show(
    "get_parameter_value",
    lambda: [
        get_parameter_value(x).type
        for x in (
            "1",
            "1.0",
            "true",
            "a",
            "[1, 2]",
            "[1.0]",
            "[a]",
            "[]",
            "",
            "null",
            "[true]",
            "{a: 1}",
            "1e3",
            "yes",
            "[1, a]",
        )
    ],
)
show("Type", lambda: [list(P.Type)[0], P.Type.from_parameter_value(b"a") if False else None])
show(
    "from",
    lambda: [
        P.Type.from_parameter_value(x).name
        for x in (True, 1, 1.0, "s", b"a", [True], [1], [1.0], ["s"], [b"a"], None, (1,), array.array("d", [1.0]))
    ],
)
show("from []", lambda: P.Type.from_parameter_value([]).name)
show("from dict", lambda: P.Type.from_parameter_value({}))
show(
    "check",
    lambda: (
        P.Type.INTEGER.check(1),
        P.Type.INTEGER.check(1.0),
        P.Type.DOUBLE.check(1),
        P.Type.BOOL.check(1),
        P.Type.INTEGER.check(True),
        P.Type.INTEGER_ARRAY.check([]),
        P.Type.STRING_ARRAY.check(("a",)),
        P.Type.BYTE_ARRAY.check([b"a"]),
    ),
)
show("P mismatch", lambda: P("a", P.Type.INTEGER, "s"))
show("P int double", lambda: P("a", P.Type.DOUBLE, 1))
show("P none", lambda: P("a").type_)
show("P type none", lambda: P("a", P.Type.INTEGER).value)
show("P bad type", lambda: P("a", 2, 1))
show("P name", lambda: P(3, value=1).name)
show("P eq", lambda: P("a", value=1) == P("a", value=1))
show("P set", lambda: setattr(P("a", value=1), "value", 2))
show("msg", lambda: P("a", value=[1, 2]).to_parameter_msg())
show("byte msg", lambda: P("a", value=[b"a"]).to_parameter_msg().value.byte_array_value)
h = ParameterEventHandler(g)
seen = []
n.set_parameters
m = Node("m60")
ex.add_node(m)
m.declare_parameter("q", 1)
hh = h.add_parameter_callback("q", "m60", lambda p: seen.append((p.name, p.value.integer_value)))
h.add_parameter_event_callback(lambda e: seen.append(e.node))
until(ex, lambda: False, 0.5)
seen.clear()
m.set_parameters([P("q", value=4)])
until(ex, lambda: len(seen) >= 2, 1)
say(seen)
show("remove", lambda: h.remove_parameter_callback(hh))
show("remove again", lambda: h.remove_parameter_callback(hh))
