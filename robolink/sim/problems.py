"""What is wrong with a description of a world and types cannot say, each with its place and what would be right."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from robolink.exceptions import shown
from robolink.sim.description import Drive, MapWalls, Obstacle, Point, Shape, Wall, WorldDescription
from robolink.sim.outlines import SHORTEST, has_area, in_line, meeting, repeated

_MARGIN = 1e-9
_KINDS = ("box", "circle", "polygon")
_ONLY_MOVING = ("speed", "closed")
_ONLY_ACKERMANN = ("wheelbase", "steer_max", "steer_rate")


class Problem(NamedTuple):
    """Where, such as ``$.robots[0].pose``, and what is wrong; with `key`, that this key is there at all."""

    path: str
    message: str
    key: bool = False


def under(path: str, found: Iterator[Problem]) -> Iterator[Problem]:
    """Put what was found in a part where that part is."""
    return (each._replace(path=path + each.path) for each in found)


def misfits(data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the keys of a world file's plain data, valid otherwise, that mean nothing where they stand."""
    for index, obstacle in enumerate(data.get("obstacles", ())):
        unused = [] if obstacle.get("path") is not None else [key for key in _ONLY_MOVING if key in obstacle]
        for key in unused:
            yield Problem(f"$.obstacles[{index}].{key}", f"only what moves along a 'path' has '{key}'", key=True)
    for index, robot in enumerate(data.get("robots", ())):
        drive = robot.get("drive", {})
        kind = drive.get("type", Drive().type)
        unused = [] if kind == "ackermann" else [key for key in _ONLY_ACKERMANN if key in drive]
        for key in unused:
            reason = f"a drive of type '{kind}' has no '{key}': leave it out, or say 'type: ackermann'"
            yield Problem(f"$.robots[{index}].drive.{key}", reason, key=True)


def wall_problems(wall: Wall) -> Iterator[Problem]:
    """Yield what is wrong with one wall."""
    points = wall.polyline
    if wall.closed and len(points) < 3:
        yield Problem(".polyline", f"a closed wall needs 3 points or more, got {len(points)}")
        return
    yield from under(".polyline", _repeated_points(points, "a wall", "closed: true" if wall.closed else ""))


def _repeated_points(points: Sequence[Point], what: str, closing: str) -> Iterator[Problem]:
    for index in repeated(points, closed=bool(closing)):
        at = f"[{points[index][0]:g}, {points[index][1]:g}]"
        if closing and index == len(points) - 1 and math.dist(points[index], points[index - 1]) >= SHORTEST:
            yield Problem(f"[{index}]", f"'{closing}' already leads back to the first point, {at}: leave this one out")
        else:
            yield Problem(f"[{index}]", f"{what} from {at} to the same point has no length: leave one of them out")


def shape_problems(shape: Shape) -> Iterator[Problem]:
    """Yield what is wrong with an outline."""
    given = [kind for kind in _KINDS if getattr(shape, kind) is not None]
    if len(given) != 1:
        yield Problem("", f"expected one of 'box', 'circle' and 'polygon', got {' and '.join(given) or 'none of them'}")
    elif shape.polygon is not None:
        yield from under(".polygon", _polygon_problems(shape.polygon))


def _polygon_problems(polygon: Sequence[Point]) -> Iterator[Problem]:
    same = list(_repeated_points(polygon, "an edge", "polygon"))
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
    """Yield what is wrong with one obstacle in a world with steps of `dt` seconds."""
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
    yield from under(".path", _repeated_points(obstacle.path, "a way", "closed: true" if obstacle.closed else ""))
    if not shape:
        yield from under(".speed", speed_problems(obstacle.speed, dt, obstacle, "what it meets"))


def speed_problems(speed: float, dt: float, shape: Shape, through: str) -> Iterator[Problem]:
    """Yield what is wrong with a speed at which a shape could be on the other side of something after one step."""
    reach = shape.inner_radius() or shape.outer_radius()
    if speed * dt > reach:
        way = f"{speed:g} m/s is {speed * dt:.3g} m in a step of {dt:g} s"
        yield Problem("", f"{way}, and a shape of {reach:g} m could pass through {through}: at most {reach / dt:.4g}")


def rate_problems(rate: float, dt: float) -> Iterator[Problem]:
    """Yield what is wrong with a rate: it must be a whole number of steps of `dt` seconds from one time to the next."""
    if steps_between(rate, dt):
        return
    steps = math.floor(1.0 / (rate * dt))
    fitting = " or ".join(f"{1.0 / (dt * whole):.6g}" for whole in (steps + 1, steps) if whole)
    yield Problem("", f"{rate:g} Hz is no whole number of steps of {dt:g} s: take {fitting}")


def steps_between(rate: float, dt: float) -> int:
    """Give the whole number of steps of `dt` seconds from one reading to the next at `rate` Hz; 0 if there is none."""
    steps = 1.0 / (rate * dt)
    whole = round(steps)
    return whole if whole >= 1 and abs(steps - whole) < 1e-6 * steps else 0


def repeated_names(names: Sequence[str], path: str, words: str) -> Iterator[Problem]:
    """Yield each name that has been there before; `path` has a place for its index."""
    seen: dict[str, int] = {}
    for index, name in enumerate(names):
        if name in seen:
            yield Problem(path.format(index), f"{words} '{shown(name)}': give this one another name")
        seen.setdefault(name, index)


def size_problems(description: WorldDescription) -> Iterator[Problem]:
    """Yield what lies outside of the size that the world says it has."""
    if description.world.size is None:
        return
    width, height = description.world.size
    for path, (x, y) in _places(description):
        if not (-_MARGIN <= x <= width + _MARGIN and -_MARGIN <= y <= height + _MARGIN):
            reason = f"[{x:g}, {y:g}] lies outside of the world's size: x is 0 to {width:g}, y is 0 to {height:g}"
            yield Problem(path, reason)


def _places(description: WorldDescription) -> Iterator[tuple[str, Point]]:
    for index, wall in enumerate(description.walls):
        if not isinstance(wall, MapWalls):
            yield from ((f"$.walls[{index}].polyline[{at}]", point) for at, point in enumerate(wall.polyline))
    for index, obstacle in enumerate(description.obstacles):
        if obstacle.pose is not None:
            yield f"$.obstacles[{index}].pose", (obstacle.pose.x, obstacle.pose.y)
        yield from ((f"$.obstacles[{index}].path[{at}]", point) for at, point in enumerate(obstacle.path or ()))
    for index, robot in enumerate(description.robots):
        yield f"$.robots[{index}].pose", (robot.pose.x, robot.pose.y)
