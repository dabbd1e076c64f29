"""Fixtures for tests of robolink action: a node that the commands see, and its servers."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from robolink import Node
from robolink.action import ActionClient, ActionServer
from robolink.interfaces.example_interfaces.action import Fibonacci
from tests.support.busy_actions import Polish, Sums
from tests.support.seen_by_commands import a_node_that_commands_see, made


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.fixture
def sums() -> Sums:
    return Sums()


@pytest.fixture
def busy(node: Node) -> Node:
    ActionServer(node, Fibonacci, "sums", print)
    ActionServer(node, Polish, "/polish", print)
    ActionClient(node, Fibonacci, "/elsewhere")
    ActionClient(made(node.context, "panel"), Fibonacci, "/lab/sums")
    return node
