# args: --ros-args -p d:=1 -p i:=1.0 -p s:=5 -p b:=1 -p da:=[1,2] -p sa:=[1,2] -p dyn:=x -p st:=true

"""An override of another type than the parameter is declared with."""

import rclpy
from probe import show
from rcl_interfaces.msg import ParameterDescriptor as D
from rclpy.node import Node
from rclpy.parameter import Parameter as P

rclpy.init()
n = Node("n86")
show("double from 1", lambda: n.declare_parameter("d", 1.0).value)
show("declared?", lambda: n.has_parameter("d"))
show("int from 1.0", lambda: n.declare_parameter("i", 1).value)
show("string from 5", lambda: n.declare_parameter("s", "x").value)
show("bool from 1", lambda: n.declare_parameter("b", False).value)
show("double array from ints", lambda: list(n.declare_parameter("da", [1.0]).value))
show("string array from ints", lambda: n.declare_parameter("sa", ["a"]).value)
show("dynamic", lambda: n.declare_parameter("dyn", 1, D(dynamic_typing=True)).value)
show("string from true", lambda: n.declare_parameter("st", "x").value)
show("P.Type", lambda: Node("x86").declare_parameter("d", P.Type.DOUBLE).value)
