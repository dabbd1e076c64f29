"""Footprints: the text of a polygon, its radii, and the costs under it."""

from __future__ import annotations

import contextlib
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.navigation.footprint import (
    LETHAL,
    UNKNOWN,
    FootprintError,
    circle,
    contains,
    cover,
    highest_costs,
    padded,
    parse_footprint,
    radii,
)
from robolink.navigation.grid import Grid

SQUARE = "[[0.2, 0.2], [0.2, -0.2], [-0.2, -0.2], [-0.2, 0.2]]"


def test_text_of_a_polygon() -> None:
    assert parse_footprint(SQUARE).tolist() == [[0.2, 0.2], [0.2, -0.2], [-0.2, -0.2], [-0.2, 0.2]]
    assert parse_footprint(" [[0, 1], [1, 0], [-1, 0]]\n").shape == (3, 2)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "[[0, 0], [1, 1]]",
        "[[0, 0], [1, 1], [1]]",
        "[[0, 0, 0], [1, 1, 1], [2, 0, 0]]",
        "[[0, 0], [1, 1], [1, 'a']]",
        "[[0, 0], [1, 1], [1, 1e9]]",
        "[[0, 0], [1, 1], [1, 1e999]]",
        "[[0, 0], [1, 1], [1, nan]]",
        "__import__('os')",
        "[" * 500,
    ],
)
def test_other_texts_are_refused(text: str) -> None:
    with pytest.raises(FootprintError, match="footprint: expected"):
        parse_footprint(text)


@given(st.text(max_size=40))
def test_any_text_is_a_polygon_or_refused(text: str) -> None:
    with contextlib.suppress(FootprintError):
        assert parse_footprint(text).shape[1] == 2


def test_radii() -> None:
    inscribed, circumscribed = radii(parse_footprint(SQUARE))
    assert (inscribed, circumscribed) == pytest.approx((0.2, math.hypot(0.2, 0.2)))
    ring = radii(circle(0.17))
    assert ring.circumscribed == pytest.approx(0.17)
    assert ring.inscribed == pytest.approx(0.17 * math.cos(math.pi / 16))
    assert radii(np.array([(1.0, 0.0), (2.0, 1.0), (2.0, -1.0)])).inscribed == 0.0


def test_padding_leads_away_from_both_axes() -> None:
    assert padded(parse_footprint(SQUARE), 0.01)[0].tolist() == pytest.approx([0.21, 0.21])
    assert padded(np.array([(0.0, 1.0)]), 0.1)[0].tolist() == pytest.approx([0.0, 1.1])


def test_inside() -> None:
    square = parse_footprint(SQUARE)
    assert contains(square, np.array([(0.0, 0.0), (0.19, -0.19), (0.21, 0.0), (0.0, -0.3)])).tolist() == [1, 1, 0, 0]


@given(st.floats(-math.pi, math.pi), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_no_obstacle_under_the_footprint_is_missed(theta: float, x: float, y: float) -> None:
    outline = parse_footprint("[[0.3, 0.1], [0.3, -0.1], [-0.2, -0.15], [-0.2, 0.15]]")
    cells = np.zeros((60, 60), np.uint8)
    costs = Grid(cells, 0.05, (-1.5, -1.5, 0.0))
    rows, columns = np.mgrid[:60, :60]
    px, py = costs.cell_to_world(rows.ravel(), columns.ravel())
    dx, dy = px - x, py - y
    local = np.column_stack((dx * math.cos(theta) + dy * math.sin(theta), dy * math.cos(theta) - dx * math.sin(theta)))
    points, poses = cover(outline, 0.033), np.array([(x, y, theta)])
    for index in np.flatnonzero(contains(outline, local)):
        cells.ravel()[index] = 200
        assert highest_costs(costs, points, poses).tolist() == [200]
        cells.ravel()[index] = 0


def test_what_is_unknown_or_outside_collides() -> None:
    cells = np.full((20, 20), 7, np.uint8)
    costs, points = Grid(cells, 0.05), cover(circle(0.1), 0.05)
    poses = np.array([(0.5, 0.5, 0.0), (0.05, 0.5, 0.0)])
    assert highest_costs(costs, points, poses).tolist() == [7, LETHAL]
    assert highest_costs(costs, points, poses, outside=0).tolist() == [7, 7]
    cells[10, 10] = UNKNOWN
    assert highest_costs(costs, points, poses).tolist() == [LETHAL, LETHAL]
