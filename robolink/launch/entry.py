"""Result of reading a launch file: entries, each a fully expanded node or command to start."""

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
    on_exit: OnExit = "shutdown"
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
