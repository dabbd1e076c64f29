"""Report of a check: sentences on what was looked at, and the mistake that ended it, if one did."""

from __future__ import annotations

from typing import Literal

from msgspec import Struct
from msgspec.structs import force_setattr

Kind = Literal[
    "syntax",
    "empty",
    "exception",
    "elsewhere",
    "stuck",
    "stuck somewhere",
    "asleep",
    "too large",
    "input",
    "ended",
    "ended all",
    "file",
    "lacks",
    "types",
    "use",
    "check",
    "no program",
]


LONGEST = 1000
"""Longest text of a report, in letters."""


def fit_text(text: str) -> str:
    r"""Return a text that fits into a report: cut to `LONGEST`, and with `\ud800` for a surrogate, which JSON lacks."""
    short = text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."
    return short.encode("utf-8", "backslashreplace").decode()


class Line(Struct, frozen=True):
    """Sentence of a check."""

    good: bool
    text: str

    def __post_init__(self) -> None:
        force_setattr(self, "text", fit_text(self.text))


class Mistake(Struct, frozen=True):
    """Mistake that ended a check: its kind, its text, and the line of the student's file with its code."""

    kind: Kind
    text: str = ""
    line: int = 0
    code: str = ""

    def __post_init__(self) -> None:
        force_setattr(self, "text", fit_text(self.text))
        force_setattr(self, "code", fit_text(self.code))


class Body(Struct, frozen=True):
    """Robot or obstacle of a simulated world, and where it was; lengths in m, angles in rad."""

    name: str
    is_robot: bool
    circle: float = 0.0
    """Radius; 0 for an outline."""
    corners: list[tuple[float, float]] = []
    """Outline about its own origin, counter-clockwise."""
    first: int = 0
    """Number of the first look at it."""
    path: list[float] = []
    """x, y and heading at each look from the first on; of what stands only once."""


class Contact(Struct, frozen=True):
    """Contact of a robot: the time in s, and the place of the robot in m."""

    at: float
    x: float
    y: float


class Track(Struct, frozen=True):
    """Walls (x and y of both ends, in m) and bodies of a simulated world, seen each `period` seconds."""

    walls: list[tuple[float, float, float, float]]
    bodies: list[Body]
    period: float
    contacts: list[Contact] = []


class Report(Struct, frozen=True):
    """Result of a check."""

    lines: list[Line] = []
    mistake: Mistake | None = None
    is_over: bool = False
    """True if the student's program had come to its end by itself."""
    printed: str = ""
    """Output of the program, cut to a length."""
    seconds: float = 0.0
    """Seconds that the check took."""
    track: Track | None = None
    """Path of the robots; None if the check had none."""

    @property
    def passed(self) -> bool:
        """True if all that was looked at is as it should be."""
        return self.mistake is None and bool(self.lines) and all(each.good for each in self.lines)
