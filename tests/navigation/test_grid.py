"""Grids: points and cells both ways, and exact distances to occupied cells beside scipy's."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy import ndimage

from robolink.navigation.grid import FAR, Grid, distances

places = st.floats(-100.0, 100.0)


def test_a_point_lies_in_the_cell_that_holds_it() -> None:
    grid = Grid(np.zeros((4, 6), np.int8), 0.5, (-1.0, 2.0, 0.0))
    row, column = grid.world_to_cell([-1.0, -0.51, 1.99, 2.0], [2.0, 2.49, 3.99, 4.0])
    assert (row.tolist(), column.tolist()) == ([0, 0, 3, 4], [0, 0, 5, 6])
    assert grid.contains(row, column).tolist() == [True, True, True, False]
    x, y = grid.cell_to_world(3, 5)
    assert (float(x), float(y)) == (1.75, 3.75)


def test_a_turned_grid_is_turned_about_its_corner() -> None:
    grid = Grid(np.zeros((2, 3), np.int8), 1.0, (5.0, 5.0, math.pi / 2))
    x, y = grid.cell_to_world([0, 1], [2, 0])
    assert np.allclose((x, y), [[4.5, 3.5], [7.5, 5.5]])
    assert [each.tolist() for each in grid.world_to_cell(x, y)] == [[0, 1], [2, 0]]


@pytest.mark.slow
@given(places, places, st.floats(-4.0, 4.0), st.floats(0.01, 2.0), st.integers(-500, 500), st.integers(-500, 500))
def test_the_centre_of_a_cell_lies_in_it(
    x: float, y: float, theta: float, resolution: float, row: int, column: int
) -> None:
    grid = Grid(np.zeros((1, 1), np.int8), resolution, (x, y, theta))
    found = grid.world_to_cell(*grid.cell_to_world(row, column))
    assert (int(found[0]), int(found[1])) == (row, column)


def test_points_that_are_no_numbers_lie_off_the_grid() -> None:
    grid = Grid(np.zeros((4, 6), np.int8), 0.05)
    row, column = grid.world_to_cell([math.nan, math.inf, 1e300], [0.0, -math.inf, -1e300])
    assert (row.tolist(), column.tolist()) == ([0, -FAR, -FAR], [-FAR, FAR, FAR])
    assert not grid.contains(row, column).any()


@pytest.mark.slow
@given(arrays.arrays(np.bool_, st.tuples(st.integers(1, 25), st.integers(1, 25))), st.integers(1, 40))
def test_distances_are_scipys(occupied: np.ndarray, most: int) -> None:
    expected = ndimage.distance_transform_edt(~occupied) if occupied.any() else np.full(occupied.shape, math.inf)
    assert np.allclose(distances(occupied), expected)
    assert np.allclose(distances(occupied, most), np.minimum(expected, most))


@pytest.mark.parametrize("most", [14, 200, None])
def test_distances_of_a_large_map_are_scipys(most: int | None) -> None:
    occupied = np.random.default_rng(1).random((150, 700)) < 0.001
    occupied[:, 300:] = False
    expected = ndimage.distance_transform_edt(~occupied)
    assert np.allclose(distances(occupied, most), np.minimum(expected, most or math.inf))


def test_distances_where_there_is_nothing() -> None:
    assert distances(np.zeros((0, 0), bool), 3).shape == (0, 0)
    assert distances(np.zeros((2, 2), bool), 3).tolist() == [[3, 3], [3, 3]]
    assert distances(np.zeros((1, 2), bool)).tolist() == [[math.inf, math.inf]]
    assert distances(np.ones((2, 1), bool)).tolist() == [[0], [0]]
