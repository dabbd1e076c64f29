"""Courses of the races: mazes for a seed, and closed lines with the progress along one."""

from __future__ import annotations

import math
import random
from collections import deque
from collections.abc import Sequence
from itertools import accumulate, pairwise
from typing import NamedTuple

Cell = tuple[int, int]

SIZE = 6
"""Cells along each side; a cell is a square of 1 m."""

START: Cell = (0, 0)

GOAL: Cell = (SIZE - 1, SIZE - 1)

_SIDES = ((1, 0), (0, 1), (-1, 0), (0, -1))

Point = tuple[float, float]

_SLACK = 0.3
"""Metres that a robot may drive from one look to the next."""


class Maze(NamedTuple):
    """A maze: which cells are open to each other."""

    doors: dict[Cell, frozenset[Cell]]

    def walls(self) -> list[tuple[Cell, Cell]]:
        """Return the inner walls, each from one corner of cells to the next, in metres."""
        found = []
        for x in range(SIZE):
            for y in range(SIZE):
                if x + 1 < SIZE and (x + 1, y) not in self.doors[x, y]:
                    found.append(((x + 1, y), (x + 1, y + 1)))
                if y + 1 < SIZE and (x, y + 1) not in self.doors[x, y]:
                    found.append(((x, y + 1), (x + 1, y + 1)))
        return found

    def steps_to_goal(self) -> dict[Cell, int]:
        """Return for each cell how many cells the goal is away."""
        steps, waiting = {GOAL: 0}, deque([GOAL])
        while waiting:
            cell = waiting.popleft()
            for each in self.doors[cell]:
                if each not in steps:
                    steps[each] = steps[cell] + 1
                    waiting.append(each)
        return steps


def make_maze(seed: int) -> Maze:
    """Return the maze of a seed."""
    chance = random.Random(seed)
    doors: dict[Cell, set[Cell]] = {(x, y): set() for x in range(SIZE) for y in range(SIZE)}
    way = [START]
    seen = {START}
    while way:
        x, y = way[-1]
        beside = [(x + dx, y + dy) for dx, dy in _SIDES]
        new = [each for each in beside if each in doors and each not in seen]
        if not new:
            way.pop()
            continue
        chosen = chance.choice(new)
        doors[x, y].add(chosen)
        doors[chosen].add((x, y))
        seen.add(chosen)
        way.append(chosen)
    return Maze({cell: frozenset(open_to) for cell, open_to in doors.items()})


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
