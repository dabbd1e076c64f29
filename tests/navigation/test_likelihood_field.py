"""Likelihood fields: how ends of beams are rated by the distance to the surfaces of walls."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.navigation.grid import Grid
from robolink.navigation.likelihood_field import UNITS, LikelihoodField, SensorModel, surfaces

MODEL = SensorModel()


def drawn(*rows: str) -> np.ndarray:
    """Return cells of a drawing, top row first: # wall, . free, ? unknown."""
    return np.array([[{"#": 100, ".": 0, "?": -1}[each] for each in row] for row in reversed(rows)], np.int8)


def field_of(
    cells: np.ndarray, origin: tuple[float, float, float] = (0.0, 0.0, 0.0), model: SensorModel = MODEL
) -> LikelihoodField:
    return LikelihoodField(Grid(cells, 0.1, origin), model, 10.0)


def rated(field: LikelihoodField, x: float, y: float, pose: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> int:
    """Return the rating of a beam that ends at x, y as seen from a pose."""
    return int(field.ratings(np.array(pose)[:, None], np.array([x]), np.array([y]))[0, 0])


def expected(distance: float, model: SensorModel = MODEL) -> float:
    hit = model.z_hit * math.exp(-(distance**2) / (2 * model.sigma_hit**2))
    return UNITS * math.log(hit + model.z_rand / 10.0)


def seen(*rows: str) -> list[tuple[int, int]]:
    """Return the surfaces of a drawing, as (x, y) in halves of a cell."""
    cells = drawn(*rows)
    row, column = surfaces(cells >= 65, cells == 0).nonzero()
    return sorted(zip(column.tolist(), row.tolist(), strict=True))


def test_a_thin_wall_is_seen_in_its_middle() -> None:
    assert seen("...", "###", "...") == [(each, 3) for each in range(1, 6)]
    assert seen("?#.") == [(3, 1)]


def test_a_thick_wall_is_seen_at_its_edge() -> None:
    assert seen("##.", "##.") == [(4, 0), (4, 1), (4, 2), (4, 3), (4, 4)]


def test_the_inside_of_a_wall_is_not_seen_and_a_lone_cell_is() -> None:
    assert seen("?##.", "?##.", "?##.") == [(6, each) for each in range(7)]
    assert seen("????.", "?#???", "????.") == [(3, 3)]


def test_a_map_without_free_cells_has_walls_all_the_same() -> None:
    assert seen("???", "?##", "???") == [(3, 3), (4, 3), (5, 3)]


def test_beams_are_rated_by_the_distance_to_the_nearest_surface() -> None:
    field = field_of(drawn(*["#...................."] * 21))
    for x in (0.05, 0.2, 0.4, 0.7):
        assert rated(field, x, 1.0) == pytest.approx(expected(x - 0.05), abs=20)
    assert rated(field, 1.9, 1.0) == pytest.approx(expected(2.0), abs=1)
    assert field.rating(0.5) == round(expected(0.5))


def test_distances_are_finer_than_cells() -> None:
    field = field_of(drawn(*["##..................."] * 21))  # its surface is at 0.2
    ratings = [rated(field, 0.2 + 0.025 * step, 1.0) for step in range(-4, 5)]
    assert ratings == ratings[::-1]
    assert ratings[4] == max(ratings) == pytest.approx(expected(0.0), abs=1)
    assert len(set(ratings[4:])) == 5


def test_what_is_off_the_map_is_far_from_everything() -> None:
    field = field_of(drawn(*["#"] * 3))
    far = pytest.approx(expected(2.0), abs=1)
    for x, y in ((-50.0, 0.1), (50.0, 0.1), (0.0, -1e9), (0.0, 1e30)):
        assert rated(field, x, y) == far


def test_a_map_without_walls_rates_all_alike() -> None:
    assert rated(field_of(drawn("....", "....")), 0.1, 0.1) == pytest.approx(expected(2.0), abs=1)


@given(st.floats(-10, 10), st.floats(-10, 10), st.floats(-3.1, 3.1), st.floats(-1, 3), st.floats(-1, 3))
def test_a_map_may_lie_anywhere(x: float, y: float, theta: float, end_x: float, end_y: float) -> None:
    """What a robot sees does not change when the map and the robot are moved together."""
    cells = drawn("....#", ".....", "##...", "##...")
    cos, sin = math.cos(theta), math.sin(theta)
    moved = (x + cos * 0.2 - sin * 0.1, y + sin * 0.2 + cos * 0.1, theta)
    one = rated(field_of(cells), end_x, end_y, (0.2, 0.1, 0.0))
    other = rated(field_of(cells, (x, y, theta)), end_x, end_y, moved)
    assert abs(one - other) < 250  # float32: it may round to the next entry of the table


@pytest.mark.parametrize("cells_wide", [20, 900, 1800])
def test_large_maps_have_coarser_tables(cells_wide: int) -> None:
    cells = np.zeros((1000, cells_wide), np.int8)
    cells[:, 10] = 100
    assert rated(field_of(cells), 1.05, 50.0) == pytest.approx(expected(0.0), abs=1)
    assert rated(field_of(cells), 1.35, 50.0) == pytest.approx(expected(0.3), abs=60)


@pytest.mark.parametrize(
    "model", [SensorModel(z_rand=0.0), SensorModel(0.0, 0.0), SensorModel(sigma_hit=0.0), SensorModel(max_distance=0.0)]
)
def test_wild_parameters_give_numbers(model: SensorModel) -> None:
    field = field_of(drawn("#..", "..."), model=model)
    assert -31 * UNITS < rated(field, 0.25, 0.05) <= rated(field, 0.05, 0.15) <= UNITS
