"""Worlds of obstacles for navigation: made from a seed, each with its map, its start and goal, and the shortest way.

Thirty of them are `WORLDS`, of six kinds in turn: boxes, walls with gaps as narrow as 1.3 robot widths, dead ends,
mazes, people who walk, and a mixture with things that are not on the map. All are 10 by 10 metres.
"""

from __future__ import annotations

import functools
import heapq
import math
import random
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose

Floats = npt.NDArray[np.float64]
Point = tuple[float, float]

SIZE = 10.0
"""Side of a world, in metres."""
RADIUS, SPEED = 0.17, 0.5
"""Radius of the robot in metres, and its full speed in m/s."""
NARROWEST = 1.3
"""Width of the narrowest gaps, in robot widths."""
PERSON = 0.2
"""Radius of a person, in metres."""
RESOLUTION = 0.05
"""Side of a map's cell, in metres."""
MARGIN = 0.5
"""Metres of the map beyond the outer walls."""
SEARCH = 0.025
"""Side of a cell of the search for the shortest way, in metres."""
KINDS = ("boxes", "gaps", "dead_ends", "maze", "people", "mixed")


class Box(NamedTuple):
    """A box: its middle, its heading, and the lengths of its sides in metres."""

    x: float
    y: float
    theta: float
    length: float
    width: float
    is_mapped: bool = True


class Circle(NamedTuple):
    """A round thing."""

    x: float
    y: float
    radius: float
    is_mapped: bool = True


class Walk(NamedTuple):
    """A person who walks to and fro between two places, at a speed in m/s."""

    begin: Point
    end: Point
    speed: float


class Layout(NamedTuple):
    """Contents of a world: lines of walls from point to point, things, and people."""

    walls: list[list[Point]]
    things: list[Box | Circle]
    people: list[Walk]

    def clearance(self, x: npt.ArrayLike, y: npt.ArrayLike, *, mapped_only: bool = False) -> Floats:
        """Return the metres from points to whatever stands nearest; below 0 within a thing. People do not count."""
        px, py = np.asarray(x, np.float64), np.asarray(y, np.float64)
        found = np.full(np.broadcast(px, py).shape, math.inf)
        for line in self.walls:
            for a, b in pairwise(line):
                np.minimum(found, _to_segment(px, py, a, b), out=found)
        for each in self.things:
            if each.is_mapped or not mapped_only:
                np.minimum(found, _to_thing(px, py, each), out=found)
        return found


class NavigationWorld(NamedTuple):
    """A world to navigate in."""

    name: str
    seed: int
    layout: Layout
    start: Pose
    goal: Pose
    way: list[Point]
    """Shortest way for the middle of the robot, as the corners of a line."""

    @property
    def length(self) -> float:
        """Length of the shortest way, in metres."""
        return math.fsum(math.dist(*pair) for pair in pairwise(self.way))

    @property
    def seconds(self) -> float:
        """Time of the shortest way at full speed."""
        return self.length / SPEED

    def cells(self) -> npt.NDArray[np.int8]:
        """Return the map by row from the bottom: 100 where something stands, 0 where nothing does, -1 outside."""
        side = round((SIZE + 2 * MARGIN) / RESOLUTION)
        middle = (np.arange(side) + 0.5) * RESOLUTION - MARGIN
        x, y = np.meshgrid(middle, middle)
        cells = np.where((abs(x - SIZE / 2) < SIZE / 2) & (abs(y - SIZE / 2) < SIZE / 2), 0, -1)
        cells[self.layout.clearance(x, y, mapped_only=True) < 0.6 * RESOLUTION] = 100  # lines between two cells too
        return cells.astype(np.int8)

    def text(self) -> str:
        """Return the world file."""
        pose = ", ".join(f"{each:.3f}" for each in self.start)
        lines = [f"world: {{name: {self.name}, size: [10, 10], seed: {self.seed}}}", "walls:"]
        lines += [
            f"  - {{polyline: [{', '.join(f'[{x:.3f}, {y:.3f}]' for x, y in each)}]}}" for each in self.layout.walls
        ]
        lines += ["obstacles:"] if self.layout.things or self.layout.people else []
        lines += [f"  - {_item(each)}" for each in (*self.layout.things, *self.layout.people)]
        lines += [
            "robots:",
            "  - name: robot",
            f"    pose: [{pose}]",
            f"    shape: {{circle: {RADIUS}}}",
            f"    drive: {{type: diff, v_max: {SPEED}, w_max: 2.0}}",
            "    odom: {rate: 20, noise: {v: 0.02, w: 0.02}, scale: {v: 1.02, w: 0.98}, drift: 0.005}",
            "    sensors: [{lidar: scan, beams: 360, noise: 0.01}]",
        ]
        return "\n".join(lines) + "\n"

    def write(self, folder: Path) -> tuple[Path, Path]:
        """Write the world file and the map, and return their paths; the map is a YAML file with its image."""
        world, chart, image = (folder / f"{self.name}{end}" for end in (".yaml", "_map.yaml", "_map.pgm"))
        world.write_text(self.text(), encoding="utf-8")
        cells = self.cells()
        shades = np.where(cells == 100, 0, np.where(cells == 0, 254, 205)).astype(np.uint8)[::-1]
        image.write_bytes(b"P5 %d %d 255\n" % shades.shape[::-1] + shades.tobytes())
        chart.write_text(
            f"image: {image.name}\nresolution: {RESOLUTION}\norigin: [{-MARGIN}, {-MARGIN}, 0.0]\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.1\nnegate: 0\n",
            encoding="utf-8",
        )
        return world, chart


def _item(each: Box | Circle | Walk) -> str:
    if isinstance(each, Box):
        sides, pose = f"{each.length:.3f}, {each.width:.3f}", f"{each.x:.3f}, {each.y:.3f}, {each.theta:.3f}"
        return f"{{box: [{sides}], pose: [{pose}]}}"
    if isinstance(each, Circle):
        return f"{{circle: {each.radius:.3f}, pose: [{each.x:.3f}, {each.y:.3f}]}}"
    path = ", ".join(f"[{x:.3f}, {y:.3f}]" for x, y in (each.begin, each.end))
    return f"{{circle: {PERSON}, path: [{path}], speed: {each.speed:.2f}}}"


def _to_segment(x: Floats, y: Floats, a: Point, b: Point) -> Floats:
    dx, dy = b[0] - a[0], b[1] - a[1]
    share = np.clip(((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
    return np.hypot(x - a[0] - share * dx, y - a[1] - share * dy)


def _to_thing(x: Floats, y: Floats, each: Box | Circle) -> Floats:
    if isinstance(each, Circle):
        return np.hypot(x - each.x, y - each.y) - each.radius
    cos, sin = math.cos(each.theta), math.sin(each.theta)
    ahead = abs((x - each.x) * cos + (y - each.y) * sin) - each.length / 2
    beside = abs((y - each.y) * cos - (x - each.x) * sin) - each.width / 2
    return np.hypot(np.maximum(ahead, 0.0), np.maximum(beside, 0.0)) + np.minimum(np.maximum(ahead, beside), 0.0)


# Layouts

RIM: list[Point] = [(0.0, 0.0), (SIZE, 0.0), (SIZE, SIZE), (0.0, SIZE), (0.0, 0.0)]
START, GOAL = (1.0, 1.0), (9.0, 9.0)


def _layout(kind: str, chance: random.Random) -> Layout:
    layout = Layout([RIM], [], [])
    MAKERS[kind](layout, chance)
    return layout


def _boxes(layout: Layout, chance: random.Random, count: int = 22, *, is_mapped: bool = True) -> None:
    """Put boxes and round things where they leave a way between them, or stand so close that there is none."""
    for _ in range(400 * count):
        x, y = chance.uniform(0.3, 9.7), chance.uniform(0.3, 9.7)
        if chance.random() < 0.7:
            sides = chance.uniform(0.3, 1.2), chance.uniform(0.3, 0.8)
            each: Box | Circle = Box(x, y, chance.uniform(-math.pi, math.pi), *sides, is_mapped)
            reach = math.hypot(*sides) / 2
        else:
            each, reach = Circle(x, y, chance.uniform(0.1, 0.4), is_mapped), 0.4
        free = float(layout.clearance(x, y)) - reach
        near_end = min(math.dist((x, y), START), math.dist((x, y), GOAL)) < reach + 0.6
        if free > 2 * RADIUS * NARROWEST + 0.05 and not near_end:
            layout.things.append(each)
            if len(layout.things) >= count:
                return


def _gaps(layout: Layout, chance: random.Random, walls: Sequence[float] = (2.6, 4.8, 7.2)) -> None:
    """Draw walls across, each with a gap: the first of 1.3 robot widths, the others up to 2.2."""
    narrow = chance.randrange(len(walls))
    for number, x in enumerate(walls):
        widths = NARROWEST if number == narrow else chance.uniform(NARROWEST, 2.2)
        half, low = widths * RADIUS, (5.5, 1.2)[number % 2]
        middle = chance.uniform(low, low + 3.2)
        layout.walls.extend([[(x, 0.0), (x, middle - half)], [(x, middle + half), (x, SIZE)]])
    _boxes(layout, chance, len(layout.things) + 6)


def _dead_ends(layout: Layout, chance: random.Random) -> None:
    """Draw pockets that are open towards the start, on the straight way to the goal, and boxes around."""
    for share in (0.35, 0.68):
        x, y = (START[0] + share * 8 + chance.uniform(-0.4, 0.4), START[1] + share * 8 + chance.uniform(-0.4, 0.4))
        side, depth = chance.uniform(0.9, 1.2), chance.uniform(0.8, 1.3)
        turn = math.pi / 4 + chance.uniform(-0.3, 0.3)
        cos, sin = math.cos(turn), math.sin(turn)
        corners = [(-depth, side), (0.0, side), (0.0, -side), (-depth, -side)]
        layout.walls.append([(x + a * cos - b * sin, y + a * sin + b * cos) for a, b in corners])
    _boxes(layout, chance, 8)


def _maze(layout: Layout, chance: random.Random) -> None:
    """Draw a maze of 5 by 5 cells, with one wall left out, so that there may be two ways."""
    cells, side = 5, SIZE / 5
    closed = {
        ((x, y), (x + dx, y + dy))
        for x in range(cells)
        for y in range(cells)
        for dx, dy in ((1, 0), (0, 1))
        if x + dx < cells and y + dy < cells
    }
    way, seen = [(0, 0)], {(0, 0)}
    while way:
        x, y = way[-1]
        around = [(x + dx, y + dy) for dx, dy in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        new = [each for each in around if min(each) >= 0 and max(each) < cells and each not in seen]
        if not new:
            way.pop()
            continue
        cell = chance.choice(new)
        closed.discard(min(((x, y), cell), (cell, (x, y))))
        seen.add(cell)
        way.append(cell)
    inner = sorted(closed)
    for a, b in inner if not inner else chance.sample(inner, len(inner) - 1):
        left, low = b[0] * side, b[1] * side
        end = (left, low + side) if b[0] > a[0] else (left + side, low)
        layout.walls.append([(left, low), end])


def _open(layout: Layout, chance: random.Random) -> None:
    _boxes(layout, chance, 9)


def _mixed(layout: Layout, chance: random.Random) -> None:
    """Draw two walls with gaps and some boxes, of which two are not on the map."""
    _gaps(layout, chance, (3.4, 6.8))
    _boxes(layout, chance, len(layout.things) + 2, is_mapped=False)


MAKERS: dict[str, Callable[[Layout, random.Random], None]] = {
    "boxes": _boxes,
    "gaps": _gaps,
    "dead_ends": _dead_ends,
    "maze": _maze,
    "people": _open,
    "mixed": _mixed,
}


def _walks(layout: Layout, way: Sequence[Point], chance: random.Random, count: int) -> list[Walk]:
    """Return people who cross the way where there is room to go round them."""
    found: list[Walk] = []
    for _ in range(200):
        if len(found) == count:
            break
        x, y, heading = _along(way, chance.uniform(0.25, 0.8))
        side = heading + math.pi / 2 + chance.uniform(-0.3, 0.3)
        ends = [_reach(layout, x, y, side + turn) for turn in (0.0, math.pi)]
        places = [place for each in found for place in (each.begin, each.end)]
        is_apart = all(math.dist((x, y), at) > 1.5 and math.dist(ends[0], at) > 0.6 for at in places)
        is_open = float(layout.clearance(x, y)) > 1.0 and min(math.dist((x, y), end) for end in ends) > 0.9
        if is_open and is_apart and min(math.dist(end, at) for end in ends for at in (START, GOAL)) > 1.5:
            found.append(Walk(ends[0], ends[1], round(chance.uniform(0.2, 0.4), 2)))
    return found


def _along(way: Sequence[Point], share: float) -> tuple[float, float, float]:
    """Return the place at a share of a line's length, and the heading there."""
    left = share * math.fsum(math.dist(*pair) for pair in pairwise(way))
    for (x1, y1), (x2, y2) in pairwise(way):
        length, heading = math.dist((x1, y1), (x2, y2)), math.atan2(y2 - y1, x2 - x1)
        if left <= length:
            break
        left -= length
    return x1 + (x2 - x1) * min(1.0, left / length), y1 + (y2 - y1) * min(1.0, left / length), heading


def _reach(layout: Layout, x: float, y: float, heading: float) -> Point:
    """Return how far a person gets in a direction, 2 m at most, with room for the robot left beside the wall."""
    way = 0.0
    while way < 2.0:
        ahead = way + 0.1
        if float(layout.clearance(x + ahead * math.cos(heading), y + ahead * math.sin(heading))) < PERSON + 0.15:
            break
        way = ahead
    return (round(x + way * math.cos(heading), 3), round(y + way * math.sin(heading), 3))


# The shortest way


def shortest_way(layout: Layout, start: Point, goal: Point) -> list[Point] | None:
    """Return the corners of the shortest way of the robot's middle; None if there is none.

    It is found on a fine grid by A*, and then pulled taut: to within a centimetre or two.
    """
    side = round(SIZE / SEARCH)
    middle = (np.arange(side) + 0.5) * SEARCH
    x, y = np.meshgrid(middle, middle)
    free = layout.clearance(x, y) > RADIUS
    cells = _found(free, *(tuple(int(each / SEARCH) for each in reversed(at)) for at in (start, goal)))
    if cells is None:
        return None
    way = [start, *(((column + 0.5) * SEARCH, (row + 0.5) * SEARCH) for row, column in cells[1:-1]), goal]
    for _ in range(3):
        way = _pulled(layout, way)
    return way


def _found(free: npt.NDArray[np.bool_], start: Any, goal: Any) -> list[tuple[int, int]] | None:
    """Return the cells of a shortest path among free cells, by steps to 16 neighbours."""
    steps = [(a, b) for a in range(-2, 3) for b in range(-2, 3) if max(abs(a), abs(b)) == 1 or abs(a) + abs(b) == 3]
    costs = {start: 0.0}
    before: dict[tuple[int, int], tuple[int, int]] = {}
    waiting = [(math.dist(start, goal), start)]
    done = set()
    while waiting:
        _, at = heapq.heappop(waiting)
        if at == goal:
            path = [at]
            while at != start:
                at = before[at]
                path.append(at)
            return path[::-1]
        if at in done:
            continue
        done.add(at)
        for a, b in steps:
            to = at[0] + a, at[1] + b
            if not (min(to) >= 0 and max(to) < len(free) and free[to]):
                continue
            cost = costs[at] + math.hypot(a, b)
            if cost < costs.get(to, math.inf):
                costs[to], before[to] = cost, at
                heapq.heappush(waiting, (cost + math.dist(to, goal), to))
    return None


def _pulled(layout: Layout, way: list[Point]) -> list[Point]:
    """Leave out corners between which the robot can drive straight on, and put new ones halfway, to be pulled again."""
    pulled = [way[0]]
    at = 0
    while at < len(way) - 1:
        low, high = at + 1, len(way) - 1
        while low < high:  # the farthest that is in sight: nearly monotonous, and safe in any case
            middle = (low + high + 1) // 2
            low, high = (middle, high) if _in_sight(layout, way[at], way[middle]) else (low, middle - 1)
        at = low
        pulled.append(way[at])
    if len(pulled) == 2:
        return pulled
    halves: list[Point] = [pulled[0]]
    for (x1, y1), (x2, y2) in pairwise(pulled):
        count = max(1, round(math.dist((x1, y1), (x2, y2)) / 0.1))
        halves += [(x1 + (x2 - x1) * each / count, y1 + (y2 - y1) * each / count) for each in range(1, count + 1)]
    return halves


def _in_sight(layout: Layout, a: Point, b: Point) -> bool:
    count = max(2, round(math.dist(a, b) / 0.02))
    share = np.linspace(0.0, 1.0, count)
    near = layout.clearance(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
    return bool(near.min() > RADIUS - 0.005)


# Worlds

PEOPLE = {"people": 3, "mixed": 1}


@functools.cache
def navigation_world(number: int) -> NavigationWorld:
    """Return the world of a number: the same for the same number. Its kind is that of `KINDS` in turn."""
    kind = KINDS[number % len(KINDS)]
    for attempt in range(100):
        seed = 1000 * number + attempt
        chance = random.Random(seed)
        layout = _layout(kind, chance)
        way = shortest_way(layout, START, GOAL)
        if way is None:
            continue
        walks = _walks(layout, way, chance, PEOPLE.get(kind, 0))
        if len(walks) < PEOPLE.get(kind, 0):
            continue
        layout.people.extend(walks)
        start = Pose(*START, round(_along(way, 0.0)[2] + chance.uniform(-0.8, 0.8), 3))
        goal = Pose(*GOAL, round(_along(way, 1.0)[2], 3))
        return NavigationWorld(f"{kind}_{number:02}", seed, layout, start, goal, way)
    raise AssertionError(f"no world of the kind {kind} for {number}")


WORLDS = tuple(range(30))
"""Numbers of the thirty worlds."""
