"""Add two numbers at the service /add_two_ints."""

from __future__ import annotations

from typing import Any

from robolink.counterparts.program import wrapped_int64
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.node import Node


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
