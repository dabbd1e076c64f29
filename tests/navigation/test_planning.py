"""Paths through costmaps: that they are found if there is one, are nearly the cheapest, and touch nothing."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from robolink.geometry.plane import Pose
from robolink.navigation.costmap import Costmap, StaticLayer
from robolink.navigation.costmap import InflationLayer as Inflation
from robolink.navigation.grid import Grid
from robolink.navigation.planning import Failure, PlanError, PlanOptions, plan, weights_of
from robolink.navigation.search import BLOCKED, cheapest_way, reachable
from robolink.navigation.smoothing import rounded, shortened, spaced

SLOPE = PlanOptions().slope
RESOLUTION = 0.05


def inflated(occupied: np.ndarray, radius: float = 0.17, reach: float = 0.7, scaling: float = 3.0) -> Grid:
    """Return the costmap of a robot of a radius."""
    static = StaticLayer()
    costmap = Costmap(Grid(occupied, RESOLUTION), [static, Inflation(reach, scaling, radius)])
    static.take(Grid(np.where(occupied, 254, 0).astype(np.uint8), RESOLUTION))
    costmap.update(Pose())
    return costmap.grid


def room(height: int = 100, width: int = 120) -> np.ndarray:
    occupied = np.zeros((height, width), bool)
    occupied[[0, -1]] = occupied[:, [0, -1]] = True
    return occupied


def at(row: float, column: float, theta: float = 0.0) -> Pose:
    return Pose((column + 0.5) * RESOLUTION, (row + 0.5) * RESOLUTION, theta)


def cost_of(weights: np.ndarray, way: list[tuple[int, int]]) -> float:
    return math.fsum(
        math.dist(one, other) * (1 + SLOPE * weights[other] / 252) for one, other in itertools.pairwise(way)
    )


def cheapest(weights: np.ndarray, start: tuple[int, int], goal: tuple[int, int]) -> float:
    """Return the cost of the cheapest way by scipy."""
    height, width = weights.shape
    free = weights != BLOCKED
    rows, columns = np.nonzero(free)
    entries = []
    for up in (-1, 0, 1):
        for right in (-1, 0, 1):
            to = rows + up, columns + right
            ok = (to[0] >= 0) & (to[0] < height) & (to[1] >= 0) & (to[1] < width) & ((up != 0) | (right != 0))
            r, c = rows[ok], columns[ok]
            ok = free[r + up, c + right] & free[r + up, c] & free[r, c + right]
            r, c = r[ok], c[ok]
            price = math.hypot(up, right) * (1 + SLOPE * weights[r + up, c + right] / 252)
            ends = (each.astype(np.int32) for each in (r * width + c, (r + up) * width + c + right))
            entries.append((price, *ends))
    price, one, other = (np.concatenate(each) for each in zip(*entries, strict=True))
    found = dijkstra(
        coo_array((price, (one, other)), (height * width,) * 2).tocsr(), indices=start[0] * width + start[1]
    )
    return float(found[goal[0] * width + goal[1]])


@pytest.mark.slow
@given(arrays.arrays(np.bool_, st.tuples(st.integers(1, 14), st.integers(1, 14))), st.data())
def test_what_is_reachable_hangs_together_by_sides(passable: np.ndarray, data: st.DataObject) -> None:
    row = data.draw(st.integers(0, passable.shape[0] - 1))
    column = data.draw(st.integers(0, passable.shape[1] - 1))
    passable[row, column] = True
    labels, _ = ndimage.label(passable)
    assert (reachable(passable, (row, column)) == (labels == labels[row, column])).all()


@pytest.mark.slow
@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(0.0, 0.45))
def test_a_way_is_found_if_there_is_one(seed: int, density: float) -> None:
    random = np.random.default_rng(seed)
    weights = random.integers(0, 254, (30, 34)).astype(np.uint8)
    weights[random.random(weights.shape) < density] = BLOCKED
    start, goal = (1, 1), (28, 31)
    weights[start] = weights[goal] = 0
    way = cheapest_way(weights, start, goal, SLOPE)
    best = cheapest(weights, start, goal)
    assert (way is None) == math.isinf(best)
    if way is not None:
        assert (way[0], way[-1]) == (start, goal)
        assert all(weights[cell] != BLOCKED for cell in way)
        assert all(max(abs(a - c), abs(b - d)) == 1 for (a, b), (c, d) in itertools.pairwise(way))
        for (a, b), (c, d) in itertools.pairwise(way):
            assert weights[a, d] != BLOCKED  # not across a corner
            assert weights[c, b] != BLOCKED


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_a_way_among_boxes_is_nearly_the_cheapest(seed: int) -> None:
    random = np.random.default_rng(seed)
    occupied = room(160, 180)
    for _ in range(14):
        row, column = random.integers(15, 140, 2)
        height, width = random.integers(3, 16, 2)
        occupied[row : row + height, column : column + width] = True
    weights = weights_of(inflated(occupied).cells, allow_unknown=True)
    start, goal = (8, 8), (150, 170)
    way = cheapest_way(weights, start, goal, SLOPE)
    assert way is not None
    assert cost_of(weights, way) <= 1.02 * cheapest(weights, start, goal)


def test_a_path_leads_from_the_start_to_the_goal() -> None:
    costs = inflated(room())
    path = plan(costs, at(20.1, 20.2), at(80.3, 100.1, 2.0))
    assert path[0, :2] == pytest.approx(at(20.1, 20.2)[:2])
    assert path[-1] == pytest.approx(at(80.3, 100.1, 2.0))
    gaps = np.hypot(*np.diff(path[:, :2], axis=0).T)
    assert gaps.max() <= RESOLUTION + 1e-9
    assert gaps.sum() == pytest.approx(math.dist(path[0, :2], path[-1, :2]))  # nothing between: a straight line
    assert path[:-1, 2] == pytest.approx(math.atan2(60.2, 79.9), abs=1e-6)
    final = plan(costs, at(20, 20), at(20, 60, 2.0), PlanOptions(final_approach=True))
    assert final[-1, 2] == pytest.approx(0.0)


@pytest.mark.parametrize("seed", range(5))
def test_no_pose_of_a_path_is_too_near_to_an_obstacle(seed: int) -> None:
    random = np.random.default_rng(seed)
    occupied = room()
    occupied[random.integers(15, 85, 25), random.integers(15, 105, 25)] = True
    occupied[5:12, 5:12] = occupied[90:95, 110:115] = False
    costs = inflated(occupied)
    path = plan(costs, at(8, 8), at(92, 112))
    dense = np.concatenate([path[:-1, :2] + share * np.diff(path[:, :2], axis=0) for share in (0.0, 0.25, 0.5, 0.75)])
    rows, columns = costs.world_to_cell(dense[:, 0], dense[:, 1])
    assert costs.cells[rows, columns].max() < 253
    turns = np.abs(np.angle(np.exp(1j * np.diff(path[:-1, 2]))))
    assert turns.max() < 0.5  # corners are rounded


def test_a_gap_of_1_3_widths_is_passed() -> None:
    occupied = room()
    occupied[:, 60] = True
    width = math.ceil(1.3 * 2 * 0.17 / RESOLUTION)
    occupied[50 : 50 + width, 60] = False
    path = plan(inflated(occupied), at(20, 20), at(20, 100))
    crossing = path[np.abs(path[:, 0] - at(0, 60).x).argmin()]
    assert crossing[1] == pytest.approx((50 + width / 2) * RESOLUTION, abs=0.05)


def test_a_door_that_closes_leaves_no_path() -> None:
    occupied = room()
    occupied[:, 60] = True
    with pytest.raises(PlanError, match=r"no way leads to the goal \(5.03, 1.03\)") as error:
        plan(inflated(occupied), at(20, 20), at(20, 100))
    assert error.value.failure is Failure.NO_VALID_PATH


def test_a_goal_in_a_wall_leads_beside_it_within_the_tolerance() -> None:
    occupied = room()
    occupied[40:60, 80:84] = True
    costs = inflated(occupied)
    path = plan(costs, at(50, 20), at(50, 81))
    assert math.dist(path[-1, :2], at(50, 81)[:2]) <= 0.5
    rows, columns = costs.world_to_cell(path[:, 0], path[:, 1])
    assert costs.cells[rows, columns].max() < 253
    with pytest.raises(PlanError, match="is in an obstacle, and no cell within the tolerance of") as error:
        plan(costs, at(50, 20), at(50, 81), PlanOptions(tolerance=0.1))
    assert error.value.failure is Failure.GOAL_OCCUPIED


def test_a_robot_too_near_to_a_wall_gets_away() -> None:
    costs = inflated(room())
    start = at(50, 2)
    assert costs.cells[50, 2] == 253
    path = plan(costs, start, at(50, 100))
    assert path[0, :2] == pytest.approx(start[:2])
    assert np.hypot(*np.diff(path[:, :2], axis=0).T).max() <= RESOLUTION * 1.01
    rows, columns = costs.world_to_cell(path[:, 0], path[:, 1])
    near = costs.cells[rows, columns] >= 253
    assert near[0]
    assert not near[6:].any()


@pytest.mark.parametrize(
    ("start", "goal", "failure"),
    [
        (at(-1, 5), at(50, 50), Failure.START_OUTSIDE_MAP),
        (Pose(math.nan, 0.0, 0.0), at(50, 50), Failure.START_OUTSIDE_MAP),
        (at(50, 50), at(500, 5), Failure.GOAL_OUTSIDE_MAP),
        (at(50, 50), Pose(math.inf, 0.0, 0.0), Failure.GOAL_OUTSIDE_MAP),
        (at(0, 50), at(50, 50), Failure.START_OCCUPIED),
    ],
)
def test_reasons_why_there_is_no_path(start: Pose, goal: Pose, failure: Failure) -> None:
    with pytest.raises(PlanError) as error:
        plan(inflated(room()), start, goal)
    assert error.value.failure is failure


def test_a_start_that_is_walled_in_is_occupied() -> None:
    cells = np.full((60, 60), 253, np.uint8)
    cells[50:, 50:] = 0
    with pytest.raises(PlanError, match="no free cell within 1 m") as error:
        plan(Grid(cells, RESOLUTION), at(10, 10), at(55, 55))
    assert error.value.failure is Failure.START_OCCUPIED


def test_unknown_cells_are_passed_only_where_that_is_allowed() -> None:
    cells = np.zeros((40, 60), np.uint8)
    cells[:, 30:34] = 255
    costs = Grid(cells, RESOLUTION)
    assert len(plan(costs, at(20, 10), at(20, 50))) > 30
    with pytest.raises(PlanError):
        plan(costs, at(20, 10), at(20, 50), PlanOptions(allow_unknown=False))


def test_a_goal_where_the_robot_is() -> None:
    costs = inflated(room())
    assert plan(costs, at(50, 50, 1.0), at(50, 50, 2.0)) == pytest.approx(np.array([at(50, 50, 2.0)]))
    assert plan(costs, at(50, 50), at(50.3, 50.3, 2.0))[-1] == pytest.approx(at(50.3, 50.3, 2.0))


def test_a_map_of_one_cell() -> None:
    costs = Grid(np.zeros((1, 1), np.uint8), 1.0)
    assert plan(costs, Pose(0.2, 0.2, 0.0), Pose(0.8, 0.2, 1.0))[-1] == pytest.approx((0.8, 0.2, 1.0))


def test_a_turned_map_gives_turned_paths() -> None:
    straight = plan(Grid(inflated(room()).cells, RESOLUTION), at(20, 20), at(70, 90, 1.0))
    turned = Grid(inflated(room()).cells, RESOLUTION, (1.0, 2.0, math.pi / 2))

    def moved(pose: Pose) -> Pose:
        return Pose(1.0 - pose.y, 2.0 + pose.x, pose.theta + math.pi / 2)

    path = plan(turned, moved(at(20, 20)), moved(at(70, 90, 1.0)))
    assert path == pytest.approx(np.array([moved(Pose(*each)) for each in straight]), abs=1e-9)


def test_a_straight_line_replaces_steps_but_not_through_a_wall() -> None:
    weights = np.zeros((20, 20), np.uint8)
    weights[0:15, 10] = BLOCKED
    way = cheapest_way(weights, (2, 2), (2, 17), SLOPE)
    assert way is not None
    corners = shortened(np.array(way, float)[:, ::-1] + 0.5, weights, SLOPE)
    assert 3 <= len(corners) <= 6
    points = rounded(spaced(corners, 0.5), weights)
    cells = np.floor(points).astype(int)
    assert (weights[cells[:, 1], cells[:, 0]] != BLOCKED).all()


def test_short_paths_are_not_smoothed() -> None:
    points = np.array([[0.5, 0.5], [0.6, 0.5]])
    weights = np.zeros((1, 1), np.uint8)
    assert (rounded(points, weights) == points).all()
    assert (shortened(points, weights, SLOPE) == points).all()
    assert len(spaced(points, 1.0)) == 2
