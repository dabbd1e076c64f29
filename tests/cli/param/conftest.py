"""Fixtures for tests of robolink param: the node /lab/driver, and the one that the commands see."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from robolink import Node, Parameter
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
)
from tests.support.seen_by_commands import a_node_that_commands_see, spinning

DYNAMIC = ParameterDescriptor(dynamic_typing=True)


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as node:
        yield node


@pytest.fixture
def driver(robot: Node) -> Iterator[Node]:
    """The node /lab/driver, which spins."""
    node = Node("driver", namespace="/lab", context=robot.context)
    limits = FloatingPointRange(from_value=0.0, to_value=2.0, step=0.5)
    node.declare_parameter("speed", 1.0, ParameterDescriptor(description="m/s", floating_point_range=[limits]))
    node.declare_parameter("name", "1e3")
    length = ParameterDescriptor(read_only=True, integer_range=[IntegerRange(from_value=1, to_value=5)])
    node.declare_parameter("arm.length", 3, length)
    node.declare_parameter("arm.ids", [1, 2])
    node.declare_parameter("gains", [1.0, 2.5])
    node.declare_parameter("odd..", True)
    node.declare_parameter("free", 1, DYNAMIC)
    node.declare_parameter("unset", Parameter.Type.STRING)
    with spinning(node):
        yield node
