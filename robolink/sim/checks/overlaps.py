"""Overlap check: robots and obstacles that start inside of something else."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import pymunk

from robolink.sim.checks.shapes import Problem
from robolink.sim.description import MapWalls, Obstacle, RobotDescription, WorldDescription
from robolink.sim.physics.bodies import fixed_body, placed, solids, wall_shapes
from robolink.sim.physics.placing import overlapped

if TYPE_CHECKING:
    from robolink.sim.maps.gridmap import GridMap

_WALLS = pymunk.ShapeFilter(categories=2)
_BUT_WALLS = pymunk.ShapeFilter(categories=1, mask=pymunk.ShapeFilter.ALL_MASKS() ^ 2)
_MAP = "the map's walls"

CROWDED = "$.obstacles"
"""Path of the problem that too many shapes meet."""
MOST_MEETINGS = 30_000
"""Most meetings of shapes at the start of a world, counted from both sides: each takes 20 us to check."""


class _Thing(NamedTuple):
    """A robot or an obstacle where it starts; `free` if others can push it."""

    place: str
    body: pymunk.Body
    shapes: list[pymunk.Shape]
    free: bool


class _CrowdedError(Exception):
    """Too many shapes meet: a check of all would take minutes."""


def overlaps(
    description: WorldDescription, grid: GridMap | None = None, *, fixed_too: bool = True
) -> Iterator[Problem]:
    """Yield robots and obstacles that start inside of others; fixed obstacles may overlap walls.

    All shapes must be right by themselves. `grid` is the world's map, in whose occupied cells nothing free may be.
    Without `fixed_too` fixed obstacles may stand in each other. Where too many shapes meet, that is the last problem.
    """
    try:
        yield from _overlaps(description, grid, fixed_too)
    except _CrowdedError:
        yield Problem(CROWDED, f"too much stands in one place: over {MOST_MEETINGS:,} shapes meet others")


def _overlaps(description: WorldDescription, grid: GridMap | None, fixed_too: bool) -> Iterator[Problem]:
    space = pymunk.Space()
    things = _things(description)
    owners = {shape: thing.place for thing in things for shape in thing.shapes}
    for thing in things:
        space.add(thing.body, *thing.shapes)
    owners |= _add_walls(description, space, [thing for thing in things if thing.free])
    found, search = set[frozenset[str]](), _Search(space)
    for thing in (each for each in things if each.free or fixed_too):
        other = search.overlap(thing)
        pair = frozenset((thing.place, "" if other is None else owners[other]))
        if other is not None and pair not in found:
            yield Problem(f"$.{thing.place}.pose", _said(thing, owners[other]))
        elif other is None and thing.free and grid is not None and grid.is_occupied(*_inner_point(thing)):
            yield Problem(f"$.{thing.place}.pose", _said(thing, _MAP))
        found.add(pair)


class _Search:
    """Finds overlaps in a space; raises `_CrowdedError` once shapes have met others more than `MOST_MEETINGS` times."""

    def __init__(self, space: pymunk.Space) -> None:
        self._space, self._met = space, 0

    def overlap(self, thing: _Thing) -> pymunk.Shape | None:
        """Return the first shape that a thing overlaps, or None."""
        for shape in thing.shapes:
            found = self._space.shape_query(shape)
            self._met += len(found)
            if self._met > MOST_MEETINGS:
                raise _CrowdedError
            if (other := overlapped(shape, found)) is not None:
                return other
        return None


def _said(thing: _Thing, other: str) -> str:
    if thing.free:
        return f"this starts inside of {other}: move it out of there"
    return f"this overlaps {other}: move one of them, or make one polygon of both"


def _things(description: WorldDescription) -> list[_Thing]:
    """Return robots and obstacles in the order in which they are to blame: later fixed ones before earlier ones."""
    robots = [_robot(f"robots[{index}]", each) for index, each in enumerate(description.robots)]
    obstacles = [_obstacle(f"obstacles[{index}]", each) for index, each in enumerate(description.obstacles)]
    fixed = [each for each in obstacles if not each.free]
    return [*robots, *(each for each in obstacles if each.free), *reversed(fixed)]


def _robot(place: str, robot: RobotDescription) -> _Thing:
    body = placed(fixed_body(), robot.pose)
    return _Thing(place, body, solids(robot.shape, body), free=True)


def _obstacle(place: str, obstacle: Obstacle) -> _Thing:
    body = placed(fixed_body(), obstacle.start)
    shapes = solids(obstacle, body)
    if obstacle.mass is None:
        for shape in shapes:
            shape.filter = _BUT_WALLS
    return _Thing(place, body, shapes, free=obstacle.mass is not None)


def _add_walls(description: WorldDescription, space: pymunk.Space, free: Sequence[_Thing]) -> dict[pymunk.Shape, str]:
    """Add all walls to the space, of a map those near anything free; return what each shape belongs to."""
    owners = dict[pymunk.Shape, str]()
    for index, wall in enumerate(description.walls):
        near = _near(wall, free) if isinstance(wall, MapWalls) else wall
        shapes = wall_shapes(near, space.static_body)
        for shape in shapes:
            shape.filter = _WALLS
        space.add(*shapes)
        owners |= dict.fromkeys(shapes, _MAP if isinstance(wall, MapWalls) else f"walls[{index}]")
    return owners


def _near(walls: MapWalls, free: Sequence[_Thing]) -> MapWalls:
    """Leave out the walls whose bounding boxes no free thing's bounding box meets."""
    import numpy as np  # late: only worlds with a map need it

    ends = np.array(walls.polyline, dtype=np.float64).reshape(-1, 2, 2)
    low, high, near = ends.min(axis=1), ends.max(axis=1), np.zeros(len(ends), dtype=np.bool_)
    for shape in (shape for thing in free for shape in thing.shapes):
        box = shape.cache_bb()
        near |= np.all((low <= (box.right, box.top)) & (high >= (box.left, box.bottom)), axis=1)
    return MapWalls(tuple((x, y) for x, y in ends[near].reshape(-1, 2).tolist()))


def _inner_point(thing: _Thing) -> tuple[float, float]:
    """Return a point of the world that lies inside of a thing."""
    x, y = thing.body.local_to_world(thing.shapes[0].center_of_gravity)
    return x, y
