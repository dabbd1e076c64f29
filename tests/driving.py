"""Robots that drive in a simulated world, beside the nodes that drive them: in one process and in virtual time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from robolink import Future, Node, logging
from tests.nodefiles import load_node_file
from tests.simulated import START, System

PATIENCE = 300.0
"""Simulated seconds."""


class Drive(System):
    """A system, and what tests of driving ask of it."""

    robot: Any = None
    """The robot of the world that was added."""

    def add_world(self, path: str | Path) -> Any:
        """Add a world with one robot, by its name or file; give its node."""
        node = self.add(load_node_file("world").SimulatedWorld, {"world": str(path)})
        (self.robot,) = node.simulation.world.robots.values()
        return node

    def remove(self, node: Node) -> None:
        """End a node, as if its process had ended."""
        self.executor.remove_node(node)
        node.destroy_node()

    def result(self, future: Future[Any]) -> Any:
        """Let time pass until a future is done; give its result."""
        self.executor.spin_until_future_complete(future, timeout_sec=PATIENCE)
        assert future.done(), self.log[-5:]
        return future.result()

    def now(self) -> float:
        """Give the seconds since the start."""
        return (self.context.time.now() - START) / 1e9

    def said(self, words: str) -> int:
        """How many lines of the log begin so."""
        return sum(line.startswith(words) for line in self.log)


class Typed:
    """A keyboard that types what it is told."""

    def __init__(self) -> None:
        self.text, self.closed = "", False

    def read(self) -> str:
        text, self.text = self.text, ""
        return text

    def close(self) -> None:
        self.closed = True


@contextmanager
def drive() -> Iterator[Drive]:
    """Make a system whose nodes say nothing on the console."""
    logging.set_console_handler(None)
    made = Drive()
    try:
        yield made
    finally:
        made.close()
