"""Checks of shapes; each problem has its place in the description."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from robolink.sim.description import Obstacle, Shape, Wall, signed_area, turn
from robolink.sim.quantities import Point
from robolink.system.terminal import shown


class Problem(NamedTuple):
    """A mistake: its path, such as ``$.robots[0].pose``, and the reason; with `key` the key itself is the mistake."""

    path: str
    message: str
    key: bool = False


def under(path: str, found: Iterator[Problem]) -> Iterator[Problem]:
    """Prefix the paths of a part's problems with the path of the part."""
    return (each._replace(path=path + each.path) for each in found)


def repeated_names(names: Sequence[str], path: str, words: str) -> Iterator[Problem]:
    """Yield a problem for each name that was there before; `path` has a placeholder for its index."""
    seen: dict[str, int] = {}
    for index, name in enumerate(names):
        if name in seen:
            yield Problem(path.format(index), f"{words} '{shown(name)}': give this one another name")
        seen.setdefault(name, index)


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
