"""Descriptors of parameters: ranges, read-only, dynamic typing."""

import rclpy
from probe import show
from rcl_interfaces.msg import FloatingPointRange as F
from rcl_interfaces.msg import IntegerRange as I
from rcl_interfaces.msg import ParameterDescriptor as D
from rcl_interfaces.msg import ParameterType as T
from rcl_interfaces.msg import SetParametersResult as R
from rclpy.node import Node
from rclpy.parameter import Parameter as P

rclpy.init()
n = Node("n34")
k = [0]


def decl(label, value, desc, **kw):
    k[0] += 1
    name = f"p{k[0]}"
    show(label, lambda: n.declare_parameter(name, value, desc, **kw).value)
    return name


def st(label, name, value):
    show("  " + label, lambda: (lambda r: (r.successful, r.reason))(n.set_parameters([P(name, value=value)])[0]))


a = decl("int range", 5, D(integer_range=[I(from_value=0, to_value=10, step=2)]))
a = decl("int range ok", 4, D(integer_range=[I(from_value=0, to_value=10, step=2)]))
st("3", a, 3)
st("6", a, 6)
st("11", a, 11)
st("10", a, 10)
st("-1", a, -1)
a = decl("int odd end", 4, D(integer_range=[I(from_value=0, to_value=9, step=2)]))
st("9", a, 9)
st("8", a, 8)
a = decl("step 0", 4, D(integer_range=[I(from_value=0, to_value=9)]))
st("7", a, 7)
a = decl("step > range", 0, D(integer_range=[I(from_value=0, to_value=9, step=20)]))
st("9", a, 9)
st("5", a, 5)
a = decl("out", 40, D(integer_range=[I(from_value=0, to_value=9, step=1)]))
a = decl("two ranges", 4, D(integer_range=[I(from_value=0, to_value=9), I(from_value=20, to_value=30)]))
st("25", a, 25)
f = decl("float range", 0.5, D(floating_point_range=[F(from_value=0.0, to_value=1.0, step=0.1)]))
st("0.3", f, 0.3)
st("0.35", f, 0.35)
st("1.0", f, 1.0)
st("1.05", f, 1.05)
st("0.30000001", f, 0.30000001)
f = decl("float range step0", 0.5, D(floating_point_range=[F(from_value=0.0, to_value=1.0)]))
st("0.123", f, 0.123)
st("-0.1", f, -0.1)
st("1.0000000001", f, 1.0000000001)
st("inf", f, float("inf"))
st("nan", f, float("nan"))
f = decl("float range on int", 1, D(floating_point_range=[F(from_value=0.0, to_value=1.0)]))
st("5", f, 5)
f = decl("int range on float", 1.0, D(integer_range=[I(from_value=0, to_value=1)]))
st("5.0", f, 5.0)
f = decl("from > to", 1.0, D(floating_point_range=[F(from_value=3.0, to_value=1.0)]))
r = decl("read only", 1, D(read_only=True))
st("set", r, 2)
st("same", r, 1)
show("  undeclare", lambda: n.undeclare_parameter(r))
y = decl("dynamic", 1, D(dynamic_typing=True))
st("str", y, "s")
st("list", y, [1.0])
show("  none", lambda: n.set_parameters([P(y, P.Type.NOT_SET)])[0].successful)
t = decl("desc type other", 1, D(type=T.PARAMETER_STRING))
show("  describe", lambda: n.describe_parameter(t).type if n.has_parameter(t) else None)
t = decl("desc type only", None, D(type=T.PARAMETER_STRING))
show("  describe", lambda: n.describe_parameter(t))
t = decl("desc description", 1, D(description="d", additional_constraints="c", name="other"))
show("  describe", lambda: n.describe_parameter(t))
show("no type no value", lambda: n.declare_parameter("q1").value)
show("None with desc", lambda: n.declare_parameter("q2", None, D(description="x")).value)
show("None dynamic", lambda: n.declare_parameter("q3", None, D(dynamic_typing=True)).value)
show("descriptor not desc", lambda: n.declare_parameter("q4", 1, "text"))
show("descriptor positional None", lambda: n.declare_parameter("q5", 1, None))
show(
    "declare with type and override",
    lambda: Node("o", parameter_overrides=[P("a", value=7)]).declare_parameter("a", P.Type.STRING).value,
)
show(
    "type and override ok",
    lambda: Node("o", parameter_overrides=[P("a", value="7")]).declare_parameter("a", P.Type.STRING).value,
)
show(
    "override out of range",
    lambda: (
        Node("o", parameter_overrides=[P("a", value=70)])
        .declare_parameter("a", 1, D(integer_range=[I(from_value=0, to_value=9)]))
        .value
    ),
)
show(
    "override read only",
    lambda: Node("o", parameter_overrides=[P("a", value=70)]).declare_parameter("a", 1, D(read_only=True)).value,
)
show("set_descriptor", lambda: n.set_descriptor("p2", D(description="new")))
show("then", lambda: n.describe_parameter("p2"))
show("set_descriptor missing", lambda: n.set_descriptor("zz", D()))
show("set_descriptor ro", lambda: n.set_descriptor(r, D()))
show("set_descriptor bad range", lambda: n.set_descriptor("p2", D(integer_range=[I(from_value=100, to_value=200)])))
show(
    "alternative",
    lambda: n.set_descriptor(
        "p2",
        D(integer_range=[I(from_value=100, to_value=200)]),
        P.from_parameter_msg(P("p2", value=150).to_parameter_msg()).get_parameter_value(),
    ),
)
show("value", lambda: n.get_parameter("p2").value)
