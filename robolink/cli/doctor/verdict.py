"""What a check of `robolink doctor` finds."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from robolink.cli.doctor.facts import Facts
from robolink.exceptions import shown

OK, WARNING, ERROR, UNKNOWN = "ok", "warning", "error", "unknown"

MOST_SHOWN = 8
"""So many findings of a check are listed, and counted from there on."""

LONGEST = 400
"""Characters of a finding: names on the network can be as long as somebody likes."""


class Verdict(NamedTuple):
    """A check's outcome."""

    summary: str
    """What there is, where nothing is wrong."""
    errors: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    unknown: bool = False
    """Whether it could not be found out."""

    @property
    def level(self) -> str:
        """OK, WARNING, ERROR or UNKNOWN."""
        return ERROR if self.errors else WARNING if self.warnings else UNKNOWN if self.unknown else OK

    @property
    def findings(self) -> list[str]:
        """What is wrong, the worst first, shortened where there is a lot of it."""
        found = [shown(each, LONGEST) for each in (*self.errors, *self.warnings)]
        rest = len(found) - MOST_SHOWN
        return [*found[:MOST_SHOWN], f"and {rest} more"] if rest > 0 else found


class Check(NamedTuple):
    """Something that is looked at."""

    name: str
    module: str
    """What is blamed in `Failed modules:`, in ros2 doctor's words."""
    decide: Callable[[Facts], Verdict]


def count(number: int, noun: str) -> str:
    """Give ``1 node`` or ``3 nodes``.

    >>> count(2, "node")
    '2 nodes'
    """
    return f"{number} {noun if number == 1 else noun + 's'}"


def listed(names: Iterable[str], most: int = 4) -> str:
    """Give names as text, sorted, each once: not more than `most`.

    >>> listed(["/b", "/a"])
    '/a and /b'
    """
    found = sorted(set(names))
    shown = [*found[:most], f"{len(found) - most} more"] if len(found) > most else found
    return " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1]))) if shown else ""
