"""Ask the service /add_two_ints for 41 + 1, and log the sum."""

from __future__ import annotations

import contextlib

import robolink
from robolink.client import Client
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.node import Node


def main(args: list[str] | None = None) -> None:
    """Ask for a sum once the service is there."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Node("minimal_client")
        client: Client = node.create_client(AddTwoInts, "add_two_ints")
        while not client.wait_for_service(timeout_sec=1.0):
            node.get_logger().info("service not available, waiting again...")
        request = AddTwoInts.Request(a=41, b=1)
        future = client.call_async(request)
        robolink.spin_until_future_complete(node, future)
        result = future.result()
        if result is not None:
            sum_ = f"{request.a} + {request.b} = {result.sum}"
            node.get_logger().info(f"Result of add_two_ints: for {sum_}")


if __name__ == "__main__":
    main()
