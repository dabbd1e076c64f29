# args: --ros-args -p a:=1 -p b:=1.0 -p c:=true -p d:="1" -p e:='"1"' -p f:=[1,2] -p i:=yes -p j:=on -p k:=null -p m:=1e3 -p n:=1e-3 -p o:=0x10 -p p:=010 -p q:=.5 -p r:=5. -p s:=-1 -p t:=+1 -p u:=inf -p v:=.nan -p w:=[a,b] -p y:=True -p z:="a b"

"""Values of parameters on the command line, and the types that they become."""

import rclpy
from probe import show
from rclpy.node import Node

rclpy.init()
n = Node("n51", automatically_declare_parameters_from_overrides=True)
for x in "abcdefghijklmnopqrstuvwxyz":
    show(
        x,
        lambda: (
            n.get_parameter(x).type_.name,
            n.get_parameter(x).value
            if not hasattr(n.get_parameter(x).value, "typecode")
            else list(n.get_parameter(x).value),
        ),
    )
