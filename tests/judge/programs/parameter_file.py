# args: --ros-args --params-file $HERE/parameters.yaml -p over:=cli

"""A parameter file with patterns and sections, beside a value on the command line."""

import rclpy
from probe import say, show
from rclpy.node import Node

show("init", lambda: type(rclpy.init()).__name__)


def f(*a, **k):
    n = Node(*a, automatically_declare_parameters_from_overrides=True, **k)
    for name, v in sorted(n.get_parameters_by_prefix("").items()):
        if name not in ("use_sim_time", "start_type_description_service"):
            say(name, v.type_.name, list(v.value) if hasattr(v.value, "typecode") else v.value)


show("n53", lambda: f("n53"))
show("ns", lambda: f("n53", namespace="ns"))
show("other", lambda: f("other"))
