"""Nodes for tests of parameters, on the memory transport, which note the events that they publish."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

from robolink import Context, Node
from robolink.interfaces.rcl_interfaces.msg import ParameterEvent
from robolink.parameter import Parameter


def made(name: str, value: Any) -> Parameter[Any]:
    """Give a parameter with the type of its value."""
    return Parameter(name, value=value)


class RecordingNode(Node):
    """A node that remembers its events."""

    def __init__(self, context: Context, overrides: dict[str, Any], allow_undeclared: bool, declare_all: bool) -> None:
        super().__init__(
            "driver",
            context=context,
            namespace="/arm",
            parameter_overrides=[made(name, each) for name, each in overrides.items()],
            allow_undeclared_parameters=allow_undeclared,
            automatically_declare_parameters_from_overrides=declare_all,
        )
        self.events: list[ParameterEvent] = []
        self._publisher = self._parameter_store_.events
        self._parameter_store_.events = self  # type: ignore[assignment]  # it publishes, after noting

    def publish(self, event: ParameterEvent) -> None:
        self.events.append(event)
        assert self._publisher is not None
        self._publisher.publish(event)


Make: TypeAlias = Callable[..., RecordingNode]
"""``make(overrides, allow_undeclared=..., declare_all=...)`` gives a node that has sent no event yet."""


@contextmanager
def makes() -> Iterator[Make]:
    """Give a maker of nodes on the memory transport, which end with it."""
    context = Context(transport="memory")
    context.init([])
    nodes: list[RecordingNode] = []

    def make(
        overrides: dict[str, Any] | None = None, allow_undeclared: bool = False, declare_all: bool = False
    ) -> RecordingNode:
        nodes.append(RecordingNode(context, overrides or {}, allow_undeclared, declare_all))
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()
    context.try_shutdown()
