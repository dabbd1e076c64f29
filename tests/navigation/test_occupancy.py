"""Occupancy: cells along a beam are free, its end is occupied, and a scan that is taken out leaves nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.geometry.plane import Pose
from robolink.navigation.grid import Grid
from robolink.navigation.occupancy import Beams, Lidar, Occupancy, beams_of
from tests.support.scanned_rooms import ROOM, points

STAND = Pose(2.0, 2.0, 0.3)


def beams_to(*ends: tuple[float, float], hits: int | None = None, origin: tuple[float, float] = (0.0, 0.0)) -> Beams:
    return Beams(np.array(ends, float).reshape(-1, 2), len(ends) if hits is None else hits, origin)


def value(grid: Grid, x: float, y: float) -> int:
    row, column = grid.world_to_cell(x, y)
    return int(grid.cells[int(row), int(column)])


def test_a_beam_frees_its_way_and_hits_at_its_end() -> None:
    occupancy = Occupancy(0.1)
    for _ in range(3):
        occupancy.add(Pose(), beams_to((1.05, 0.05)))
    grid = occupancy.grid()
    assert grid.cells.tolist() == [[0] * 10 + [100]]
    assert grid.origin == (0.0, 0.0, 0.0)


def test_two_beams_say_nothing_yet() -> None:
    occupancy = Occupancy(0.1)
    for _ in range(2):
        occupancy.add(Pose(), beams_to((1.05, 0.05)))
    assert (occupancy.grid().cells == -1).all()
    assert Occupancy(0.1).grid().cells.size == 0


def test_a_beam_that_ended_at_nothing_hits_nothing() -> None:
    occupancy = Occupancy(0.1, min_pass_through=0)
    occupancy.add(Pose(), beams_to((1.05, 0.05), (0.05, 1.05), hits=1))
    grid = occupancy.grid()
    assert (value(grid, 1.05, 0.05), value(grid, 0.05, 0.75)) == (100, 0)
    assert (grid.cells == 100).sum() == 1


def test_a_tenth_of_the_beams_makes_a_cell_occupied() -> None:
    occupancy = Occupancy(0.1)
    for number in range(21):
        occupancy.add(Pose(), beams_to((1.05, 0.05)) if number < 2 else beams_to((2.05, 0.05)))
    assert value(occupancy.grid(), 1.05, 0.05) == 0
    occupancy.add(Pose(), beams_to((1.05, 0.05)))
    assert value(occupancy.grid(), 1.05, 0.05) == 100


def test_the_lidar_s_place_on_the_robot_counts() -> None:
    occupancy = Occupancy(0.1, min_pass_through=0)
    occupancy.add(Pose(5.0, 5.0, math.pi / 2), beams_to((1.06, 0.0), origin=(0.36, 0.0)))
    grid = occupancy.grid()
    assert grid.cells.shape == (8, 1)
    assert value(grid, 5.0, 6.05) == 100
    assert grid.origin[1] == pytest.approx(5.3)


def test_the_walls_of_a_room_are_where_they_are() -> None:
    occupancy = Occupancy(0.05)
    for seed in range(4):
        scan = points(ROOM, STAND, seed=seed)
        occupancy.add(STAND, Beams(scan, len(scan)))
    grid = occupancy.grid()
    x, y = grid.cell_to_world(*np.nonzero(grid.cells == 100))
    near = np.minimum.reduce([np.abs(x), np.abs(y), np.abs(y - 8), np.abs(x - 6), np.abs(x - 10)])
    inside = (x > 2.2) & (x < 3.6) & (y > 2.9) & (y < 3.7) | (x > 0.9) & (x < 2.1) & (y > 6.5)
    assert near[~inside].max() < 0.08
    assert value(grid, 4.0, 2.0) == 0
    assert value(grid, 2.0, 2.0) == 0


places = st.floats(-8.0, 8.0)


@given(places, places, st.floats(-4.0, 4.0), st.lists(st.tuples(places, places), max_size=6))
def test_a_scan_that_is_taken_out_leaves_nothing(
    x: float, y: float, theta: float, ends: list[tuple[float, float]]
) -> None:
    occupancy, pose = Occupancy(0.1, min_pass_through=0), Pose(x, y, theta)
    occupancy.add(Pose(), beams_to((1.05, 0.05)))
    before = occupancy.grid()
    beams = beams_to(*ends, hits=len(ends) // 2)
    occupancy.add(pose, beams)
    occupancy.remove(pose, beams)
    after = occupancy.grid()
    assert np.array_equal(before.cells, after.cells)
    assert before.origin == after.origin


@given(places, places, places, places)
def test_a_beam_is_a_way_without_gaps(x0: float, y0: float, x1: float, y1: float) -> None:
    occupancy = Occupancy(0.1, min_pass_through=0)
    occupancy.add(Pose(), beams_to((x1, y1), origin=(x0, y0)))
    rows, columns = np.nonzero(occupancy.grid().cells >= 0)
    assert len(np.unique(rows)) == rows.max() - rows.min() + 1
    assert len(np.unique(columns)) == columns.max() - columns.min() + 1
    assert (occupancy.grid().cells == 100).sum() == 1


def test_far_from_the_origin_the_map_is_no_larger() -> None:
    occupancy = Occupancy(0.05, min_pass_through=0)
    scan = points(ROOM, STAND)
    assert occupancy.add(Pose(1e7, -1e7, 0.3), Beams(scan, len(scan)))
    assert max(occupancy.grid().cells.shape) < 300
    assert occupancy.grid().origin[0] == pytest.approx(1e7, abs=20)


def test_scans_that_are_too_far_apart_for_one_map_are_refused() -> None:
    occupancy = Occupancy(0.05, min_pass_through=0)
    assert occupancy.add(Pose(), beams_to((1.0, 0.0)))
    assert not occupancy.add(Pose(1e6, 1e6), beams_to((1.0, 0.0)))
    assert max(occupancy.grid().cells.shape) < 30


def test_beams_are_what_was_measured() -> None:
    ranges = [1.0, math.nan, math.inf, -math.inf, 0.05, 0.1, 8.0, 9.9, 10.0, 2.0, -1.0]
    lidar = Lidar((0.5, 0.25), np.array([[0.0, -1.0], [1.0, 0.0]]))
    beams = beams_of(ranges, np.zeros(len(ranges)), (0.1, 10.0), 5.0, lidar)
    assert beams.origin == (0.5, 0.25)
    assert np.allclose(beams.ends, [[0.5, 1.25], [0.5, 2.25], [0.5, 5.25], [0.5, 5.25]])
    assert np.allclose(beams.points, [[0.5, 1.25], [0.5, 2.25]])
    assert len(beams_of([], [], (0.1, 10.0), 5.0, lidar).ends) == 0
