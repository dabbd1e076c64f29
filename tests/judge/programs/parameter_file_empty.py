# args: --ros-args --params-file $HERE/empty_parameters.yaml

"""An empty list and a null in a parameter file."""

import rclpy
from probe import show, typed
from rclpy.node import Node

show("init", lambda: type(rclpy.init()).__name__)
typed(
    "n54 auto",
    lambda: sorted(Node("n54", automatically_declare_parameters_from_overrides=True).get_parameters_by_prefix("")),
)
typed("n54 declare", lambda: Node("n54").declare_parameter("empty", [1, 2]).value)
typed("n54 declare nul", lambda: Node("n54").declare_parameter("nul", 3).value)
