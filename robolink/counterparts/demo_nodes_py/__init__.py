"""Counterparts of demo_nodes_py: first programs with topics, services and parameters."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable
from typing import Any

import robolink
from robolink.client import Client
from robolink.counterparts.program import own_words, spin_times, wrapped_int64
from robolink.exceptions import DecodeError, ExternalShutdownException, RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.rcl_interfaces.msg import ParameterValue, SetParametersResult
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.parameter import Parameter, parameter_value_to_python
from robolink.parameter_client import AsyncParameterClient
from robolink.parameters.descriptors import described
from robolink.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data, qos_profile_system_default
from robolink.serialization import deserialize_message
from robolink.service import Service
from robolink.service_introspection import ServiceIntrospectionState
from robolink.task import Future


class Talker(Node):
    """A node that publishes a count each second.

    Args:
        name: Name of the node.
        qos: Profile or depth of the publisher.
        options: Those of `Node`.
    """

    def __init__(self, name: str = "talker", qos: QoSProfile | int = 10, **options: Any) -> None:
        super().__init__(name, **options)
        self.count = 0
        self.chatter = self.create_publisher(String, "chatter", qos)
        self.create_timer(1.0, self.on_timer)

    def on_timer(self) -> None:
        """Publish the next count."""
        message = String(data=f"Hello World: {self.count}")
        self.count += 1
        self.get_logger().info(f'Publishing: "{message.data}"')
        self.chatter.publish(message)


class Listener(Node):
    """A node that logs what it hears.

    Args:
        name: Name of the node.
        qos: Profile or depth of the subscription.
        options: Those of `Node`.
    """

    def __init__(self, name: str = "listener", qos: QoSProfile | int = 10, **options: Any) -> None:
        super().__init__(name, **options)
        self.create_subscription(String, "chatter", self.on_chatter, qos)

    def on_chatter(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: [{message.data}]")


class SerializedListener(Node):
    """A node that gets messages as bytes, and logs them and what they mean. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("serialized_subscriber", **options)
        self.create_subscription(String, "chatter", self.on_bytes, 10, raw=True)

    def on_bytes(self, payload: bytes) -> None:
        """Log a message as bytes and as text."""
        self.get_logger().info(f'I heard: "{payload!r}"')
        try:
            self.get_logger().info(f"I heard: [{deserialize_message(payload, String).data}]")
        except DecodeError as error:
            self.get_logger().warning(f"these bytes are not a String: {error}")


def run_with_qos(what: str, kind: Callable[[str, QoSProfile], Node], args: list[str] | None) -> None:
    """Run a node `what` of a class as the command line says: `--reliable`, `-n NUMBER`."""
    parser = argparse.ArgumentParser(f"{what}_qos")
    parser.add_argument("--reliable", action="store_true", help="reliable, not best effort")
    parser.add_argument("-n", "--number_of_cycles", type=int, default=20, help="callbacks after which it ends")
    options = parser.parse_args(own_words(args))
    reliable = QoSProfile(depth=10, reliability=ReliabilityPolicy.RELIABLE)

    def make() -> Node:
        node = kind(f"{what}_qos", reliable if options.reliable else qos_profile_sensor_data)
        node.get_logger().info(f"{'Reliable' if options.reliable else 'Best effort'} {what}")
        return node

    with robolink.init(args=args):
        spin_times(make, options.number_of_cycles)


def run_talker_qos(args: list[str] | None = None) -> None:
    """Run the talker of the command line."""
    run_with_qos("talker", Talker, args)


def run_listener_qos(args: list[str] | None = None) -> None:
    """Run the listener of the command line."""
    run_with_qos("listener", Listener, args)


class AddTwoIntsServer(Node):
    """A node that adds two numbers on request. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("add_two_ints_server", **options)
        self.create_service(AddTwoInts, "add_two_ints", self.on_request)

    def on_request(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Add; a sum beyond 64 bits wraps, as in C++."""
        response.sum = wrapped_int64(request.a + request.b)
        self.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        return response


def ask(name: str, args: list[str] | None) -> None:
    """Ask by a node `name` once the service is there, and log its answer."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Node(name)
        client: Client = node.create_client(AddTwoInts, "add_two_ints")
        while not client.wait_for_service(timeout_sec=1.0):
            sys.stdout.write("service not available, waiting again...\n")
            sys.stdout.flush()
        future = client.call_async(AddTwoInts.Request(a=2, b=3))
        robolink.spin_until_future_complete(node, future)
        result = future.result()
        if result is not None:
            node.get_logger().info(f"Result of add_two_ints: {result.sum}")


def run_client(args: list[str] | None = None) -> None:
    """Ask for a sum."""
    ask("add_two_ints_client", args)


def run_client_async(args: list[str] | None = None) -> None:
    """Ask for a sum."""
    ask("add_two_ints_client_async", args)


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


def run_parameter_client(args: list[str] | None = None) -> None:
    """Set, list, get and delete parameters of the node parameter_blackboard."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        _Demo(Node("async_param_client")).run()


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
        self.answer: Future[Any] | None = None
        self.create_timer(0.5, self.on_timer)

    def on_timer(self) -> None:
        """Ask, or log the answer to the last question."""
        if not self.client.service_is_ready():
            return
        if self.answer is None:
            self.answer = self.client.call_async(AddTwoInts.Request(a=2, b=3))
        elif self.answer.done():
            answer: Any = self.answer.result()
            self.get_logger().info(f"Result of add_two_ints: {answer.sum}")
            self.answer = None


def run_introspection(args: list[str] | None = None) -> None:
    """Run both nodes until Ctrl-C."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        executor = SingleThreadedExecutor()
        for node in (IntrospectionService(), IntrospectionClient()):
            executor.add_node(node)
        executor.spin()
