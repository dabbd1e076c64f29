"""Checks of a whole world: each of its parts, and all parts together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from robolink.sim.checks.appearance import (
    appearance_misfits,
    colour_problems,
    floor_problems,
    paint_problems,
    sign_problems,
)
from robolink.sim.checks.overlaps import overlaps
from robolink.sim.checks.robots import robot_misfits, robot_problems
from robolink.sim.checks.shapes import (
    Problem,
    obstacle_misfits,
    obstacle_problems,
    repeated_names,
    under,
    wall_problems,
)
from robolink.sim.description import MapWalls, Obstacle, RobotDescription, WorldDescription
from robolink.sim.quantities import Point
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.sim.maps.gridmap import GridMap

_MARGIN = 1e-9
"""Tolerance of the world's size, in metres."""

_LIGHTEST = 0.01
"""Least mass of a thing that a robot pushes, as a share of its own: Chipmunk presses lighter ones into walls."""


def misfits(data: Mapping[str, Any]) -> Iterator[Problem]:
    """Yield the keys of a world file's plain data, valid otherwise, that mean nothing where they stand."""
    for index, obstacle in enumerate(data.get("obstacles", ())):
        yield from under(f"$.obstacles[{index}]", obstacle_misfits(obstacle))
    for index, robot in enumerate(data.get("robots", ())):
        yield from under(f"$.robots[{index}]", robot_misfits(robot))
    yield from appearance_misfits(data)


def problems(
    description: WorldDescription, grid: GridMap | None = None, *, fixed_too: bool = True
) -> Iterator[Problem]:
    """Yield all that is wrong with a description, such as ``$.robots[0].pose``; overlaps once all else is right.

    Without `fixed_too` fixed obstacles may stand in each other.
    """
    found = False
    for problem in _local_problems(description):
        found = True
        yield problem
    if not found:
        yield from under("$.world.floor", floor_problems(description))
        yield from overlaps(description, grid, fixed_too=fixed_too)


def _local_problems(description: WorldDescription) -> Iterator[Problem]:
    dt = description.world.dt
    for index, wall in enumerate(description.walls):
        if not isinstance(wall, MapWalls):
            yield from under(f"$.walls[{index}]", wall_problems(wall))
            yield from under(f"$.walls[{index}]", colour_problems(wall.colour))
    yield from under("$.map", colour_problems(description.map.colour if description.map else None))
    for index, obstacle in enumerate(description.obstacles):
        yield from under(f"$.obstacles[{index}]", obstacle_problems(obstacle, dt))
        yield from under(f"$.obstacles[{index}]", colour_problems(obstacle.colour))
        yield from under(f"$.obstacles[{index}]", sign_problems(obstacle.signs))
    for index, robot in enumerate(description.robots):
        yield from under(f"$.robots[{index}]", robot_problems(robot, dt))
    yield from repeated_names([each.name for each in description.robots], "$.robots[{}].name", "two robots are called")
    for index, paint in enumerate(description.paint):
        yield from under(f"$.paint[{index}]", paint_problems(paint))
    yield from under("$", sign_problems(description.signs))
    yield from _size_problems(description)


def mass_problems(robots: Sequence[RobotDescription], obstacles: Sequence[Obstacle]) -> Iterator[Problem]:
    """Yield a problem for each thing so light that the heaviest robot would push it through walls."""
    if not robots:
        return
    heaviest = max(robots, key=lambda each: each.mass)
    masses = [(f"$.obstacles[{index}].mass", each.mass) for index, each in enumerate(obstacles)]
    masses += [(f"$.robots[{index}].mass", each.mass) for index, each in enumerate(robots)]
    for path, mass in masses:
        if mass is not None and mass < _LIGHTEST * heaviest.mass:
            pushed = f"{mass:g} kg, which robot '{shown(heaviest.name)}' of {heaviest.mass:g} kg would push"
            right = f"at least {_LIGHTEST * heaviest.mass:g}, or that robot at most {mass / _LIGHTEST:g}"
            yield Problem(path, f"{pushed} through walls: {right}")


def _size_problems(description: WorldDescription) -> Iterator[Problem]:
    """Yield a problem for each point outside of the world's size."""
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
    for index, paint in enumerate(description.paint):
        if paint.line is None:
            yield f"$.paint[{index}].pose", (paint.pose.x, paint.pose.y)
        yield from ((f"$.paint[{index}].line[{at}]", point) for at, point in enumerate(paint.line or ()))
    for index, sign in enumerate(description.signs):
        yield f"$.signs[{index}].pose", (sign.pose.x, sign.pose.y)
