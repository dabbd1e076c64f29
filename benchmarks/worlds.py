"""Worlds for benchmarks: a room with boxes, and a maze."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from robolink.sim.description import Obstacle, RobotDescription, Settings, Wall, WorldDescription
from robolink.sim.quantities import Point, Pose
from robolink.sim.sensors import Lidar

Cell = tuple[int, int]

_BOXES = 14
_CELLS = 20
_SIDE = 2.0


def room(robots: int = 1, beams: int = 360, seed: int = 7) -> WorldDescription:
    """Return a room of 10 x 10 m with 14 boxes: 60 segments. Up to about 120 robots fit.

    Each robot has a lidar with so many beams, 10 times a second, and odometry 50 times a second; fewer robots stand
    where the first of more do.
    """
    drawn = random.Random(seed)
    taken: list[tuple[float, float, float]] = []
    boxes = []
    for _ in range(_BOXES):
        length, width = drawn.uniform(0.4, 0.8), drawn.uniform(0.3, 0.6)
        place = _free_place(drawn, math.hypot(length, width) / 2 + 0.05, taken)
        boxes.append(Obstacle(box=(length, width), pose=place))
    places = [_free_place(drawn, 0.22, taken) for _ in range(robots)]
    return WorldDescription(
        world=Settings(name="room", size=(10.0, 10.0), seed=seed),
        walls=(Wall(((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)), closed=True),),
        obstacles=tuple(boxes),
        robots=_robots(places, beams),
    )


def maze(robots: int = 1, beams: int = 360, seed: int = 7) -> WorldDescription:
    """Return a maze of 40 x 40 m, in which one way leads from each of its 2 m cells to each other: 401 segments.

    It grows with more than 400 robots, so that each has a cell of its own: 64 x 64 m for 1000. They are as in `room`.
    """
    drawn = random.Random(seed)
    across = max(_CELLS, math.ceil(math.sqrt(robots)))
    across += across % 2  # the rim has a joint every two cells
    cells = [(column, row) for column in range(across) for row in range(across)]
    inner = [Wall(_between(*pair)) for pair in _closed(drawn, across)]
    places = [_in_cell(drawn, cell) for cell in drawn.sample(cells, len(cells))][:robots]
    return WorldDescription(
        world=Settings(name="maze", size=(across * _SIDE, across * _SIDE), seed=seed),
        walls=(Wall(_rim(across), closed=True), *inner),
        robots=_robots(places, beams),
    )


def _free_place(drawn: random.Random, radius: float, taken: list[tuple[float, float, float]]) -> Pose:
    """Draw a place in the room where a circle meets no other, and take it."""
    while True:
        x, y = (drawn.uniform(radius, 10.0 - radius) for _ in "xy")
        if all(math.hypot(x - other_x, y - other_y) > radius + other for other_x, other_y, other in taken):
            taken.append((x, y, radius))
            return Pose(x, y, drawn.uniform(-math.pi, math.pi))


def _closed(drawn: random.Random, across: int) -> list[tuple[Cell, Cell]]:
    """Return the neighbouring cells with a wall between them, after all cells were reached from the first."""
    way, reached, opened = [(0, 0)], {(0, 0)}, set()
    while way:
        around = [cell for cell in _neighbours(way[-1], across) if cell not in reached]
        if not around:
            way.pop()
            continue
        cell = drawn.choice(around)
        opened.add(frozenset((way[-1], cell)))
        reached.add(cell)
        way.append(cell)
    pairs = [((x, y), cell) for x in range(across) for y in range(across) for cell in _neighbours((x, y), across)]
    return [(one, other) for one, other in pairs if one < other and frozenset((one, other)) not in opened]


def _neighbours(cell: Cell, across: int) -> list[Cell]:
    x, y = cell
    around = [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)]
    return [each for each in around if 0 <= each[0] < across and 0 <= each[1] < across]


def _between(one: Cell, other: Cell) -> tuple[Point, Point]:
    """Return the wall between a cell and its right or upper neighbour."""
    x, y = other[0] * _SIDE, other[1] * _SIDE
    return ((x, y), (x, y + _SIDE)) if other[0] > one[0] else ((x, y), (x + _SIDE, y))


def _rim(across: int) -> tuple[Point, ...]:
    """Return the corners of the outer wall, which has a joint every two cells."""
    whole, steps = across * _SIDE, [2 * _SIDE * index for index in range(across // 2)]
    sides: list[Callable[[float], Point]] = [
        lambda way: (way, 0.0),
        lambda way: (whole, way),
        lambda way: (whole - way, whole),
        lambda way: (0.0, whole - way),
    ]
    return tuple(side(way) for side in sides for way in steps)


def _in_cell(drawn: random.Random, cell: Cell) -> Pose:
    x, y = ((each + 0.5) * _SIDE + drawn.uniform(-0.6, 0.6) for each in cell)
    return Pose(x, y, drawn.uniform(-math.pi, math.pi))


def _robots(places: list[Pose], beams: int) -> tuple[RobotDescription, ...]:
    lidar = Lidar("scan", beams=beams)
    return tuple(RobotDescription(f"robot{index}", place, sensors=(lidar,)) for index, place in enumerate(places, 1))
