"""Report of a check: sentences on what was looked at, and the mistake that ended it, if one did."""

from __future__ import annotations

from msgspec import Struct
from msgspec.structs import force_setattr

from robolink.grading.mistakes import Mistake, fit_text


class Line(Struct, frozen=True):
    """Sentence of a check."""

    good: bool
    text: str

    def __post_init__(self) -> None:
        force_setattr(self, "text", fit_text(self.text))


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
