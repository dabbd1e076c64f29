"""Set the parameter param2 whenever param1 is set."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.parameters.descriptors import described


class SetParametersCallback(Node):
    """A node in which setting `param1` sets `param2` to 4 as well. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("set_parameters_callback", **options)
        self.param1 = self.declare_parameter("param1", 0.0, described("sets param2 to 4 as well")).value
        self.param2 = self.declare_parameter("param2", 0.0, described("set by param1, too")).value
        self.add_pre_set_parameters_callback(self.complete)
        self.add_on_set_parameters_callback(self.check)
        self.add_post_set_parameters_callback(self.act)

    def complete(self, given: list[Parameter[Any]]) -> list[Parameter[Any]]:
        """Add `param2` to what is set if `param1` is."""
        more = [Parameter("param2", Parameter.Type.DOUBLE, 4.0) for each in given if each.name == "param1"]
        return [*given, *more]

    def check(self, given: list[Parameter[Any]]) -> SetParametersResult:
        """Accept `param1` and `param2`."""
        named = [each.name for each in given if each.name in ("param1", "param2")]
        return SetParametersResult(successful=bool(named), reason=f"success {named[-1]}" if named else "")

    def act(self, given: list[Parameter[Any]]) -> None:
        """Keep the new values."""
        for each in given:
            if each.name in ("param1", "param2"):
                setattr(self, each.name, each.value)
