"""Checks of walls, obstacles and outlines, each by itself."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from robolink.sim.checks.outlines import SHORTEST, has_area, in_line, meeting, repeated
from robolink.sim.checks.problem import Problem, under
from robolink.sim.description import Obstacle, Shape, Wall
from robolink.sim.quantities import Point

_KINDS = ("box", "circle", "polygon")
_ONLY_MOVING = ("speed", "closed")


def obstacle_misfits(data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the keys of an obstacle's plain data, valid otherwise, that mean nothing there."""
    for key in _ONLY_MOVING if data.get("path") is None else ():
        if key in data:
            yield Problem(f".{key}", f"only what moves along a 'path' has '{key}'", key=True)


def wall_problems(wall: Wall) -> Iterator[Problem]:
    """Yield the problems of one wall."""
    points = wall.polyline
    if wall.closed and len(points) < 3:
        yield Problem(".polyline", f"a closed wall needs 3 points or more, got {len(points)}")
        return
    yield from under(".polyline", repeated_points(points, "a wall", "closed: true" if wall.closed else ""))


def repeated_points(points: Sequence[Point], what: str, closing: str) -> Iterator[Problem]:
    """Yield a problem for each point that is where the one before is.

    Args:
        points: The points.
        what: Name of what joins two points.
        closing: Key that joins the last point to the first, such as 'closed: true'; '' if nothing does.
    """
    for index in repeated(points, closed=bool(closing)):
        at = f"[{points[index][0]:g}, {points[index][1]:g}]"
        if closing and index == len(points) - 1 and math.dist(points[index], points[index - 1]) >= SHORTEST:
            yield Problem(f"[{index}]", f"'{closing}' already leads back to the first point, {at}: leave this one out")
        else:
            yield Problem(f"[{index}]", f"{what} from {at} to the same point has no length: leave one of them out")


def shape_problems(shape: Shape) -> Iterator[Problem]:
    """Yield the problems of an outline."""
    given = [kind for kind in _KINDS if getattr(shape, kind) is not None]
    if len(given) != 1:
        yield Problem("", f"expected one of 'box', 'circle' and 'polygon', got {' and '.join(given) or 'none of them'}")
    elif shape.polygon is not None:
        yield from under(".polygon", _polygon_problems(shape.polygon))


def _polygon_problems(polygon: Sequence[Point]) -> Iterator[Problem]:
    same = list(repeated_points(polygon, "an edge", "polygon"))
    if same:
        yield from same
    elif in_line(polygon):
        yield Problem("", "its corners lie in one line, and enclose nothing: move one of them aside")
    elif edges := meeting(polygon):
        first, second = (f"{_at(polygon[each])}-{_at(polygon[(each + 1) % len(polygon)])}" for each in edges)
        yield Problem("", f"its edges {first} and {second} meet: give the corners in their order round the outline")
    elif not has_area(polygon):
        yield Problem("", "it encloses less than a square millimetre: move its edges apart")


def _at(point: Point) -> str:
    return f"[{point[0]:g}, {point[1]:g}]"


def obstacle_problems(obstacle: Obstacle, dt: float) -> Iterator[Problem]:
    """Yield the problems of one obstacle in a world with steps of `dt` seconds."""
    shape = list(shape_problems(obstacle))
    yield from shape
    if obstacle.path is None:
        if obstacle.pose is None:
            yield Problem("", "missing key 'pose': where it stands (or 'path', along which it moves by itself)")
        return
    if obstacle.mass is not None:
        yield Problem(
            ".mass", "what moves along a path by itself cannot be pushed: leave out 'mass' or 'path'", key=True
        )
    if obstacle.pose is not None and math.dist(obstacle.path[0], (obstacle.pose.x, obstacle.pose.y)) > 1e-6:
        there = _at(obstacle.path[0])
        yield Problem(
            ".pose", f"its path begins at {there}: leave out 'pose', or let it begin with [{there[1:-1]}, ...]"
        )
    yield from under(".path", repeated_points(obstacle.path, "a way", "closed: true" if obstacle.closed else ""))
    if not shape:
        yield from under(".speed", speed_problems(obstacle.speed, dt, obstacle, "what it meets"))


def speed_problems(speed: float, dt: float, shape: Shape, through: str) -> Iterator[Problem]:
    """Yield a problem if a shape at this speed could pass through something in one step."""
    reach = shape.inner_radius() or shape.outer_radius()
    if speed * dt > reach:
        way = f"{speed:g} m/s is {speed * dt:.3g} m in a step of {dt:g} s"
        yield Problem("", f"{way}, and a shape of {reach:g} m could pass through {through}: at most {reach / dt:.4g}")
