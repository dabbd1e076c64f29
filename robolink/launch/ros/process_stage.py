"""Stage of a launch file whose system is of real processes under a supervisor."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from robolink.launch.entry import Entry
from robolink.launch.ros.node_thread import NodeThread
from robolink.supervisor import Process, Supervisor
from robolink.supervisor.director import Request

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import Node


class ProcessStage:
    """Stage for real processes; it is a context manager, which leaves the network at its end.

    Args:
        supervisor: Supervisor of the processes.
        plan: Returns the processes in which entries run.
        make_context: Returns the initialised context of the launcher's own node; None is one of the environment's.
    """

    def __init__(
        self,
        supervisor: Supervisor,
        plan: Callable[[list[Entry]], Sequence[Process]],
        make_context: Callable[[], Context] | None = None,
    ) -> None:
        self._supervisor, self._plan = supervisor, plan
        self._node = NodeThread(make_context or _own_context, supervisor.say)

    def plan(self, entries: list[Entry]) -> Sequence[Process]:
        """Return the processes in which entries run that are added while the system runs."""
        return self._plan(entries)

    def with_node(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the launcher's own node, on its thread."""
        self._node(act)

    def post(self, act: Callable[[float], Sequence[Request[Process]]]) -> None:
        """Call `act` with the time in the supervisor's loop."""
        self._supervisor.direct(act)

    def __enter__(self) -> ProcessStage:
        return self

    def __exit__(self, *details: object) -> None:
        self._node.__exit__(*details)


def _own_context() -> Context:
    from robolink.context import Context

    context = Context()
    context.init([])
    return context
