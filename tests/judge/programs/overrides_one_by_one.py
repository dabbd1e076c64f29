"""Odd values of parameters on the command line, one after another."""

from pathlib import Path

import rclpy
from probe import typed
from rclpy.context import Context
from rclpy.node import Node

for line in Path(__file__).with_name("overrides.txt").read_text().splitlines():
    line = line.replace("\\ ", " ")
    c = Context()

    def f():
        rclpy.init(args=["--ros-args", "-p", line], context=c)
        n = Node("n52", context=c, automatically_declare_parameters_from_overrides=True)
        r = [
            (k, v.type_.name, v.value if not hasattr(v.value, "typecode") else list(v.value))
            for k, v in sorted(n.get_parameters_by_prefix("").items())
            if k not in ("use_sim_time", "start_type_description_service")
        ]
        n.destroy_node()
        return r

    typed(line, f)
    c.try_shutdown()
