"""Closed lines in the plane, and how far a robot has come along one: laps of a track, walls of a room."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import accumulate, pairwise

Point = tuple[float, float]

_SLACK = 0.3
"""Metres that a robot may drive from one look to the next."""


class ClosedLine:
    """Closed line through some points.

    Args:
        points: Its corners in metres, in the direction in which it is followed; the last is joined to the first.
    """

    def __init__(self, points: Sequence[Point]) -> None:
        self._sides = list(pairwise([*points, points[0]]))
        lengths = [math.dist(*side) for side in self._sides]
        self._begins = [0.0, *accumulate(lengths)]
        self.length = self._begins[-1]
        """Length in metres."""

    def nearest(self, x: float, y: float) -> tuple[float, float]:
        """Return where the nearest point of the line is: metres from its beginning, and metres from (x, y)."""
        found = (self._on_side(number, x, y) for number in range(len(self._sides)))
        return min(found, key=lambda each: each[1])

    def _on_side(self, number: int, x: float, y: float) -> tuple[float, float]:
        (x1, y1), (x2, y2) = self._sides[number]
        length = self._begins[number + 1] - self._begins[number]
        along = ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / length
        along = max(0.0, min(length, along))
        share = along / length
        away = math.hypot(x - x1 - share * (x2 - x1), y - y1 - share * (y2 - y1))
        return self._begins[number] + along, away


class Progress:
    """Progress of a robot along a closed line; ways that lead back count against it.

    Args:
        line: The line.
        nearest: Least distance from the line at which a way counts, in metres.
        farthest: Largest distance from the line at which a way counts, in metres.
    """

    def __init__(self, line: ClosedLine, nearest: float, farthest: float) -> None:
        self._line, self._nearest, self._farthest = line, nearest, farthest
        self._jump = 2 * farthest + _SLACK  # who cuts a corner goes from one side of it to the other at once
        self._last: float | None = None
        self.metres = 0.0
        """Metres that it has come along the line."""

    def see(self, x: float, y: float) -> None:
        """Note where the robot is, in metres."""
        place, away = self._line.nearest(x, y)
        if self._last is not None and self._nearest <= away <= self._farthest:
            half = self._line.length / 2
            step = (place - self._last + half) % self._line.length - half
            self.metres += step if abs(step) <= self._jump else 0.0
        self._last = place
