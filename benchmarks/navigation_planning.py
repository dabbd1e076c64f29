"""Benchmark of costmaps and plans: rooms of 20 x 20 m at 5 cm, and what a costmap's update takes.

    python benchmarks/navigation_planning.py [--rounds 7] [--pairs 20]

For each kind of room: the time of a plan from one corner to the other (least, and median of the rounds), of the
slowest of random pairs of places, the length of the path, what it costs beside the cheapest way through the grid (by
scipy's Dijkstra; a straight line may cost less than steps to neighbours), and the least distance to an obstacle.
Expected: at most 60 ms. `no way` is a room whose doors are closed: the time until that is known.
"""

from __future__ import annotations

import argparse
import math
import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

sys.path.insert(0, str(Path(__file__).parents[1]))

from robolink.geometry.plane import Pose
from robolink.navigation.costmap import Costmap, InflationLayer, Observation, ObstacleLayer, StaticLayer
from robolink.navigation.footprint import circle
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.planning import PlanError, PlanOptions, plan, weights_of
from robolink.navigation.search import BLOCKED
from robolink.navigation.tracing import Span

SIZE, RESOLUTION, RADIUS = 400, 0.05, 0.17
Occupied = npt.NDArray[np.bool_]


def walls() -> Occupied:
    """Return a room of 20 x 20 m with nothing in it."""
    occupied = np.zeros((SIZE, SIZE), bool)
    occupied[[0, -1]] = occupied[:, [0, -1]] = True
    return occupied


def boxes(random: np.random.Generator) -> Occupied:
    """Return a room with sixty boxes."""
    occupied = walls()
    for _ in range(60):
        row, column = random.integers(15, SIZE - 40, 2)
        height, width = random.integers(4, 20, 2)
        occupied[row : row + height, column : column + width] = True
    return occupied


def rooms(random: np.random.Generator) -> Occupied:
    """Return twenty-five rooms, each with doors of 0.9 m to its neighbours."""
    occupied = walls()
    occupied[80::80] = occupied[:, 80::80] = True
    for row in range(0, SIZE, 80):
        for column in range(0, SIZE, 80):
            first, second = random.integers(15, 60, 2)
            if row:
                occupied[row, column + first - 9 : column + first + 9] = False
            if column:
                occupied[row + second - 9 : row + second + 9, column] = False
    return occupied


def closed(random: np.random.Generator) -> Occupied:
    """Return rooms whose last doors are closed."""
    occupied = rooms(random)
    occupied[320, 320:] = occupied[320:, 320] = True
    return occupied


def columns(random: np.random.Generator) -> Occupied:
    """Return a room with a thin column in each half of a square metre or so."""
    return walls() | (random.random((SIZE, SIZE)) < 0.004)


def serpentine(random: np.random.Generator) -> Occupied:
    """Return a way of 250 m to and fro in the room."""
    occupied = walls()
    for number, row in enumerate(range(25, SIZE - 20, 25)):
        occupied[row, slice(20, None) if number % 2 else slice(None, -20)] = True
    return occupied


KINDS: dict[str, Callable[[np.random.Generator], Occupied]] = {
    "empty": lambda random: walls(),
    "boxes": boxes,
    "rooms": rooms,
    "columns": columns,
    "serpentine": serpentine,
    "no way": closed,
}


def inflated(occupied: Occupied) -> Grid:
    """Return the costmap of Nav2's default inflation."""
    static = StaticLayer()
    costmap = Costmap(Grid(occupied, RESOLUTION), [static, InflationLayer(0.7, 3.0, RADIUS)])
    static.take(Grid(np.where(occupied, 254, 0).astype(np.uint8), RESOLUTION))
    costmap.update(Pose())
    return costmap.grid


def free_pose(costs: Grid, place: Floats) -> Pose:
    """Return a pose in the free cell nearest to a place in cells."""
    free = np.argwhere(costs.cells == costs.cells.min())
    row, column = free[np.abs(free - place).sum(axis=1).argmin()]
    x, y = costs.cell_to_world(row, column)
    return Pose(float(x), float(y), 0.0)


def seconds(work: Callable[[], object]) -> float:
    """Return how long something takes."""
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def tried(costs: Grid, start: Pose, goal: Pose) -> Floats | None:
    """Return the path; None if there is none."""
    try:
        return plan(costs, start, goal, PlanOptions(tolerance=0.0))
    except PlanError:
        return None


def cheapest(costs: Grid, start: Pose, goal: Pose) -> float:
    """Return the cost of the cheapest way in cells, by scipy."""
    weights = weights_of(costs.cells, allow_unknown=True)
    free = weights != BLOCKED
    width = weights.shape[1]
    rows, cols = np.nonzero(free)
    edges = []
    for up, right in ((0, 1), (1, 0), (1, 1), (1, -1), (0, -1), (-1, 0), (-1, -1), (-1, 1)):
        # All cells at the edge are walls.
        open_ = free[rows + up, cols + right] & free[rows + up, cols] & free[rows, cols + right]
        to = (rows[open_] + up, cols[open_] + right)
        price = math.hypot(up, right) * (1 + PlanOptions().slope * weights[to] / 252)
        ends = (rows[open_] * width + cols[open_], to[0] * width + to[1])
        edges.append((price, *(each.astype(np.int32) for each in ends)))  # scipy 1.11 takes no others
    price, one, other = (np.concatenate(each) for each in zip(*edges, strict=True))
    graph = coo_array((price, (one, other)), (weights.size,) * 2).tocsr()
    first, last = (
        int(np.ravel_multi_index(costs.world_to_cell(each.x, each.y), weights.shape)) for each in (start, goal)
    )
    return float(dijkstra(graph, indices=first)[last])


def cost_of(costs: Grid, path: Floats) -> float:
    """Return the cost of a path in cells."""
    row, column = costs.world_to_cell(path[:, 0], path[:, 1])
    prices = 1 + PlanOptions().slope * costs.cells[row, column] / 252
    lengths = np.hypot(*np.diff(path[:, :2], axis=0).T) / RESOLUTION
    return float((lengths * (prices[1:] + prices[:-1]) / 2).sum())


def line(name: str, rounds: int, pairs: int) -> str:
    """Return the line of a kind of room."""
    random = np.random.default_rng(0)
    occupied = KINDS[name](random)
    costs = inflated(occupied)
    start, goal = free_pose(costs, np.array([12, 12])), free_pose(costs, np.array([388, 388]))
    times = [seconds(lambda: tried(costs, start, goal)) for _ in range(rounds)]
    places = [free_pose(costs, each) for each in random.uniform(0, SIZE, (2 * pairs, 2))]
    slowest = max(
        min(seconds(partial(tried, costs, *ends)) for _ in range(2))
        for ends in zip(places[::2], places[1::2], strict=True)
    )
    words = f"{name:11} {min(times) * 1e3:6.1f} {statistics.median(times) * 1e3:6.1f} {slowest * 1e3:8.1f}"
    path = tried(costs, start, goal)
    if path is None:
        return f"{words}   none"
    length = float(np.hypot(*np.diff(path[:, :2], axis=0).T).sum())
    row, column = costs.world_to_cell(path[:, 0], path[:, 1])
    near = float(ndimage.distance_transform_edt(~occupied)[row, column].min()) * RESOLUTION
    ratio = cost_of(costs, path) / cheapest(costs, start, goal)
    return f"{words} {length:7.1f} {ratio:9.3f} {near:8.2f}"


def update_times(size: int, rolling: bool, count: int) -> list[float]:
    """Return how long the updates of a costmap of so many cells take: the first one, and those with scans."""
    random = np.random.default_rng(0)
    angles = np.linspace(-math.pi, math.pi, 360, endpoint=False)
    obstacles, static = ObstacleLayer(), StaticLayer()
    obstacles.footprint = circle(RADIUS)
    grid, middle = Grid(np.zeros((size, size), np.uint8), RESOLUTION), size * RESOLUTION / 2
    layers = [obstacles] if rolling else [static, obstacles]
    costmap = Costmap(grid, [*layers, InflationLayer(0.7, 3.0, RADIUS)], rolling=rolling)
    static.take(grid)
    times = [seconds(lambda: costmap.update(Pose(middle, middle)))]
    for _ in range(count):
        robot = Pose(middle + random.uniform(-0.5, 0.5), middle + random.uniform(-0.5, 0.5))
        ranges = 1.5 + np.sin(3 * angles) * 0.8
        x, y = robot.x + ranges * np.cos(angles), robot.y + ranges * np.sin(angles)
        obstacles.observations = [Observation((robot.x, robot.y), x, y, Span(0, 2.5), Span(0, 3.0))]
        times.append(seconds(partial(costmap.update, robot)))
    return times


def main() -> None:
    """Run what the command line requests."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=7, help="plans of each room")
    parser.add_argument("--pairs", type=int, default=20, help="pairs of places in each room")
    requested = parser.parse_args()
    print("room        least median  slowest  length  by cheapest  nearest")
    print("               ms     ms       ms       m               m")
    for name in KINDS:
        print(line(name, requested.rounds, requested.pairs), flush=True)
    for name, size in (("local, 3 x 3 m", 60), ("global, 20 x 20 m", 400), ("global, 50 x 50 m", 1000)):
        first, *others = update_times(size, size == 60, 30 * requested.rounds)
        print(f"{name:18} first update {first * 1e3:6.2f} ms, then {statistics.median(others) * 1e3:5.2f} ms")


if __name__ == "__main__":
    main()
