"""The worlds that benchmarks measure in: a room with boxes, and a maze."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

from robolink.sim.description import Lidar, Obstacle, Point, Pose, RobotDescription, Settings, Wall, WorldDescription

Cell = tuple[int, int]

_BOXES = 14
_CELLS = 20
_SIDE = 2.0


def room(robots: int = 1, beams: int = 360, seed: int = 7) -> WorldDescription:
    """Give a room of 10 x 10 m with 14 boxes: 60 segments. Up to about 120 robots fit.

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
    """Give a maze of 40 x 40 m, in which one way leads from each of its 2 m cells to each other: 401 segments.

    Up to 400 robots fit; they are as in `room`.
    """
    drawn = random.Random(seed)
    cells = [(column, row) for column in range(_CELLS) for row in range(_CELLS)]
    inner = [Wall(_between(*pair)) for pair in _closed(drawn)]
    places = [_in_cell(drawn, cell) for cell in drawn.sample(cells, len(cells))][:robots]
    return WorldDescription(
        world=Settings(name="maze", size=(_CELLS * _SIDE, _CELLS * _SIDE), seed=seed),
        walls=(Wall(_rim(), closed=True), *inner),
        robots=_robots(places, beams),
    )


def _free_place(drawn: random.Random, radius: float, taken: list[tuple[float, float, float]]) -> Pose:
    """Draw a place in the room where a circle meets no other, and take it."""
    while True:
        x, y = (drawn.uniform(radius, 10.0 - radius) for _ in "xy")
        if all(math.hypot(x - other_x, y - other_y) > radius + other for other_x, other_y, other in taken):
            taken.append((x, y, radius))
            return Pose(x, y, drawn.uniform(-math.pi, math.pi))


def _closed(drawn: random.Random) -> list[tuple[Cell, Cell]]:
    """Give the neighbouring cells with a wall between them, after all cells were reached from the first."""
    way, reached, opened = [(0, 0)], {(0, 0)}, set()
    while way:
        around = [cell for cell in _neighbours(way[-1]) if cell not in reached]
        if not around:
            way.pop()
            continue
        cell = drawn.choice(around)
        opened.add(frozenset((way[-1], cell)))
        reached.add(cell)
        way.append(cell)
    pairs = [((x, y), cell) for x in range(_CELLS) for y in range(_CELLS) for cell in _neighbours((x, y))]
    return [(one, other) for one, other in pairs if one < other and frozenset((one, other)) not in opened]


def _neighbours(cell: Cell) -> list[Cell]:
    x, y = cell
    around = [(x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)]
    return [each for each in around if 0 <= each[0] < _CELLS and 0 <= each[1] < _CELLS]


def _between(one: Cell, other: Cell) -> tuple[Point, Point]:
    """Give the wall between a cell and its right or upper neighbour."""
    x, y = other[0] * _SIDE, other[1] * _SIDE
    return ((x, y), (x, y + _SIDE)) if other[0] > one[0] else ((x, y), (x + _SIDE, y))


def _rim() -> tuple[Point, ...]:
    """Give the corners of the outer wall, which has a joint every two cells."""
    whole, steps = _CELLS * _SIDE, [2 * _SIDE * index for index in range(_CELLS // 2)]
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
