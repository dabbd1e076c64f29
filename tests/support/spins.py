"""Spin helpers: for some seconds, until a condition is true, or once and again; with a count of the calls meanwhile."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import robolink as rclpy
from robolink import Future, Node
from robolink.executors import Executor
from robolink.interfaces.std_msgs.msg import Int32

PATIENCE = 30.0

T = TypeVar("T")


def spin_for(executor: Executor, seconds: float) -> None:
    """Spin for so long on the executor's own time."""
    executor.spin_until_future_complete(Future(), timeout_sec=seconds)


def spin_until(executor: Executor, condition: Callable[[], bool], patience: float = PATIENCE) -> None:
    """Spin until it holds."""
    steady = executor.context.time.steady
    deadline = steady() + int(patience * 1e9)
    while not condition():
        assert steady() < deadline, "it did not come true"
        executor.spin_once(timeout_sec=0.02)


def parked_node() -> Node:
    """Make a node of the default context that has been spun twice, so that it is parked, and has nothing to do."""
    made = rclpy.create_node("node")
    spin_once_and_again(made, 2)
    return made


def spin_once_and_again(node: Node, count: int = 10) -> None:
    """Call `spin_once` so often, without waiting."""
    for _ in range(count):
        rclpy.spin_once(node, timeout_sec=0)


def done(executor: Executor, future: Future[T]) -> Any:
    """Spin until the future is done; its result."""
    executor.spin_until_future_complete(future, timeout_sec=PATIENCE)
    assert future.done(), "the future was not completed"
    return future.result()


def numbers(node: Node, topic: str, depth: int = 10) -> list[int]:
    """Subscribe to Int32; the list fills as they are received."""
    got: list[int] = []
    node.create_subscription(Int32, topic, lambda message: got.append(message.data), depth)
    return got


@contextmanager
def counted_calls() -> Iterator[list[str]]:
    """Yield what gets an element for each function, Python's and C's, that runs inside the block."""
    calls: list[str] = []

    def count(_: object, event: str, __: object) -> None:
        if event in ("call", "c_call"):
            calls.append(event)

    gc.collect()  # what other tests left is not to be counted
    gc.disable()
    sys.setprofile(count)
    try:
        yield calls
    finally:
        sys.setprofile(None)
        gc.enable()
