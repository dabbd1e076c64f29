# args: --ros-args --params-file $HERE/patterns.yaml --params-file $HERE/more_patterns.yaml -p n91:nodecli:=1 -p glob:=cli

"""Parameter files with every kind of pattern for the names of nodes."""

from pathlib import Path

import rclpy
from probe import show
from rclpy.node import Node
from rclpy.parameter import parameter_dict_from_yaml_file

show("init", lambda: type(rclpy.init()).__name__)


def f(*a, **k):
    n = Node(*a, automatically_declare_parameters_from_overrides=True, **k)
    return {
        name: v.value
        for name, v in sorted(n.get_parameters_by_prefix("").items())
        if name not in ("use_sim_time", "start_type_description_service")
    }


show("n91", lambda: f("n91"))
show("ns/n91", lambda: f("n91", namespace="ns"))
show("ns/deep/n91", lambda: f("n91", namespace="ns/deep"))
show("other in ns", lambda: f("o91", namespace="ns"))
show("o91", lambda: f("o91"))
p = str(Path(__file__).with_name("patterns.yaml"))
show("dict", lambda: {k: v.value.integer_value for k, v in parameter_dict_from_yaml_file(p).items()})
show("dict wild", lambda: {k: v.value.integer_value for k, v in parameter_dict_from_yaml_file(p, True).items()})
show("dict target", lambda: sorted(parameter_dict_from_yaml_file(p, False, ["n91"])))
show("dict target wild", lambda: sorted(parameter_dict_from_yaml_file(p, True, ["/ns/n91"])))
show("dict none", lambda: parameter_dict_from_yaml_file(p, False, ["zz"]))
show("missing", lambda: parameter_dict_from_yaml_file("/nonexistent"))
