"""What a launch file comes to: a node or command to start, with all that is said of it in place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec

from robolink.exceptions import DocumentError
from robolink.launch.reading.description import LogLevel, OnExit, Respawn, StartAfter
from robolink.workspace import NodeSource


class NodeToStart(msgspec.Struct, frozen=True):
    """A node or command with nothing left open: texts filled in, files read, defaults in place.

    Its fields are what a `NodeDescription` of the same name comes to; names in `start_after` are full ones, a process's
    has its namespace in front.
    """

    node: str = ""
    run: list[str] = []
    name: str = ""
    namespace: str = ""
    parameters: dict[str, Any] = {}
    remappings: dict[str, str] = {}
    args: list[str] = []
    env: dict[str, str] = {}
    interactive: bool = False
    process: str = ""
    start_after: tuple[StartAfter, ...] = ()
    respawn: Respawn = Respawn(when="never")
    on_exit: OnExit = "shutdown"
    log_level: LogLevel | None = None
    cpu: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class Entry:
    """One node or command to start.

    `name` is how people are told of it, `ns/name`, and no other entry's; `full_name` is a node's, `/ns/name` (where the
    launch file gives no name, that of the program's file, or of its class, stands for it). `source` is where the node
    comes from, None for a command. `home` is the workspace in which it looks things up, None for none.
    `wide` names the parameters that were given to more than this node, by a group or by a section such as `/**`.
    `files` are the launch files and parameter files that were read for it.
    """

    name: str
    node: NodeToStart
    source: NodeSource | None
    home: Path | None
    place: Callable[[Sequence[str | int], str, bool], DocumentError]
    wide: frozenset[str] = frozenset()
    files: frozenset[Path] = frozenset()

    @property
    def full_name(self) -> str:
        """The full name of the node."""
        return f"/{self.name}"

    def error(self, steps: Sequence[str | int], message: str, *, key: bool = False) -> DocumentError:
        """Make an error (to raise) about what is said of it at `steps`, such as `["parameters", "speed"]`.

        The text begins with file:line:column of where it is said: there, in a group around it, or in another file.
        """
        return self.place(steps, message, key)
