"""What a system under test runs on: programs in this process, or processes of their own; both look the same to it."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias, runtime_checkable

if TYPE_CHECKING:
    from robolink.launch.reading.entries import Entry
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.node import Node
    from robolink.testing.faults import Faults
    from robolink.testing.recorder import Topic
    from robolink.transport import Transport

Startable: TypeAlias = "type[Node] | Callable[[], object] | str | Path"
"""A Node class, what `robolink run` finds by this name, a file, or a main() of one."""


@runtime_checkable
class Named(Protocol):
    """A node, or what stands for it."""

    def get_fully_qualified_name(self) -> str:
        """Give namespace and name."""


def full(node: str | Named) -> str:
    """Spell the name of a node with its leading slash. Raises TypeError for what is no node."""
    __tracebackhide__ = True
    if isinstance(node, str):
        return f"/{node.strip('/')}"
    if isinstance(node, Named) and not isinstance(node, type):
        return node.get_fully_qualified_name()
    raise TypeError(f"expected a node or its name, got {node!r}")


def startable(what: Any) -> type[Node] | str | Path:
    """Give what can be started: a class, or how `robolink run` finds it. Raises TypeError."""
    __tracebackhide__ = True
    from robolink.node import Node

    if isinstance(what, (str, PathLike)) or (isinstance(what, type) and issubclass(what, Node)):
        return what if isinstance(what, (str, type)) else Path(what)
    if inspect.isfunction(what) and what.__qualname__.isidentifier():
        return f"{inspect.getsourcefile(what)}:{what.__name__}"
    takes = "start takes a Node class, a name or a file"
    if isinstance(what, Named) and not isinstance(what, type):
        raise TypeError(f"{takes}, and makes the node: give {type(what).__name__}, not a node that is made already")
    raise TypeError(f"{takes}, or a main() of one, not {what!r}")


class Wanted(NamedTuple):
    """A node to start, and what it is told at its start."""

    what: type[Node] | str | Path
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

    def launch(self, entries: Sequence[Entry], faults: str | PathLike[str] | None = None) -> None:
        """Start what a launch file says, with what a file of faults says, which may concern its very start."""

    def stop(self, program: str) -> None:
        """End a program in order."""

    def crash(self, program: str) -> None:
        """End a program at once, with nothing said."""

    def restart(self, program: str) -> Any:
        """Start a program that has ended, or end it and start it anew."""

    @property
    def programs(self) -> list[str]:
        """The names of all programs, ended ones too: that of the node where it is one program's alone."""

    def program_of(self, node: str | Named) -> str:
        """Give the program of a node, or that in which one of this name runs. Raises NotFoundError."""

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until the condition holds, so many seconds at most; whether it holds."""

    def nodes_beside(self, started: Any) -> Sequence[str | Named]:
        """Give the nodes that what `start` gave is one of: those of its program; none before it has made them."""

    def nodes(self) -> list[Node]:
        """Give the nodes that live in this process, the test's own included."""

    def class_of(self, topic: Topic) -> type[Message] | None:
        """Give the message class that a topic's own publishers have, where that can be known without asking."""

    def fault_reports(self) -> list[str]:
        """Tell what each fault of messages has done so far."""

    def faults_in_vain(self) -> list[str]:
        """Tell which faults have come to nothing, so that a test with them has shown nothing, and why."""

    def real_time_use(self) -> list[str]:
        """Tell which nodes slept or started threads in real time, and where."""

    def close(self) -> None:
        """End all programs and leave the network."""
