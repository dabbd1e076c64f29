"""Checks of outlines and lines of points: no length, no area, edges that cross or touch."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TypeAlias

from robolink.sim.description import signed_area, turn
from robolink.sim.quantities import Point

SHORTEST = 1e-6
"""Distance below which two points count as one, in metres."""

SMALLEST = 1e-6
"""Least area of an outline, in m²: that of the smallest box."""

Edge: TypeAlias = "tuple[Point, Point]"


def repeated(points: Sequence[Point], closed: bool) -> Iterator[int]:
    """Yield the index of each point that is where the one before it is; of a closed line, also the first's double."""
    for index in range(1, len(points)):
        if math.dist(points[index - 1], points[index]) < SHORTEST:
            yield index
    if closed and len(points) > 2 and math.dist(points[-1], points[0]) < SHORTEST:
        yield len(points) - 1


def in_line(polygon: Sequence[Point]) -> bool:
    """True if all corners lie on one straight line."""
    first = polygon[0]
    far = max(polygon, key=lambda each: math.dist(first, each))
    length = math.dist(first, far)
    return all(abs(turn(first, far, each)) <= SHORTEST * length for each in polygon)


def has_area(polygon: Sequence[Point]) -> bool:
    """True if a polygon encloses an area."""
    return abs(signed_area(polygon)) >= SMALLEST


def meeting(polygon: Sequence[Point]) -> tuple[int, int] | None:
    """Find two edges of a polygon that cross or touch other than as neighbours at their corner; None if none do.

    An edge has the index of its first corner.
    """
    edges = list(zip(polygon, [*polygon[1:], polygon[0]], strict=True))
    waiting: list[tuple[float, int]] = []  # edges from the left that reach as far to the right as the present one
    for left, index in sorted((min(start[0], end[0]), index) for index, (start, end) in enumerate(edges)):
        waiting = [each for each in waiting if each[0] >= left]
        for _, other in waiting:
            first, second = sorted((index, other))
            if _meet(edges, first, second):
                return first, second
        waiting.append((max(edges[index][0][0], edges[index][1][0]), index))
    return None


def _meet(edges: Sequence[Edge], first: int, second: int) -> bool:
    if second - first == 1:
        return _folded(*edges[first], edges[second][1])
    if second - first == len(edges) - 1:
        return _folded(*edges[second], edges[first][1])
    (a, b), (c, d) = edges[first], edges[second]
    apart = max(a[1], b[1]) < min(c[1], d[1]) or max(c[1], d[1]) < min(a[1], b[1])
    apart = apart or max(a[0], b[0]) < min(c[0], d[0]) or max(c[0], d[0]) < min(a[0], b[0])
    return not apart and _between(a, b, c, d) and _between(c, d, a, b)


def _between(a: Point, b: Point, c: Point, d: Point) -> bool:
    """True if c and d are not both on the same side of the line through a and b."""
    left, right = turn(a, b, c), turn(a, b, d)
    return not (left > 0.0 < right or left < 0.0 > right)


def _folded(a: Point, b: Point, c: Point) -> bool:
    """True if the way from b to c leads straight back over the one from a to b."""
    back = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) < 0.0
    return back and turn(a, b, c) == 0.0
