"""Canvas of turtlesim: which pixels a pen colours, what the colour sensor sees, and where turtles are drawn."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.counterparts.turtlesim.picture import BACKGROUND, SHELLS, Canvas, Drawn
from robolink.counterparts.turtlesim.turtle import METRE, SIZE, Line, Pen, Point

RED = Pen(255, 0, 0, 3)
coordinates = st.floats(width=32, allow_nan=False, allow_infinity=False)


def coloured(canvas: Canvas) -> set[tuple[int, int]]:
    """Columns and rows of the pixels that are not background."""
    rows, columns = np.nonzero((canvas.picture([]) != canvas.background).any(axis=2))
    return set(zip(columns.tolist(), rows.tolist(), strict=True))


def test_a_line_is_as_wide_as_its_pen_and_has_round_ends() -> None:
    canvas = Canvas()
    canvas.draw([Line((100 / METRE, SIZE), (110 / METRE, SIZE), Pen(width=1))])
    assert coloured(canvas) == {(column, 0) for column in range(100, 111)}
    canvas.clear()
    canvas.draw([Line((100 / METRE, SIZE - 50 / METRE), (120 / METRE, SIZE - 50 / METRE), RED)])
    assert coloured(canvas) == {(x, y) for x in range(99, 122) for y in (49, 50, 51)}


def test_the_colour_is_that_of_the_newest_line_or_the_background() -> None:
    canvas = Canvas()
    assert canvas.colour_at(2.0, 2.0) == BACKGROUND == (69, 86, 255)
    canvas.draw([Line((2.0, 2.0), (3.0, 3.0), RED), Line((3.0, 2.0), (2.0, 3.0), Pen(0, 255, 0))])
    assert [canvas.colour_at(*place) for place in ((2.0, 2.0), (2.5, 2.5), (2.0, 3.0))] == [
        (255, 0, 0),
        (0, 255, 0),
        (0, 255, 0),
    ]
    canvas.background = (1, 2, 3)
    assert [canvas.colour_at(2.0, 2.0), canvas.colour_at(9.0, 9.0)] == [(255, 0, 0), (1, 2, 3)]
    canvas.clear()
    assert (canvas.colour_at(2.0, 2.0), coloured(canvas)) == ((1, 2, 3), set())


@pytest.mark.parametrize("place", [(0.0, 0.0), (SIZE, SIZE), (0.0, SIZE), (-5.0, 100.0)])
def test_there_is_a_colour_at_every_place(place: Point) -> None:
    assert Canvas().colour_at(*place) == BACKGROUND


@given(coordinates, coordinates, coordinates, coordinates, st.integers(2, 255))
def test_any_line_can_be_drawn(x: float, y: float, to_x: float, to_y: float, width: int) -> None:
    canvas = Canvas()
    canvas.draw([Line((x, y), (to_x, to_y), Pen(255, 0, 0, width))])
    inside = all(0.0 <= each <= SIZE for each in (x, y))
    assert not inside or canvas.colour_at(x, y) == (255, 0, 0)


@pytest.mark.parametrize("theta", [0.0, 1.2, math.pi, -2.0])
def test_a_turtle_is_at_its_place_and_looks_ahead(theta: float) -> None:
    canvas = Canvas()
    picture = canvas.picture([Drawn(3.0, 4.0, theta, shell=2)])
    rows, columns = np.nonzero((picture != BACKGROUND).any(axis=2))
    assert (columns.mean() / METRE, SIZE - rows.mean() / METRE) == pytest.approx((3.0, 4.0), abs=0.1)
    assert len(rows) > 500
    ahead = [3.0 + 0.36 * math.cos(theta), 4.0 + 0.36 * math.sin(theta)]  # its head has the colour of skin
    r, g, b = picture[round((SIZE - ahead[1]) * METRE), round(ahead[0] * METRE)].tolist()
    assert g > r > b
    assert coloured(canvas) == set(), "the canvas has lines only"


@pytest.mark.parametrize("place", [(0.0, 0.0), (SIZE, SIZE), (0.0, SIZE), (SIZE, 0.3)])
def test_at_the_border_a_part_of_the_turtle_is_seen(place: Point) -> None:
    picture = Canvas().picture([Drawn(*place, theta=0.0, shell=len(SHELLS) + 3)])
    assert 100 < (picture != BACKGROUND).any(axis=2).sum() < 1200
