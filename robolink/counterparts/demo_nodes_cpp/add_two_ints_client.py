"""Ask the service /add_two_ints for 2 + 3, and log the sum."""

from __future__ import annotations

import contextlib

import robolink
from robolink.client import Client
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.node import Node


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


def main(args: list[str] | None = None) -> None:
    """Ask for a sum."""
    ask("add_two_ints_client", args)


if __name__ == "__main__":
    main()
