"""Triangles that together cover an outline or a painted line, for viewers that fill triangles and nothing else."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import atan2, ceil, cos, hypot, pi, sin
from typing import TypeAlias

from robolink.sim.description import Paint
from robolink.sim.physics.convex import convex_parts
from robolink.sim.quantities import Point
from robolink.sim.scene.solids import placed_corners
from robolink.sim.scene.strokes import Stroke, strokes

Triangle: TypeAlias = tuple[Point, Point, Point]
"""Three corners in metres."""

ROUND = 32
"""Number of triangles of a disc."""

GENTLE = 0.6
"""Greatest turn of a line at a point, in radians, at which its sides are simply joined; a greater one is rounded."""

TOLERANCE = 0.05
"""Most that an arc is off the true one, as a share of the line's width."""


def of_polygon(corners: Sequence[Point]) -> Iterator[Triangle]:
    """Yield triangles that cover a polygon, its corners counter-clockwise, and do not overlap."""
    for part in convex_parts(corners):
        yield from ((part[0], second, third) for second, third in pairwise(part[1:]))


def of_disc(x: float, y: float, radius: float) -> Iterator[Triangle]:
    """Yield the triangles of a disc."""
    rim = [(x + radius * cos(at), y + radius * sin(at)) for at in (2 * pi * n / ROUND for n in range(ROUND))]
    yield from (((x, y), first, second) for first, second in pairwise([*rim, rim[0]]))


def of_paint(paint: Paint) -> Iterator[Triangle]:
    """Yield triangles that cover something painted on the floor; those of a line overlap at its sharp corners."""
    if paint.line is not None:
        for stroke in strokes(paint, max(TOLERANCE * paint.width, 0.001)):
            yield from of_stroke(stroke, paint.width)
    elif paint.circle is not None:
        yield from of_disc(paint.pose.x, paint.pose.y, paint.circle)
    else:
        yield from of_polygon(placed_corners(paint, paint.pose.place))


def of_stroke(stroke: Stroke, width: float) -> Iterator[Triangle]:
    """Yield the triangles of a line that is `width` metres wide, with round corners and square ends."""
    points = [point for point, before in zip(stroke.points, [None, *stroke.points], strict=False) if point != before]
    if len(points) < 2:
        return
    half = width / 2
    ways = [_unit(start, end) for start, end in pairwise(points)]
    joins = [None, *(_joint(*pair) for pair in pairwise(ways)), None]
    if stroke.ring:
        joins[0] = joins[-1] = _joint(ways[-1], ways[0])
    for index, (start, end) in enumerate(pairwise(points)):
        first, last = (joins[at] or _left(ways[index]) for at in (index, index + 1))
        left, right = _beside(start, first, half), _beside(start, first, -half)
        far_left, far_right = _beside(end, last, half), _beside(end, last, -half)
        yield left, right, far_right
        yield left, far_right, far_left
    turns = zip(points[1:], pairwise(ways), joins[1:-1], strict=False)
    corners = [(point, pair) for point, pair, joint in turns if joint is None]
    if stroke.ring and joins[0] is None:
        corners.append((points[0], (ways[-1], ways[0])))
    for point, (before, after) in corners:
        yield from _fan(point, before, after, half)


def _unit(start: Point, end: Point) -> Point:
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = hypot(dx, dy)
    return dx / length, dy / length


def _left(way: Point) -> Point:
    return -way[1], way[0]


def _beside(point: Point, normal: Point, distance: float) -> Point:
    return point[0] + normal[0] * distance, point[1] + normal[1] * distance


def _turn(before: Point, after: Point) -> float:
    return atan2(before[0] * after[1] - before[1] * after[0], before[0] * after[0] + before[1] * after[1])


def _joint(before: Point, after: Point) -> Point | None:
    """Return where the left sides of two parts meet, a width of 1 beside their line; None if the corner is sharp."""
    turn = _turn(before, after)
    if abs(turn) > GENTLE:
        return None
    x, y = before[0] + after[0], before[1] + after[1]
    length = hypot(x, y) * cos(turn / 2)
    return _left((x / length, y / length))


def _fan(corner: Point, before: Point, after: Point, half: float) -> Iterator[Triangle]:
    """Yield the triangles that round the outside of a sharp corner."""
    turn = _turn(before, after)
    pieces = ceil(abs(turn) / GENTLE)
    side = -half if turn > 0.0 else half
    begin = atan2(before[0], -before[1])  # the heading of the left normal
    rim = [begin + turn * n / pieces for n in range(pieces + 1)]
    places = [_beside(corner, (cos(at), sin(at)), side) for at in rim]
    yield from ((corner, *pair) for pair in pairwise(places))
