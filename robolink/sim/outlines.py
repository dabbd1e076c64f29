"""What makes an outline or a line of points degenerate: no length, no area, edges that meet where they must not."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from robolink.sim.description import Point, signed_area

SHORTEST = 1e-6
"""Metres: what is nearer than that is one point."""

SMALLEST = 1e-6
"""Square metres that an outline encloses at least, as the smallest box does."""


def repeated(points: Sequence[Point], closed: bool) -> Iterator[int]:
    """Yield the index of each point that is where the one before it is; of a closed line, also the first's double."""
    for index in range(1, len(points)):
        if math.dist(points[index - 1], points[index]) < SHORTEST:
            yield index
    if closed and len(points) > 2 and math.dist(points[-1], points[0]) < SHORTEST:
        yield len(points) - 1


def in_line(polygon: Sequence[Point]) -> bool:
    """Say whether all corners lie on one straight line."""
    corners = np.asarray(polygon, dtype=np.float64)
    spread = np.linalg.svd(corners - corners.mean(axis=0), compute_uv=False)
    return float(spread[1]) < SHORTEST


def has_area(polygon: Sequence[Point]) -> bool:
    """Say whether a polygon encloses anything."""
    return abs(signed_area(polygon)) >= SMALLEST


def meeting(polygon: Sequence[Point]) -> tuple[int, int] | None:
    """Find two edges of a polygon that cross or touch other than as neighbours at their corner; None if none do.

    An edge has the index of its first corner.
    """
    start = np.asarray(polygon, dtype=np.float64)
    end = np.roll(start, -1, axis=0)
    sides_of_start, sides_of_end = _sides(start, end, start), _sides(start, end, end)
    straddles = sides_of_start * sides_of_end <= 0  # edge j has an end on each side of the line of edge i, or on it
    meets = straddles & straddles.T & _boxes_meet(start, end)
    meets &= ~(_neighbours(len(start)) & ~_folded(start, end))
    first, second = np.nonzero(np.triu(meets, 1))
    return (int(first[0]), int(second[0])) if len(first) else None


def _sides(
    start: npt.NDArray[np.float64], end: npt.NDArray[np.float64], point: npt.NDArray[np.float64]
) -> npt.NDArray[np.float64]:
    """Give, for each edge (row) and each point (column), on which side it is: 1 left, -1 right, 0 on the line."""
    along = end - start
    to = point[None, :, :] - start[:, None, :]
    sides: npt.NDArray[np.float64] = np.sign(along[:, None, 0] * to[:, :, 1] - along[:, None, 1] * to[:, :, 0])
    return sides


def _boxes_meet(start: npt.NDArray[np.float64], end: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    low, high = np.minimum(start, end), np.maximum(start, end)
    begins_before_end: npt.NDArray[np.bool_] = np.all(low[:, None] <= high[None, :], axis=2)
    both: npt.NDArray[np.bool_] = begins_before_end & begins_before_end.T
    return both


def _neighbours(count: int) -> npt.NDArray[np.bool_]:
    index = np.arange(count)
    apart = (index[:, None] - index[None, :]) % count
    near: npt.NDArray[np.bool_] = (apart == 1) | (apart == count - 1)
    return near


def _folded(start: npt.NDArray[np.float64], end: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """Say of each two edges whether the one leads straight back over the other."""
    along = end - start
    crosses = along[:, None, 0] * along[None, :, 1] - along[:, None, 1] * along[None, :, 0]
    back: npt.NDArray[np.bool_] = (crosses == 0.0) & (along @ along.T < 0.0)
    return back
