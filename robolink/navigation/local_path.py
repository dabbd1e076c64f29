"""The part of a path that a controller looks at: what lies ahead of the robot, at even distances."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from robolink.navigation.grid import Floats


class LocalPath(NamedTuple):
    """Points of a path, `spacing` metres apart but for the last, from beside the robot on: x, y and heading."""

    x: Floats
    y: Floats
    theta: Floats
    spacing: float
    remaining: float
    """Metres from its first point to the end of the whole path."""
    is_whole: bool
    """True if it ends where the whole path ends."""
    length: float
    """Metres from its first point to its last."""


def lengths(path: Floats) -> Floats:
    """Return the metres from the first of some poses to each of them, along the path. Shape (poses, 2 or more)."""
    steps = np.diff(path[:, :2], axis=0)
    ways = np.concatenate(([0.0], np.sqrt((steps * steps).sum(axis=1))))
    return np.cumsum(ways)


def nearest(path: Floats, along: Floats, x: float, y: float, start: float, reach: float) -> float:
    """Return how far along a path its point nearest to a place is, in metres.

    Args:
        path: Poses, of shape (poses, 2 or more).
        along: Their `lengths`.
        x: The place, in metres.
        y: The place, in metres.
        start: Metres along the path at which the search begins: a path that crosses itself is followed in order.
        reach: Metres of the path that are searched.
    """
    first = max(int(np.searchsorted(along, start, side="right")) - 1, 0)
    last = max(int(np.searchsorted(along, start + reach, side="right")), first + 1)
    points = path[first : last + 1, :2]
    if len(points) < 2:
        return float(along[first])
    ways = np.diff(points, axis=0)
    squares = np.maximum((ways * ways).sum(axis=1), 1e-12)
    place = np.array((x, y)) - points[:-1]
    shares = np.clip((place * ways).sum(axis=1) / squares, 0.0, 1.0)
    off = place - shares[:, None] * ways
    best = int(np.argmin((off * off).sum(axis=1)))
    found = float(along[first + best]) + float(shares[best]) * math.sqrt(float(squares[best]))
    return min(max(found, start), float(along[-1]))


def ahead(path: Floats, along: Floats, start: float, reach: float, spacing: float) -> LocalPath:
    """Return the part of a path from `start` metres on, over `reach` metres, resampled. The heading is the way's.

    The last heading is that of the path's last pose, if the path ends there.

    Args:
        path: Poses of shape (poses, 3).
        along: Their `lengths`.
        start: Metres along the path to the first point.
        reach: Greatest length of the part, in metres.
        spacing: Distance of its points, in metres.
    """
    whole = float(along[-1])
    end = min(start + reach, whole)
    count = max(math.ceil((end - start) / spacing - 1e-6), 0) + 1
    places = np.minimum(start + spacing * np.arange(count), end)
    x, y = np.interp(places, along, path[:, 0]), np.interp(places, along, path[:, 1])
    theta = np.full(count, path[-1, 2])
    if count > 1:
        theta[:-1] = np.arctan2(np.diff(y), np.diff(x))
        theta[-1] = path[-1, 2] if end == whole else theta[-2]
    return LocalPath(x, y, theta, spacing, whole - start, end == whole, end - start)
