"""Keep whatever parameters others set.

robolink run demo_nodes_cpp parameter_blackboard --ros-args -p mood:=good
"""

from __future__ import annotations

from typing import Any

from robolink.node import Node


class ParameterBlackboard(Node):
    """A node that accepts any parameter. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        options.setdefault("automatically_declare_parameters_from_overrides", True)
        super().__init__("parameter_blackboard", allow_undeclared_parameters=True, **options)
        count = len(self.list_parameters([], 0).names)
        name = self.get_fully_qualified_name()
        self.get_logger().info(
            f"Parameter blackboard node named '{name}' ready, and serving '{count}' parameters already!"
        )
