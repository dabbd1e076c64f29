"""Counterparts of demo_nodes_cpp's programs that tutorials start, in Python."""

from __future__ import annotations

import contextlib
from typing import Any

import robolink
from robolink.client import Client
from robolink.counterparts.program import wrapped_int64
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.qos import qos_profile_sensor_data


class Talker(Node):
    """A node that publishes a count each second, from 1 on. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("talker", **options)
        self.count = 0
        self.chatter = self.create_publisher(String, "chatter", 7)
        self.create_timer(1.0, self.on_timer)

    def on_timer(self) -> None:
        """Publish the next count."""
        self.count += 1
        message = String(data=f"Hello World: {self.count}")
        self.get_logger().info(f"Publishing: '{message.data}'")
        self.chatter.publish(message)


class Listener(Node):
    """A node that logs what it hears. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("listener", **options)
        self.create_subscription(String, "chatter", self.on_chatter, 10)

    def on_chatter(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: [{message.data}]")


class ListenerBestEffort(Node):
    """A node that logs what it hears, and may miss some. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("listener", **options)
        self.create_subscription(String, "chatter", self.on_chatter, qos_profile_sensor_data)

    def on_chatter(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: [{message.data}]")


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


class AddTwoIntsServer(Node):
    """A node that adds two numbers on request. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("add_two_ints_server", **options)
        self.create_service(AddTwoInts, "add_two_ints", self.on_request)

    def on_request(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Add; a sum beyond 64 bits wraps, as in C++."""
        self.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        response.sum = wrapped_int64(request.a + request.b)
        return response


def ask(name: str, args: list[str] | None) -> None:
    """Ask by a node `name` once the service is there, and log its answer."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Node(name)
        client: Client = node.create_client(AddTwoInts, "add_two_ints")
        while not client.wait_for_service(timeout_sec=1.0):
            node.get_logger().info("service not available, waiting again...")
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
