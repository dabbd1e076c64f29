"""An action server and its client in virtual time, made when a test asks for them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Context, Node
from robolink.action import ActionClient, ActionServer
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.example_interfaces.action import Fibonacci
from tests.support.goals import PATIENCE, Waiting, fibonacci


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


@pytest.fixture
def server_node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("server", context=virtual)
    executor.add_node(made)
    return made


@pytest.fixture
def client(node: Node) -> ActionClient:
    return ActionClient(node, Fibonacci, "fibonacci")


@pytest.fixture
def serve(server_node: Node) -> Callable[..., ActionServer]:
    def make(execute: Callable[..., Any] = fibonacci, **options: Any) -> ActionServer:
        return ActionServer(server_node, Fibonacci, "fibonacci", execute, **options)

    return make


@pytest.fixture
def waiting() -> Waiting:
    return Waiting()


@pytest.fixture
def spun(context: Context) -> Iterator[SingleThreadedExecutor]:
    """An executor in real time that another thread spins."""
    executor = SingleThreadedExecutor(context=context)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    yield executor
    executor.shutdown()
    thread.join(PATIENCE)
