"""What a launch file comes to: a node or command to start, with all that is said of it in place."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from robolink.exceptions import DocumentError
from robolink.launch.description import LogLevel, NodeDescription, OnExit, Respawn, StartAfter
from robolink.workspace import NodeSource


class NodeToStart(NodeDescription, frozen=True, forbid_unknown_fields=True):
    """A node or command with nothing left open: texts filled in, files read, defaults in place.

    Names in `start_after` are full ones. `count`, `if` and `unless` have done their work.
    """

    run: list[str] = []  # type: ignore[assignment]
    parameters: dict[str, Any] = {}
    args: list[str] = []  # type: ignore[assignment]
    env: dict[str, str] = {}  # type: ignore[assignment]
    interactive: bool = False
    start_after: tuple[StartAfter, ...] = ()  # type: ignore[assignment]
    respawn: Respawn = Respawn(when="never")
    on_exit: OnExit = "shutdown"
    log_level: LogLevel | None = None
    cpu: tuple[int, ...] = ()  # type: ignore[assignment]


@dataclass(frozen=True, eq=False)
class Entry:
    """One node or command to start.

    `name` is how people are told of it, `ns/name`, and no other entry's; `full_name` is a node's, `/ns/name` (the
    file's name stands for the node's own where the launch file gives none). `source` is where the node comes from,
    None for a command. `home` is the workspace in which it looks things up, None for none.
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
