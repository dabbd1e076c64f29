"""Set, list, get and delete parameters of the node parameter_blackboard."""

from __future__ import annotations

import contextlib
from typing import Any

import robolink
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.interfaces.rcl_interfaces.msg import ParameterValue
from robolink.node import Node
from robolink.parameter import Parameter, parameter_value_to_python
from robolink.parameter_client import AsyncParameterClient
from robolink.task import Future

GIVEN = {"int_parameter": 10, "bool_parameter": False, "string_parameter": "Fee Fi Fo Fum"}
LOADED = {"other_int_parameter": 0, "int_parameter": 12, "string_parameter": "I smell the blood of an Englishman"}
"""Parameters that the client sets first, and those that ROS's demo loads from a file."""


class NoBlackboardError(RobolinkError, RuntimeError):
    """The node parameter_blackboard does not run."""


class _Demo:
    """A course of requests to the node parameter_blackboard, each of them logged."""

    def __init__(self, node: Node) -> None:
        self.node, self.client = node, AsyncParameterClient(node, "parameter_blackboard")

    def run(self) -> None:
        if not self.client.wait_for_services(3.0):
            raise NoBlackboardError(
                "parameter_blackboard is not there: start it by 'robolink run demo_nodes_cpp parameter_blackboard'"
            )
        self.set("Setting parameters:", GIVEN)
        self.log("Listing Parameters:")
        for name in self.result(self.client.list_parameters(list(GIVEN), 10)).result.names:
            self.log(f"    - {name}")
        self.log("Getting parameters:")
        values = self.result(self.client.get_parameters(list(GIVEN))).values
        for name, value in zip(GIVEN, values, strict=False):
            self.log(f"    - {name}: {shown(value)}")
        self.set("Loading parameters: ", LOADED)
        self.delete()

    def set(self, title: str, values: dict[str, Any]) -> None:
        self.log(title)
        given = [Parameter(name, value=value) for name, value in values.items()]
        for name, each in zip(values, self.result(self.client.set_parameters(given)).results, strict=False):
            self.log(f"    {name}:")
            self.log(f"        successful: {each.successful}")

    def delete(self) -> None:
        self.log("Deleting parameters: ")
        names = ["other_int_parameter", "other_string_parameter", "string_parameter"]
        for name, each in zip(names, self.result(self.client.delete_parameters(names)).results, strict=False):
            self.log(f"    {name}:")
            self.log(f"        successful: {each.successful}")
            self.log(f"        reason: {each.reason}")

    def log(self, text: str) -> None:
        self.node.get_logger().info(text)

    def result(self, future: Future[Any]) -> Any:
        robolink.spin_until_future_complete(self.node, future)
        return future.result()


def shown(value: ParameterValue) -> str:
    """Return a parameter's value in words; whoever answers may say that it is of no type that there is."""
    try:
        return str(parameter_value_to_python(value))
    except RuntimeError as error:
        return str(error)


def main(args: list[str] | None = None) -> None:
    """Set, list, get and delete parameters of the node parameter_blackboard."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        _Demo(Node("async_param_client")).run()


if __name__ == "__main__":
    main()
