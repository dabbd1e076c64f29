"""Two small nodes for tests of systems, one that counts and one that doubles, and the lines of a failure's text."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Node, Parameter
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import ExpectationError

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Counter(Node):
    """Counts on a topic, `rate` times a second, from `first` on."""

    def __init__(self) -> None:
        super().__init__("counter")
        self.value = self.declare_parameter("first", 0).value
        self.publisher = self.create_publisher(Int32, "count", 10)
        self.create_timer(1.0 / self.declare_parameter("rate", 10.0).value, self.on_timer)
        self.add_on_set_parameters_callback(self.on_parameters)

    def on_timer(self) -> None:
        self.publisher.publish(Int32(data=self.value))
        self.value += 1
        if self.value % 10 == 0:
            self.get_logger().info(f"counted to {self.value}")

    def on_parameters(self, parameters: list[Parameter[Any]]) -> SetParametersResult:
        return SetParametersResult(
            successful=all(each.name != "rate" for each in parameters), reason="not while it runs"
        )


class Doubler(Node):
    """Publishes the double of what it hears; it breaks at 13, and has a service."""

    def __init__(self) -> None:
        super().__init__("doubler")
        self.heard: list[int] = []
        self.stamps: list[int] = []
        self.publisher = self.create_publisher(Int32, "double", 10)
        self.state = self.create_publisher(String, "state", LATCHED)
        self.state.publish(String(data="ready"))
        self.create_subscription(Int32, "count", self.on_count, 100)
        self.create_service(SetBool, "~/enable", self.on_enable)
        self.get_logger().info("ready to double")

    def on_count(self, count: Int32) -> None:
        self.heard.append(count.data)
        self.stamps.append(self.get_clock().now().nanoseconds)
        if count.data == 13:
            raise ValueError("unlucky")
        self.publisher.publish(Int32(data=2 * count.data))

    def on_enable(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success, response.message = True, "on" if request.data else "off"
        return response


def told(error: pytest.ExceptionInfo[ExpectationError]) -> list[str]:
    return str(error.value).splitlines()
