"""What a system under test runs on: programs in this process, or processes of their own; both look the same to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

if TYPE_CHECKING:
    from robolink.launch.entries import Entry
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.node import Node
    from robolink.testing.faults import Faults
    from robolink.testing.recorder import Topic
    from robolink.transport import Transport

Startable: TypeAlias = "type[Node] | str | Path"
"""A Node class, what `robolink run` finds by this name, or a file."""


class Wanted(NamedTuple):
    """A node to start, and what it is told at its start."""

    what: Startable
    name: str = ""
    namespace: str = ""
    parameters: Mapping[str, Any] = {}
    remappings: Mapping[str, str] = {}
    args: Sequence[str] = ()


class Failure(NamedTuple):
    """A program that ended and should not have: which, when (the system's nanoseconds), and why."""

    program: str
    time_ns: int
    why: str
    error: BaseException | None = None


class Stage(Protocol):
    """Runs the programs of a system, and lets their time pass."""

    virtual: bool
    """Whether time passes only while `run_until` runs."""
    domain: int
    node: Node
    """The test's own node."""
    begin_ns: int
    """The system's time at its beginning."""
    faults: Faults
    failures: list[Failure]
    logs: list[Record]

    def now_ns(self) -> int:
        """Give the system's time, in nanoseconds."""

    def session(self) -> Transport:
        """Open a session on the network of the system that no fault touches."""

    def start(self, wanted: Wanted) -> Any:
        """Start a node; give it, or what stands for it."""

    def launch(self, entries: Sequence[Entry]) -> None:
        """Start what a launch file says."""

    def stop(self, program: str) -> None:
        """End a program in order."""

    def crash(self, program: str) -> None:
        """End a program at once, with nothing said."""

    def restart(self, program: str) -> Any:
        """Start a program that has ended, or end it and start it anew."""

    @property
    def programs(self) -> list[str]:
        """The names of all programs, ended ones too."""

    def program_of(self, node: str) -> str:
        """Give the program in which a node of this name runs. Raises NotFoundError."""

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until the condition holds, so many seconds at most; whether it holds."""

    def nodes(self) -> list[Node]:
        """Give the nodes that live in this process, the test's own included."""

    def class_of(self, topic: Topic) -> type[Message] | None:
        """Give the message class that a topic's own publishers have, where that can be known without asking."""

    def fault_reports(self) -> list[str]:
        """Tell what each fault of messages has done so far."""

    def real_time_use(self) -> list[str]:
        """Tell which nodes slept or started threads in real time, and where."""

    def close(self) -> None:
        """End all programs and leave the network."""
