"""A service and its client whose calls can be observed on /add_two_ints/_service_event, as parameters say.

robolink run demo_nodes_py introspection --ros-args -p client_configure_introspection:=contents
"""

from __future__ import annotations

import contextlib
from typing import Any

import robolink
from robolink.client import Client
from robolink.counterparts.program import wrapped_int64
from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.parameters.descriptors import described
from robolink.qos import qos_profile_system_default
from robolink.service import Service
from robolink.service_introspection import ServiceIntrospectionState
from robolink.task import Future

STATES = {
    "disabled": ServiceIntrospectionState.OFF,
    "metadata": ServiceIntrospectionState.METADATA,
    "contents": ServiceIntrospectionState.CONTENTS,
}
"""States by the value of the parameter."""


class Observed(Node):
    """A node with one service or client, whose introspection a parameter configures."""

    def configure_by(self, parameter: str, of: Client | Service) -> None:
        """Let a parameter configure the introspection of a client or service."""

        def check(changed: list[Parameter[Any]]) -> SetParametersResult:
            wrong = any(each.name == parameter and each.value not in STATES for each in changed)
            reason = "must be one of 'disabled', 'metadata', or 'contents'" if wrong else ""
            return SetParametersResult(successful=not wrong, reason=reason)

        def act(changed: list[Parameter[Any]]) -> None:
            for each in changed:
                if each.name == parameter:
                    of.configure_introspection(self.get_clock(), qos_profile_system_default, STATES[each.value])

        self.add_on_set_parameters_callback(check)
        self.add_post_set_parameters_callback(act)
        self.declare_parameter(parameter, "disabled", described("disabled, metadata or contents"))


class IntrospectionService(Observed):
    """A node that adds two numbers on request."""

    def __init__(self) -> None:
        super().__init__("introspection_service")
        made = self.create_service(AddTwoInts, "add_two_ints", self.on_request)
        self.configure_by("service_configure_introspection", made)

    def on_request(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Add; a sum beyond 64 bits wraps, as in C++."""
        response.sum = wrapped_int64(request.a + request.b)
        self.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        return response


class IntrospectionClient(Observed):
    """A node that asks for a sum, again and again."""

    def __init__(self) -> None:
        super().__init__("introspection_client")
        self.client = self.create_client(AddTwoInts, "add_two_ints")
        self.configure_by("client_configure_introspection", self.client)
        self.asked: Future[Any] | None = None
        self.create_timer(0.5, self.on_timer)

    def on_timer(self) -> None:
        """Ask, or log the answer to the last question."""
        if not self.client.service_is_ready():
            return
        if self.asked is None:
            self.asked = self.client.call_async(AddTwoInts.Request(a=2, b=3))
        elif self.asked.done():
            answer: Any = self.asked.result()
            self.get_logger().info(f"Result of add_two_ints: {answer.sum}")
            self.asked = None


def main(args: list[str] | None = None) -> None:
    """Run both nodes until Ctrl-C."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor = SingleThreadedExecutor()
        for node in (IntrospectionService(), IntrospectionClient()):
            executor.add_node(node)
        executor.spin()


if __name__ == "__main__":
    main()
