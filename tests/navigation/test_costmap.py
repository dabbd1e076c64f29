"""Costmaps: lines of sight, layers, inflation, and that what is updated in part is as if all were."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import ndimage

from robolink.geometry.plane import Pose
from robolink.navigation.costmap import (
    KNOWN_MAXIMUM,
    OVERWRITE,
    Costmap,
    InflationLayer,
    Observation,
    ObstacleLayer,
    Occupancies,
    StaticLayer,
    Window,
    rolled,
    whole,
)
from robolink.navigation.footprint import circle
from robolink.navigation.grid import Grid
from robolink.navigation.tracing import Span, trace

FAR = Span(0.0, 100.0)
cells = st.integers(-30, 30)


def line(start: tuple[int, int], end: tuple[int, int]) -> list[tuple[int, int]]:
    """Return Bresenham's line as Nav2's raytraceLine steps it."""
    up, right = abs(end[0] - start[0]), abs(end[1] - start[1])
    row, column = (1 if end[0] > start[0] else -1), (1 if end[1] > start[1] else -1)
    steps, aside = max(up, right), min(up, right)
    found, error, at = [start], steps // 2, list(start)
    for _ in range(steps):
        error += aside
        if up > right:
            at[0] += row
        else:
            at[1] += column
        if error >= steps:
            error -= steps
            at[1 if up > right else 0] += column if up > right else row
        found.append((at[0], at[1]))
    return found


@pytest.mark.slow
@given(st.integers(0, 19), st.integers(0, 24), cells, cells)
def test_lines_are_bresenhams_up_to_the_edge(row: int, column: int, up: int, right: int) -> None:
    start, end = (row, column), (row + up, column + right)
    expected = []
    for each in line(start, end):
        if not (0 <= each[0] < 20 and 0 <= each[1] < 25):
            break
        expected.append(each[0] * 25 + each[1])
    found = trace((20, 25), start, np.array([end[0]]), np.array([end[1]]), Span(0, math.inf))
    assert found.tolist() == expected


def test_lines_have_lengths() -> None:
    ends = np.array([5, 5]), np.array([15, 5])
    found = trace((11, 20), (5, 5), *ends, Span(2, 6))
    assert found.tolist() == [5 * 20 + column for column in range(7, 12)]
    assert trace((11, 20), (5, 5), np.array([], int), np.array([], int), FAR).tolist() == []
    beyond = 2**31 - 1
    assert trace((11, 20), (5, 5), np.array([5]), np.array([beyond]), Span(0, 3)).tolist() == [105, 106, 107, 108]
    assert len(trace((11, 20), (5, 5), np.array([beyond] * 5000), np.array([5] * 5000), FAR)) == 6 * 5000


def costs(occupied: np.ndarray, layer: InflationLayer, resolution: float = 0.05) -> np.ndarray:
    static = StaticLayer()
    costmap = Costmap(Grid(occupied, resolution), [static, layer])
    static.take(Grid(np.where(occupied, 254, 0).astype(np.uint8), resolution))
    costmap.update(Pose())
    return costmap.grid.cells


def test_inflation_is_nav2s_formula() -> None:
    occupied = np.random.default_rng(3).random((60, 70)) < 0.01
    distances = ndimage.distance_transform_edt(~occupied) * 0.05
    expected = np.floor(252 * np.exp(-3.0 * (distances - 0.17)))
    expected[distances <= 0.17] = 253
    expected[distances == 0] = 254
    expected[distances >= 0.7] = 0
    assert np.abs(costs(occupied, InflationLayer(0.7, 3.0, 0.17)) - expected).max() <= 1  # one for rounding
    assert (costs(occupied, InflationLayer(0.0, 3.0, 0.17)) == np.where(occupied, 254, 0)).all()


def test_inflation_of_unknown_cells() -> None:
    below = np.zeros((1, 30), np.uint8)
    below[0, 5], below[0, 7:20] = 254, 255
    for options, nearest, far in (
        ({}, 253, 255),
        ({"inflate_unknown": True}, 253, 100),
        ({"around_unknown": True}, 254, 254),
    ):
        found = below.copy()
        layer = InflationLayer(1.0, 3.0, 0.1, **options)
        layer.match(Grid(found, 0.05))
        layer.write(found, whole(found.shape))
        assert found[0, 7] == nearest
        assert int(found[0, 12]) == pytest.approx(far, abs=25)
        assert (found[0, 22] > 200) == ("around_unknown" in options)


def observation(x: float, y: float, marks: bool = True) -> Observation:
    return Observation((1.0, 1.0), np.array([x]), np.array([y]), FAR if marks else None, FAR)


def test_a_point_is_an_obstacle_until_one_behind_it_is_seen() -> None:
    layer = ObstacleLayer(255)
    costmap = Costmap(Grid(np.zeros((40, 40)), 0.1), [layer], default=255)
    layer.observations = [observation(2.0, 1.05)]
    costmap.update(Pose(1.0, 1.0, 0.0))
    assert (costmap.grid.cells[10, 20], costmap.grid.cells[10, 15], costmap.grid.cells[12, 15]) == (254, 0, 255)
    layer.observations = [observation(3.0, 1.05, marks=False)]
    costmap.update(Pose(1.0, 1.0, 0.0))
    assert (costmap.grid.cells[10, 10:31] == 0).all()
    layer.observations = [observation(3.0, 1.05)._replace(marks=Span(0.0, 1.5), clears=Span(0.0, 1.0))]
    costmap.clear()
    costmap.update(Pose(1.0, 1.0, 0.0))
    assert (costmap.grid.cells[10, 10:21] == 0).all()
    assert (costmap.grid.cells[10, 21:] == 255).all()


def test_an_observation_from_off_the_map_is_not_used() -> None:
    layer = ObstacleLayer()
    costmap = Costmap(Grid(np.zeros((40, 40)), 0.1), [layer])
    layer.observations = [observation(2.0, 1.0)._replace(origin=(-1.0, 1.0))]
    costmap.update(Pose(1.0, 1.0, 0.0))
    assert layer.is_outside
    assert not costmap.grid.cells.any()


def test_points_that_are_far_off_do_no_harm() -> None:
    layer = ObstacleLayer()
    costmap = Costmap(Grid(np.zeros((40, 40)), 0.1), [layer])
    layer.observations = [
        Observation((1.0, 1.0), np.array([1e300, -math.inf, math.nan]), np.array([0.0] * 3), FAR, FAR)
    ]
    with np.errstate(over="ignore", invalid="ignore"):
        costmap.update(Pose(1.0, 1.0, 0.0))
    assert not costmap.grid.cells.any()


def test_the_cells_under_the_robot_are_free() -> None:
    layer = ObstacleLayer()
    layer.footprint = circle(0.3)
    costmap = Costmap(Grid(np.zeros((40, 40)), 0.1), [layer])
    layer.observations = [observation(1.25, 1.05), observation(1.55, 1.05)]
    costmap.update(Pose(1.05, 1.05, 0.0))
    assert (costmap.grid.cells[10, 12], costmap.grid.cells[10, 15]) == (0, 254)
    costmap.update(Pose(-50.0, 1.05, 0.0))  # a robot off the map frees nothing
    assert costmap.grid.cells[10, 12] == 254


@pytest.mark.parametrize(
    ("combination", "expected"),
    [(1, [254, 10, 254, 0]), (OVERWRITE, [0, 10, 254, 0]), (KNOWN_MAXIMUM, [254, 10, 254, 255])],
)
def test_layers_are_combined(combination: int, expected: list[int]) -> None:
    layer = ObstacleLayer(255, combination)
    layer.cells = np.array([[0, 255, 254, 0]], np.uint8)
    below = np.array([[254, 10, 10, 255]], np.uint8)
    layer.write(below, whole(below.shape))
    assert below.tolist() == [expected]


def test_a_map_in_another_frame_is_looked_up() -> None:
    static = StaticLayer()
    costmap = Costmap(Grid(np.zeros((20, 20)), 0.1), [static], rolling=True)
    map_ = np.zeros((50, 50), np.uint8)
    map_[30, 40] = 254
    static.take(Grid(map_, 0.1))
    static.frame = Pose(2.0, 1.0, math.pi / 2)  # of the costmap's frame, in the map's
    costmap.update(Pose(2.0, -2.0, 0.0))
    x, y = 4.05 - 2.0, 3.05 - 1.0
    row, column = costmap.grid.world_to_cell(y, -x)
    assert np.argwhere(costmap.grid.cells == 254).tolist() == [[row, column]]
    static.frame = None
    costmap.update(Pose(2.0, -2.0, 0.0))
    assert not costmap.grid.cells.any()


def test_a_map_lowers_no_cost_if_the_larger_one_counts() -> None:
    below = np.full((2, 2), 7, np.uint8)
    for use_maximum, expected in ((False, 0), (True, 7)):
        static = StaticLayer(use_maximum)
        grid = Grid(np.zeros((2, 2), np.uint8), 1.0)
        static.take(grid)
        static.match(grid)
        found = below.copy()
        static.write(found, whole(found.shape))
        assert (found == expected).all()


def test_occupancies_are_costs() -> None:
    values = np.array([0, 50, 99, 100, -1], np.int8)
    assert Occupancies().costs_of(values).tolist() == [0, 0, 253, 254, 0]
    assert Occupancies(track_unknown_space=True, lethal_cost_threshold=50).costs_of(values).tolist() == [
        0,
        254,
        253,
        254,
        255,
    ]
    assert Occupancies(trinary_costmap=False).costs_of(values).tolist() == [0, 127, 253, 254, 0]


@given(st.integers(-5, 5), st.integers(-5, 5))
def test_rolling_moves_what_stays(rows: int, columns: int) -> None:
    before = np.arange(12, dtype=np.uint8).reshape(3, 4)
    after = rolled(before, rows, columns, 99)
    for row in range(3):
        for column in range(4):
            there = 0 <= row + rows < 3 and 0 <= column + columns < 4
            assert after[row, column] == (before[row + rows, column + columns] if there else 99)


def test_windows() -> None:
    one, other = Window(2, 4, 3, 5), Window(0, 3, 4, 9)
    assert one.joined(other) == Window(0, 4, 3, 9)
    assert one.joined(None) == one
    assert one.grown(3, (5, 7)) == Window(0, 5, 0, 7)


def test_a_part_that_is_updated_is_as_if_all_were() -> None:
    random = np.random.default_rng(5)
    map_ = np.where(random.random((160, 150)) < 0.002, 254, 0).astype(np.uint8)
    static, obstacles = StaticLayer(), ObstacleLayer()
    obstacles.footprint = circle(0.2)
    costmap = Costmap(Grid(map_, 0.05), [static, obstacles, InflationLayer(0.4, 3.0, 0.17)])
    static.take(Grid(map_, 0.05))
    for _ in range(30):
        robot = Pose(random.uniform(0.5, 7.0), random.uniform(0.5, 7.0), 0.0)
        angles, ranges = random.uniform(-3, 3, 40), random.uniform(0.2, 2.0, 40)
        x, y = robot.x + ranges * np.cos(angles), robot.y + ranges * np.sin(angles)
        obstacles.observations = [Observation((robot.x, robot.y), x, y, Span(0.0, 1.5), Span(0.0, 1.8))]
        window = costmap.update(robot)
        assert window is not None
        partly = costmap.grid.cells
        costmap.renew()
        assert costmap.update(robot) == whole(map_.shape)
        assert (costmap.grid.cells == partly).all()


def test_grids_that_were_read_do_not_change() -> None:
    layer = ObstacleLayer()
    costmap = Costmap(Grid(np.zeros((40, 40)), 0.1), [layer])
    costmap.update(Pose())
    before = costmap.grid
    layer.observations = [observation(2.0, 1.05)]
    costmap.update(Pose())
    assert not before.cells.any()
    assert costmap.grid.cells.any()
    layer.observations = []
    before = costmap.grid
    assert costmap.update(Pose()) is None  # nothing is new
    assert costmap.grid is before
