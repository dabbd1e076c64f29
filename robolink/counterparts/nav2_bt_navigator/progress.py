"""Numbers of a trip's feedback: metres along the path that are left, the time for them, and goals that are passed."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.float64]
"""Places along a path, an array of shape (n, 2) in metres."""

SLOWEST, NEAREST = 0.01, 0.1
"""Least speed in m/s, and least way in metres, at which a time is estimated."""

SPAN = 1.0
"""Length of the time over which the speed is averaged, in seconds."""


def metres_left(path: Places, x: float, y: float) -> float:
    """Return the length of a path from its place nearest to (x, y) on, in metres; 0 for an empty one.

    >>> metres_left(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]]), 0.9, 0.1)
    2.0
    """
    if not len(path):
        return 0.0
    nearest = int(np.argmin(np.hypot(path[:, 0] - x, path[:, 1] - y)))
    steps = np.diff(path[nearest:], axis=0)
    return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


def seconds_left(metres: float, speed: float) -> float:
    """Return the time for a way at a speed in m/s; 0 if the robot stands, or is nearly there."""
    return metres / speed if speed > SLOWEST and metres > NEAREST else 0.0


def passed(goals: Sequence[tuple[float, float]], x: float, y: float, radius: float) -> int:
    """Return how many goals in front of the last one are within `radius` metres of the robot, one after the other.

    >>> passed([(0.0, 0.0), (0.5, 0.0), (9.0, 0.0)], 0.1, 0.0, radius=0.7)
    2
    """
    count = 0
    while count < len(goals) - 1 and math.dist(goals[count], (x, y)) <= radius:
        count += 1
    return count


class Speed:
    """Speed of a robot, from its latest places."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, float, float]] = deque()

    def at(self, now: float, x: float, y: float) -> float:
        """Note where the robot is, `now` in seconds, and return its average speed in m/s over the last `SPAN`."""
        self._seen.append((now, x, y))
        while now - self._seen[0][0] > SPAN or self._seen[0][0] > now:
            self._seen.popleft()
        then, from_x, from_y = self._seen[0]
        return math.dist((from_x, from_y), (x, y)) / (now - then) if now > then else 0.0
