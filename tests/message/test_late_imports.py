"""Imports that messages need are made with the endpoint, never in a callback, where they would stop all timers."""

from __future__ import annotations

import builtins
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from robolink import Context, Node
from robolink.interfaces import find, names
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Imu
from robolink.interfaces.sensor_msgs.srv import SetCameraInfo
from robolink.message.numbers import has_fixed_numbers

CALLBACKS = """
import sys

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces import find, names
from robolink.message.numbers import has_fixed_numbers
from robolink.running.timebase import VirtualTime
from robolink.transport.memory import Bus, MemoryTransport

context = Context(transport=MemoryTransport(bus=Bus()), time=VirtualTime())
context.init([])
node = Node("node", context=context)
executor = SingleThreadedExecutor(context=context)
executor.add_node(node)
types = [cls for cls in map(find, names("msg")) if not has_fixed_numbers(cls)]
got = []


def receive(message):
    got.append((repr(message), message == type(message)(), message.get_fields_and_field_types()))


publishers = [node.create_publisher(cls, f"topic_{at}", 10) for at, cls in enumerate(types)]
for at, cls in enumerate(types):
    node.create_subscription(cls, f"topic_{at}", receive, 10)


def publish():
    for publisher, cls in zip(publishers, types):
        publisher.publish(cls())
    node.get_logger().info("sent")
    node.get_clock().now().to_msg()


node.create_timer(0.1, publish)
known = set(sys.modules)
while len(got) < len(types):
    executor.spin_once(timeout_sec=1.0)
print(len(got), sorted(set(sys.modules) - known), "numpy" in sys.modules)
"""


@pytest.mark.processes
def test_callbacks_with_messages_of_all_types_import_nothing() -> None:
    done = subprocess.run([sys.executable, "-c", CALLBACKS], capture_output=True, text=True, check=True)
    plain = [name for name in names("msg") if not has_fixed_numbers(find(name))]
    assert done.stdout == f"{len(plain)} [] False\n"


def holds_an_array(message: Any) -> bool:
    values = [getattr(message, name) for name in message.__ros_fields__]
    parts = [kind.message() for kind in message.__ros_fields__.values() if kind.message is not None]
    return any(isinstance(value, np.ndarray) for value in values) or any(map(holds_an_array, parts))


@pytest.mark.slow
def test_the_types_that_need_numpy_are_known() -> None:
    for name in names("msg"):
        assert has_fixed_numbers(find(name)) == holds_an_array(find(name)()), name


@pytest.fixture
def imported(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The names that import statements name meanwhile."""
    found: list[str] = []
    real = builtins.__import__

    def spy(name: str, *more: Any, **rest: Any) -> Any:
        found.append(name)
        return real(name, *more, **rest)

    monkeypatch.setattr(builtins, "__import__", spy)
    return found


@pytest.mark.parametrize(
    "make",
    [
        lambda node: node.create_publisher(Imu, "imu", 10),
        lambda node: node.create_subscription(Imu, "imu", print, 10),
        lambda node: node.create_subscription(Imu, "imu", print, 10, raw=True),
        lambda node: node.create_service(SetCameraInfo, "set", print),
        lambda node: node.create_client(SetCameraInfo, "set"),
    ],
)
def test_every_endpoint_imports_numpy_for_its_type(
    context: Context, imported: list[str], make: Callable[[Node], Any]
) -> None:
    node = Node("node", context=context)
    imported.clear()
    make(node)
    assert "numpy" in imported


def test_an_endpoint_of_another_type_does_not(context: Context, imported: list[str]) -> None:
    node = Node("node", context=context)
    node.create_publisher(Twist, "cmd_vel", 10)
    assert "numpy" not in imported
