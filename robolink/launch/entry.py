"""Plan of a system, which the readers of both kinds of launch files fill: its entries, and what goes on while it runs.

An entry is a fully expanded node or command to start.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Protocol, TypeVar

import msgspec

from robolink.exceptions import DocumentError
from robolink.supervisor.director import Director, Request
from robolink.workspace import NodeSource

if TYPE_CHECKING:
    from robolink.node import Node

T = TypeVar("T")

MOST_PROCESSES = 1_000
"""Most processes of a system."""

NODE = "launch_ros"
"""Name of the launcher's own node, which it has only if it speaks to nodes with a lifecycle."""


Seconds = Annotated[float, msgspec.Meta(ge=0.0)]
When = Literal["never", "on_failure", "always"]
OnExit = Literal["shutdown", "ignore"]
LogLevel = Literal["debug", "info", "warn", "error", "fatal"]


class Respawn(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Restart policy of a process, with exponential backoff.

    A restart waits `delay` seconds, twice as long each time, up to `delay_max`. After `most` starts `within` so many
    seconds the process is given up, and its end counts as an end.
    """

    when: When = "on_failure"
    delay: Seconds = 1.0
    delay_max: Seconds = 30.0
    most: Annotated[int, msgspec.Meta(ge=1)] = 5
    within: Seconds = 60.0


class StartAfter(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A readiness condition that holds a process back; exactly one of the keys.

    `node`: a node is announced, by its name in this launch file or its full name. `topic`: somebody publishes it.
    `service`: somebody serves it. Relative names are in the namespace of the node that waits.
    """

    node: str = ""
    topic: str = ""
    service: str = ""


class NodeToStart(msgspec.Struct, frozen=True):
    """A fully expanded node or command: variables substituted, files read, defaults in place.

    The fields are those of `NodeDescription`. Names in `start_after` are full names, and `process` has its namespace
    in front. Two more are for ROS 2's launch files: words before the command line, as those of a debugger, `prefix`;
    and the working directory, `cwd`, '' for the launcher's. A variable that is None in `env` is taken out.
    """

    node: str = ""
    run: list[str] = []
    name: str = ""
    namespace: str = ""
    parameters: dict[str, Any] = {}
    remappings: dict[str, str] = {}
    args: list[str] = []
    env: dict[str, str | None] = {}
    interactive: bool = False
    process: str = ""
    start_after: tuple[StartAfter, ...] = ()
    respawn: Respawn = Respawn(when="never")
    on_exit: OnExit = "shutdown"  # not ROS 2's: a robot whose controller has gone must not look as if it ran
    log_level: LogLevel | None = None
    enclave: str = ""
    cpu: tuple[int, ...] = ()
    prefix: list[str] = []
    cwd: str = ""


@dataclass(frozen=True, eq=False)
class Entry:
    """One node or command to start.

    `name` is unique and shown to people, `ns/name`; `full_name` is a node's ROS name, `/ns/name` (if the launch file
    gives no name, that of the program's file or class is used). `node` has its settings, `source` is the node's
    program, None for a command. `place` makes an error that names the place of a setting, as `error` does.
    `home` is the workspace in which it looks things up, None for none.
    `wide` names the parameters that were given to more than this node, by a group or by a section such as `/**`.
    `files` are the launch files and parameter files that were read for it. `network` is the one of the whole system,
    empty if no file says any; `limits` are its limits, as the text of ROBOLINK_LIMITS.
    """

    name: str
    node: NodeToStart
    source: NodeSource | None
    home: Path | None
    place: Callable[[Sequence[str | int], str, bool], DocumentError]
    wide: frozenset[str] = frozenset()
    files: frozenset[Path] = frozenset()
    network: str = ""
    limits: str = ""

    @property
    def full_name(self) -> str:
        """Full ROS name of the node."""
        return f"/{self.name}"

    def error(self, steps: Sequence[str | int], message: str, *, key: bool = False) -> DocumentError:
        """Return an error (to raise) with this `message` about the value at `steps`, or with `key` about its key.

        The steps are such as `["parameters", "speed"]`.

        Its text begins with the file:line:column of that value: at the entry, in a group around it, or in another file.
        """
        return self.place(steps, message, key)


class ArgumentHelp(msgspec.Struct, frozen=True):
    """Help text of a launch argument; `default` is None where a value is required."""

    name: str
    default: str | None
    description: str
    choices: tuple[str, ...]


class Stage(Protocol[T]):
    """Runner of a launch file's system; `T` is a process, or a program in virtual time."""

    def plan(self, entries: list[Entry]) -> Sequence[T]:
        """Return the processes in which entries run that are added while the system runs."""

    def with_node(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the launcher's own node, where that is spun; the node is made at the first call."""

    def post(self, act: Callable[[float], Sequence[Request[T]]]) -> None:
        """Call `act` with the time where the director is asked, and carry out what it returns; from any thread."""


class Direct(Protocol):
    """Maker of the director of a launch file with timers or event handlers; it is called once."""

    def __call__(self, stage: Stage[T]) -> Director[T]:
        """Return the director; `stage` runs its system."""


class System(NamedTuple):
    """Result of reading a launch file."""

    entries: list[Entry]
    """Nodes and commands to start at once."""
    notes: list[str] = []
    """Lines for people: what is left out, and what the launch file itself wants to be printed."""
    direct: Direct | None = None
    """Maker of what goes on while the system runs; None where nothing does."""
