"""Helpers for tests of systems in addition to `robolink.testing`: counted log lines, short answers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robolink.testing import System

START = 1_000_000_000
"""Nanoseconds: the time at which systems begin."""
PATIENCE = 300.0
"""Simulated seconds."""


def add_world(system: System, path: str | Path) -> Any:
    """Add a simulated world, by its name or file; give its node."""
    return system.start("world", parameters={"world": str(path)})


def log(system: System) -> list[str]:
    """Give what has been logged."""
    return [each.message for each in system.logs]


def said(system: System, words: str) -> int:
    """Count the lines of the log that begin so."""
    return sum(line.startswith(words) for line in log(system))


def ask(system: System, srv_type: type[Any], name: str, /, **fields: Any) -> tuple[bool, str]:
    """Call a service; give its success and its message."""
    answer = system.call(srv_type, name, srv_type.Request(**fields), within=60.0)
    return answer.success, answer.message


class Typed:
    """A keyboard that types what it is told."""

    def __init__(self) -> None:
        self.text, self.closed = "", False

    def read(self) -> str:
        text, self.text = self.text, ""
        return text

    def close(self) -> None:
        self.closed = True


def made_with(node_class: type[Any], **options: Any) -> type[Any]:
    """Give a Node class whose constructor has these options: a system calls it without any."""

    def __init__(self: Any) -> None:
        node_class.__init__(self, **options)

    return type(node_class.__name__, (node_class,), {"__init__": __init__})
