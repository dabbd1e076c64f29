"""Nodes for tests of parameters: a minimal one, and a real one on the memory transport."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

from robolink import Context, Node
from robolink.clock import Clock
from robolink.interfaces.rcl_interfaces.msg import ParameterEvent
from robolink.node_parts.parameters import NodeParameters
from robolink.parameter import Parameter


def made(name: str, value: Any) -> Parameter[Any]:
    """Give a parameter with the type of its value."""
    return Parameter(name, value=value)


class Alone(NodeParameters):
    """As much of a node as its parameters need."""

    def __init__(self, overrides: dict[str, Any], allow_undeclared: bool, declare_all: bool) -> None:
        self.events: list[ParameterEvent] = []
        self._init_parameters_({name: made(name, each) for name, each in overrides.items()}, allow_undeclared)
        if declare_all:
            self._declare_from_overrides_()

    def get_clock(self) -> Clock:
        return Clock()

    def get_fully_qualified_name(self) -> str:
        return "/arm/driver"

    def _on_parameter_event_(self, event: ParameterEvent) -> None:
        self.events.append(event)


class RealNode(Node):
    """A node that remembers its events."""

    def __init__(self, context: Context, overrides: dict[str, Any], allow_undeclared: bool, declare_all: bool) -> None:
        self.events: list[ParameterEvent] = []
        super().__init__(
            "driver",
            context=context,
            namespace="/arm",
            parameter_overrides=[made(name, each) for name, each in overrides.items()],
            allow_undeclared_parameters=allow_undeclared,
            automatically_declare_parameters_from_overrides=declare_all,
        )

    def _on_parameter_event_(self, event: ParameterEvent) -> None:
        self.events.append(event)
        super()._on_parameter_event_(event)


Make: TypeAlias = Callable[..., "Alone | RealNode"]
"""``make(overrides, allow_undeclared=..., declare_all=...)`` gives a node that has told nothing yet."""


@contextmanager
def makes(kind: str) -> Iterator[Make]:
    """Give a maker of nodes, "alone" or real ones, which end with it."""
    context = Context(transport="memory")
    context.init([])
    nodes: list[RealNode] = []

    def make(
        overrides: dict[str, Any] | None = None, allow_undeclared: bool = False, declare_all: bool = False
    ) -> Alone | RealNode:
        if kind == "alone":
            return Alone(overrides or {}, allow_undeclared, declare_all)
        nodes.append(RealNode(context, overrides or {}, allow_undeclared, declare_all))
        nodes[-1].events.clear()
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()
    context.try_shutdown()
