"""Extensions: parts of robolink that other installed packages bring, found by their entry points.

A package names what it adds in its pyproject.toml, and robolink reads that when its own table lacks a name:

    [project.entry-points."robolink.commands"]
    hello = "my_package.hello:app"            # robolink hello
    "topic.nodes" = "my_package.nodes:nodes"  # robolink topic nodes

    [project.entry-points."robolink.nodes"]
    patrol = "my_package.patrol:Patrol"       # robolink run patrol

    [project.entry-points."robolink.sensors"]
    compass = "my_package.compass:COMPASS"    # sensors: [{compass: heading}] in a world file

Reading the entry points of an environment takes some ten milliseconds, so nothing is read for a name that is known.
What comes with robolink goes first. How to write one: docs/reference/extensions.md.
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from robolink.exceptions import RobolinkError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

COMMANDS = "robolink.commands"
"""Group of commands: NAME for a noun (a typer.Typer), NOUN.VERB for a verb of one (a function, or a typer.Typer)."""
NODES = "robolink.nodes"
"""Group of nodes that `robolink run NAME` and launch files find: a Node class, or a function without arguments."""

SENSORS = "robolink.sensors"
"""Group of sensors for world files: a `robolink.sim.sensors.SensorKind`, by the key that names it in a world file."""


class ExtensionError(RobolinkError, ImportError):
    """An entry point of another package that cannot be loaded; names the package, the entry point and the reason."""


def added(group: str) -> Mapping[str, EntryPoint]:
    """Return the entry points of a group by their names, in the order of the names; the first of two is taken.

    Args:
        group: Such as `COMMANDS`.
    """
    return _added(group, tuple(sys.path))  # tests and notebooks add folders while they run


@functools.lru_cache(maxsize=16)
def _added(group: str, _path: tuple[str, ...]) -> Mapping[str, EntryPoint]:
    from importlib.metadata import entry_points  # late: it takes 10 ms to import, and most commands need none

    found: dict[str, EntryPoint] = {}
    for each in sorted(entry_points(group=group), key=lambda each: (each.name, _package(each))):
        found.setdefault(each.name, each)
    return found


def load(group: str, name: str) -> Any:
    """Return the object that an entry point leads to; None if no package adds this name.

    Args:
        group: Such as `COMMANDS`.
        name: Name of the entry point.

    Raises:
        ExtensionError: If it cannot be imported.
    """
    entry = added(group).get(name)
    if entry is None:
        return None
    try:
        return entry.load()
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        raise ExtensionError(
            f"{_package(entry)} adds '{name}' ({group}), which cannot be loaded from {entry.value}: {reason}"
        ) from error


def _package(entry: EntryPoint) -> str:
    return entry.dist.name if entry.dist is not None else ""
