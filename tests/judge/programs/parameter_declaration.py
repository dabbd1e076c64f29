"""declare_parameter and its relatives: the values that they accept, return and refuse."""

import rclpy
from probe import show
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterType,
    ParameterValue,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

rclpy.init()
n = Node("n33")
P = Parameter


def d(label, *a, **k):
    show(label, lambda: (lambda p: (p.name, p.type_, p.value))(n.declare_parameter(*a, **k)))


d("int", "i", 1)
d("float", "f", 1.5)
d("bool", "b", True)
d("str", "s", "x")
d("ints", "ia", [1, 2])
d("floats", "fa", [1.0, 2.0])
d("bools", "ba", [True, False])
d("strs", "sa", ["a"])
d("bytes", "by", [b"a", b"b"])
d("bytes obj", "bo", b"ab")
d("tuple", "tu", (1, 2))
d("empty", "e", [])
d("mixed", "mi", [1, 2.0])
d("mixed2", "mi2", [1, "a"])
d("dict", "di", {"a": 1})
d("nested", "ne", [[1]])
d("array", "ar", __import__("array").array("q", [1, 2]))
d("array d", "ad", __import__("array").array("d", [1, 2]))
d("numpy", "np", __import__("numpy").array([1, 2]))
d("np int", "npi", __import__("numpy").int64(3))
d("np float", "npf", __import__("numpy").float64(3))
d("set", "se", {1})
d("object", "ob", object())
d("huge int", "hi", 2**63)
d("none", "n1")
d("None", "n2", None)
d("type", "t1", P.Type.STRING)
d("type array", "t2", P.Type.INTEGER_ARRAY)
d("type NOT_SET", "t3", P.Type.NOT_SET)
d("twice", "i", 2)
d("empty name", "", 1)
d("odd name", "a b", 1)
d("dots", "a.b.c", 1)
d("slash", "a/b", 1)
d("digit", "1a", 1)
d("unicode", "é", 1)
d("int name", 3, 1)
show("get undeclared", lambda: n.get_parameter("nope"))
show("get_or", lambda: n.get_parameter_or("nope", P("nope", P.Type.INTEGER, 5)).value)
show("get_or none", lambda: n.get_parameter_or("nope").value)
show("get_or declared", lambda: n.get_parameter_or("i", P("q", value=9)).value)
show("has", lambda: (n.has_parameter("i"), n.has_parameter("nope")))
show("get t1", lambda: n.get_parameter("t1").value)
show("get n1", lambda: (n.get_parameter("n1").type_, n.get_parameter("n1").value))


def st(label, *ps):
    show(label, lambda: [(r.successful, r.reason) for r in n.set_parameters(list(ps))])


st("set ok", P("i", value=5))
show("i", lambda: n.get_parameter("i").value)
st("set other type", P("i", value="x"))
st("set float to int", P("i", value=1.0))
st("set int to float", P("f", value=1))
st("undeclared", P("nope", value=1))
st("set none", P("i", P.Type.NOT_SET))
show("i", lambda: (n.has_parameter("i"),))
st("t1", P("t1", value="s"))
st("t1 wrong", P("t1", value=1))
st("n2", P("n2", value=1))
show("set str", lambda: n.set_parameters(["a"]))
show("set not list", lambda: n.set_parameters(P("f", value=1.0)))
show("set dict", lambda: n.set_parameters([{"name": "f"}]))
show(
    "atomically",
    lambda: (lambda r: (r.successful, r.reason))(n.set_parameters_atomically([P("f", value=2.0), P("s", value=3)])),
)
show("f", lambda: n.get_parameter("f").value)
show("atomically undeclared", lambda: n.set_parameters_atomically([P("nope", value=3)]))
show("undeclare", lambda: n.undeclare_parameter("f"))
show("twice", lambda: n.undeclare_parameter("f"))
show("get after", lambda: n.get_parameter("f"))
show("get_parameters", lambda: [p.value for p in n.get_parameters(["s", "b"])])
show("missing one", lambda: n.get_parameters(["s", "zz"]))
show("get_parameters str", lambda: [p.value for p in n.get_parameters("s")])
show("get_parameter int", lambda: n.get_parameter(3))
show("types", lambda: int(n.get_parameter_type("s")))
show("types missing", lambda: n.get_parameter_type("zz"))
show("get_parameter_types", lambda: list(map(int, n.get_parameter_types(["s", "b"]))))
show("prefix", lambda: {k: v.value for k, v in n.get_parameters_by_prefix("a").items()})
show("prefix empty", lambda: sorted(n.get_parameters_by_prefix(""))[:3])
show(
    "declare_parameters",
    lambda: [
        p.value
        for p in n.declare_parameters(
            "ns", [("x", 1), ("y", 2.0, ParameterDescriptor(description="d")), ("z", P.Type.BOOL)]
        )
    ],
)
show("has", lambda: n.has_parameter("ns.x"))
show("declare dup", lambda: [p.value for p in n.declare_parameters("", [("q", 1), ("q", 2)])])
show("q?", lambda: n.has_parameter("q"))
show("bad tuple", lambda: n.declare_parameters("", [("only",), "str"]))
show("declare empty ns tuple", lambda: [p.value for p in n.declare_parameters("", [("w",)])])
show("describe", lambda: n.describe_parameter("s"))
show("describe missing", lambda: n.describe_parameter("zz"))
show("describe n1", lambda: n.describe_parameter("n1").dynamic_typing)
show("describes", lambda: [x.name for x in n.describe_parameters(["s", "b"])])
show("list", lambda: n.list_parameters(["ns"], 0))
show("list depth", lambda: n.list_parameters([], 1).prefixes)
show("use_sim_time", lambda: n.get_parameter("use_sim_time").value)
show(
    "set use_sim_time str", lambda: [(r.successful, r.reason) for r in n.set_parameters([P("use_sim_time", value="x")])]
)
show("override value", lambda: Node("o", parameter_overrides=[P("a", value=7)]).declare_parameter("a", 1).value)
show(
    "ignore_override",
    lambda: Node("o", parameter_overrides=[P("a", value=7)]).declare_parameter("a", 1, ignore_override=True).value,
)
show("override type", lambda: Node("o", parameter_overrides=[P("a", value="7")]).declare_parameter("a", 1).value)
show("override None decl", lambda: Node("o", parameter_overrides=[P("a", value="7")]).declare_parameter("a").value)
show("override undeclared", lambda: Node("o", parameter_overrides=[P("a", value="7")]).get_parameter("a"))
show(
    "auto",
    lambda: sorted(
        Node(
            "o", parameter_overrides=[P("a.b", value=7)], automatically_declare_parameters_from_overrides=True
        ).get_parameters_by_prefix("a")
    ),
)
show("allow", lambda: Node("o", allow_undeclared_parameters=True).get_parameter("x").value)
m = Node("o", allow_undeclared_parameters=True)
show(
    "allow set",
    lambda: (
        m.set_parameters([P("x", value=1)])[0].successful,
        m.get_parameter("x").value,
        m.set_parameters([P("x", value="s")])[0].successful,
        m.get_parameter("x").value,
    ),
)
show("allow unset", lambda: (m.set_parameters([P("x", P.Type.NOT_SET)])[0].successful, m.has_parameter("x")))
