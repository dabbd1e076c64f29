"""Interface of what a launch file that goes on needs of whoever runs its system: real processes or virtual time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Protocol, TypeVar

from robolink.launch.entry import Entry
from robolink.supervisor.director import Request

if TYPE_CHECKING:
    from robolink.node import Node

T = TypeVar("T")

NODE = "launch_ros"
"""Name of the launcher's own node, which it has only if it speaks to nodes with a lifecycle."""


class Stage(Protocol[T]):
    """Runner of a launch file's system; `T` is a process, or a program in virtual time."""

    def plan(self, entries: list[Entry]) -> Sequence[T]:
        """Return the processes in which entries run that are added while the system runs."""

    def with_node(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the launcher's own node, where that is spun; the node is made at the first call."""

    def post(self, act: Callable[[float], Sequence[Request[T]]]) -> None:
        """Call `act` with the time where the director is asked, and carry out what it returns; from any thread."""
