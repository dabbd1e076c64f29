"""Verdict: the result of one check of `robolink doctor`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from robolink.cli.doctor.facts import Facts
from robolink.system.terminal import shown

OK, WARNING, ERROR, UNKNOWN = "ok", "warning", "error", "unknown"

MOST_SHOWN = 8
"""Upper bound of the findings of a check that are listed; the rest is counted."""

LONGEST = 400
"""Upper bound of a finding's length, in characters: names on the network can be of any length."""


class Verdict(NamedTuple):
    """Outcome of a check."""

    summary: str
    """Summary that is shown if nothing is wrong."""
    errors: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    unknown: bool = False
    """True if the check could not be made."""

    @property
    def level(self) -> str:
        """OK, WARNING, ERROR or UNKNOWN."""
        return ERROR if self.errors else WARNING if self.warnings else UNKNOWN if self.unknown else OK

    @property
    def findings(self) -> list[str]:
        """Errors and warnings, the worst first, shortened if there are many."""
        found = [shown(each, LONGEST) for each in (*self.errors, *self.warnings)]
        rest = len(found) - MOST_SHOWN
        return [*found[:MOST_SHOWN], f"and {rest} more"] if rest > 0 else found


class Check(NamedTuple):
    """A check: its name, and the function that decides it from the facts."""

    name: str
    module: str
    """Name in the line `Failed modules:`, in ros2 doctor's words."""
    decide: Callable[[Facts], Verdict]


def count(number: int, noun: str) -> str:
    """Return ``1 node`` or ``3 nodes``.

    >>> count(2, "node")
    '2 nodes'
    """
    return f"{number} {noun if number == 1 else noun + 's'}"


def listed(names: Iterable[str], most: int = 4) -> str:
    """Return names as text, sorted, each once, and `most` of them at most.

    >>> listed(["/b", "/a"])
    '/a and /b'
    """
    found = sorted(set(names))
    shown = [*found[:most], f"{len(found) - most} more"] if len(found) > most else found
    return " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1]))) if shown else ""
