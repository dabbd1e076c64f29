"""The runner of a system under test, as a protocol: programs in this process, or processes of their own."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias, runtime_checkable

if TYPE_CHECKING:
    from robolink.launch.entry import System as LaunchSystem
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.node import BaseNode, Node
    from robolink.testing.faults import Faults
    from robolink.testing.recorder import Recorder, Topic
    from robolink.transport import Transport


@runtime_checkable
class Named(Protocol):
    """Protocol of a node or its stand-in."""

    def get_fully_qualified_name(self) -> str:
        """Return the node's namespace and name."""


def full(node: str | Named) -> str:
    """Return the name of a node with its leading slash. Raises TypeError for any other object."""
    __tracebackhide__ = True
    if isinstance(node, str):
        return f"/{node.strip('/')}"
    if isinstance(node, Named) and not isinstance(node, type):
        return node.get_fully_qualified_name()
    raise TypeError(f"expected a node or its name, got {node!r}")


Startable: TypeAlias = "type[BaseNode] | Callable[[], object] | str | Path"
"""A Node class, a name as `robolink run` finds it, a file, or a main() of one."""


def startable(what: Any) -> type[BaseNode] | str | Path:
    """Return a startable thing: a class, or the name by which `robolink run` finds it. Raises TypeError."""
    __tracebackhide__ = True
    from robolink.node import BaseNode

    if isinstance(what, (str, PathLike)) or (isinstance(what, type) and issubclass(what, BaseNode)):
        return what if isinstance(what, (str, type)) else Path(what)
    if inspect.isfunction(what) and what.__qualname__.isidentifier():
        return f"{inspect.getsourcefile(what)}:{what.__name__}"
    takes = "start takes a Node class, a name or a file"
    if isinstance(what, Named) and not isinstance(what, type):
        raise TypeError(f"{takes}, and makes the node: give {type(what).__name__}, not a node that is made already")
    raise TypeError(f"{takes}, or a main() of one, not {what!r}")


class NodeRequest(NamedTuple):
    """A node to start, with the arguments of its start."""

    what: type[BaseNode] | str | Path
    name: str = ""
    namespace: str = ""
    parameters: Mapping[str, Any] = {}
    remappings: Mapping[str, str] = {}
    args: Sequence[str] = ()


class Failure(NamedTuple):
    """A program that ended and should not have: its name, the system's time in ns, the reason, and its exception."""

    program: str
    time_ns: int
    why: str
    error: BaseException | None = None


class Stage(Protocol):
    """Protocol of a runner: it runs the programs of a system and lets their time pass."""

    virtual: bool
    """True if time passes only while `run_until` runs."""
    domain: int
    node: Node
    """The test's own node."""
    begin_ns: int
    """The system's time at its beginning, in ns."""
    faults: Faults
    failures: list[Failure]
    logs: list[Record]

    def now_ns(self) -> int:
        """Return the system's time in ns."""

    def session(self) -> Transport:
        """Open a session on the network of the system that no fault touches."""

    def start(self, request: NodeRequest) -> Any:
        """Start a node; return it, or its stand-in."""

    def launch(self, system: LaunchSystem, faults: str | PathLike[str] | None = None) -> None:
        """Start the nodes of a launch file, with the faults of a file, which may concern their very start."""

    def settle(self, recorder: Recorder) -> None:
        """Wait until those that have been started know that the recorder hears them."""

    def stop(self, program: str) -> None:
        """End a program in order."""

    def crash(self, program: str) -> None:
        """End a program at once, with nothing said."""

    def restart(self, program: str) -> Any:
        """Start a program that has ended, or end it and start it anew."""

    @property
    def programs(self) -> list[str]:
        """Names of all programs, ended ones too: that of the node where it is one program's alone."""

    def program_of(self, node: str | Named) -> str:
        """Return the program of a node, or that in which one of this name runs. Raises NotFoundError."""

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until the condition holds or `within` seconds are over; True if it holds."""

    def nodes_beside(self, started: Any) -> Sequence[str | Named]:
        """Return the nodes of the program that `start` returned a node of; none before it has made them."""

    def nodes(self) -> list[Node]:
        """Return the nodes that live in this process, the test's own included."""

    def class_of(self, topic: Topic) -> type[Message] | None:
        """Return the message class that a topic's own publishers have, where that can be known without asking."""

    def fault_reports(self) -> list[str]:
        """Return the effects of each fault of messages so far."""

    def faults_in_vain(self) -> list[str]:
        """Return the faults that had no effect, so that a test with them has shown nothing, and why."""

    def real_time_use(self) -> list[str]:
        """Return which nodes slept or started threads in real time, and where."""

    def close(self) -> None:
        """End all programs and leave the network."""
