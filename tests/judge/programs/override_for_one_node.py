# args: --ros-args -p n102:a:=1 -p b:=2 -p n102:b:=3 -p m102:b:=4 -r __node:=n102

"""Overrides on the command line for one node and for all."""

import rclpy
from probe import show
from rclpy.node import Node

rclpy.init()
n = Node("orig")
m = Node("m102")
show("names", lambda: (n.get_name(), m.get_name()))
show("a", lambda: n.declare_parameter("a", 0).value)
show("b", lambda: n.declare_parameter("b", 0).value)
show("m", lambda: m.declare_parameter("b", 0).value)
