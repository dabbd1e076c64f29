"""Lines painted on the floor as strokes: corners rounded by arcs, lengths cut into dashes.

Only + - * / and square roots: the same bits on every machine.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import sqrt
from typing import NamedTuple

from robolink.sim.description import Paint
from robolink.sim.quantities import Point

_DEEPEST = 6
"""Most times that an arc is halved."""


class Stroke(NamedTuple):
    """A part of a line: its points, and whether it is a ring, whose last point is its first.

    The ends of one that is no ring are square.
    """

    points: list[Point]
    ring: bool


def strokes(paint: Paint, tolerance: float) -> list[Stroke]:
    """Return the strokes of a painted line.

    Args:
        paint: The line.
        tolerance: Most that an arc is off the true one, in metres.
    """
    points = [*(paint.line or ())]
    if paint.radius > 0.0:
        points = list(_rounded(points, paint.closed, paint.radius, tolerance))
    if paint.closed:
        points.append(points[0])
    if paint.dashes is None:
        return [Stroke(points, paint.closed)]
    return [Stroke(each, False) for each in _dashed(points, *paint.dashes)]


def length_of(points: Sequence[Point]) -> float:
    """Return the length of the way from point to point, in metres."""
    return sum(_apart(p, q) for p, q in pairwise(points))


def tangents(points: Sequence[Point], closed: bool, radius: float) -> list[float]:
    """Return for each point how far before and behind it an arc of this radius begins and ends, in metres.

    That is 0 at the ends of an open line, and infinite where the line goes straight back.
    """
    count = len(points)
    found = []
    for index in range(count):
        if not closed and index in (0, count - 1):
            found.append(0.0)
            continue
        (ax, ay), (bx, by) = _way(points[index - 1], points[index]), _way(points[index], points[(index + 1) % count])
        whole = sqrt((ax * ax + ay * ay) * (bx * bx + by * by))
        cross, rest = abs(ax * by - ay * bx), whole + ax * bx + ay * by
        found.append(radius * cross / rest if rest > 1e-9 * whole else float("inf"))
    return found


def _rounded(points: Sequence[Point], closed: bool, radius: float, tolerance: float) -> Iterator[Point]:
    """Yield the points of a line whose corners are arcs; an arc that does not fit is as large as it can be."""
    lengths = tangents(points, closed, radius)
    count = len(points)
    for index, corner in enumerate(points):
        if lengths[index] <= 0.0:
            yield corner
            continue
        before, after = points[index - 1], points[(index + 1) % count]
        room = min(_apart(before, corner), _apart(corner, after)) / 2
        reach = min(lengths[index], room)
        start, end = _towards(corner, before, reach), _towards(corner, after, reach)
        yield start
        yield from _arc(start, end, corner, tolerance, _DEEPEST)
        yield end


def _arc(start: Point, end: Point, corner: Point, tolerance: float, depth: int) -> Iterator[Point]:
    """Yield the points between the ends of an arc whose tangents meet in `corner`, halving it until it is fine."""
    x, y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    out_x, out_y = corner[0] - x, corner[1] - y
    out, half = sqrt(out_x * out_x + out_y * out_y), _apart(start, end) / 2
    side = sqrt(out * out + half * half)
    if depth == 0 or out <= 0.0 or side <= half:
        return
    rise = half * (side - half) / out  # from the chord's middle to the arc's
    if rise < tolerance:
        return
    middle = (x + out_x * (rise / out), y + out_y * (rise / out))
    share = half / (side + half)  # of the way to the corner, to where the halves' own tangents meet
    first, last = _between(start, corner, share), _between(end, corner, share)
    yield from _arc(start, middle, first, tolerance, depth - 1)
    yield middle
    yield from _arc(middle, end, last, tolerance, depth - 1)


def _dashed(points: Sequence[Point], dash: float, gap: float) -> Iterator[list[Point]]:
    """Yield the dashes along a line, each as its points."""
    drawn, left, current = True, dash, [points[0]]
    for start, end in pairwise(points):
        whole = _apart(start, end)
        gone = 0.0
        while whole - gone > left:
            gone += left
            at = _between(start, end, gone / whole)
            if drawn:
                yield [*current, at]
            drawn, current = not drawn, [at]
            left = dash if drawn else gap
        left -= whole - gone
        current.append(end)
    if drawn and length_of(current) > 0.0:
        yield current


def _way(start: Point, end: Point) -> tuple[float, float]:
    return end[0] - start[0], end[1] - start[1]


def _apart(start: Point, end: Point) -> float:
    dx, dy = _way(start, end)
    return sqrt(dx * dx + dy * dy)


def _between(start: Point, end: Point, share: float) -> Point:
    return start[0] + (end[0] - start[0]) * share, start[1] + (end[1] - start[1]) * share


def _towards(start: Point, end: Point, distance: float) -> Point:
    return _between(start, end, distance / _apart(start, end))
