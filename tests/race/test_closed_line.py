"""Progress along a closed line: laps, ways back, cut corners and jumps, against values computed by hand."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.race.courses import ClosedLine, Progress

SQUARE = ClosedLine([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])


def driven(points: list[tuple[float, float]], nearest: float = 0.0, farthest: float = 0.5) -> float:
    progress = Progress(SQUARE, nearest, farthest)
    for x, y in points:
        progress.see(x, y)
    return progress.metres


def test_nearest_point() -> None:
    assert SQUARE.length == 16.0
    assert SQUARE.nearest(1.0, 0.3) == (1.0, 0.3)
    assert SQUARE.nearest(4.2, 2.0) == pytest.approx((6.0, 0.2))
    assert SQUARE.nearest(-1.0, -1.0)[1] == pytest.approx(math.sqrt(2))


def test_ahead_and_back() -> None:
    assert driven([(0.5 + 0.1 * step, 0.1) for step in range(11)]) == pytest.approx(1.0)
    assert driven([(1.5 - 0.1 * step, 0.1) for step in range(11)]) == pytest.approx(-1.0)


def test_over_the_beginning_of_the_line() -> None:
    assert driven([(0.0, 0.2), (0.0, 0.0), (0.2, 0.0)]) == pytest.approx(0.4)


def test_a_cut_corner_counts_as_the_corner() -> None:
    steps = [(3.0 + 0.05 * step, 0.2 + 0.05 * step) for step in range(13)]
    assert driven([*steps, (3.8, 1.0)], farthest=0.9) == pytest.approx(2.0)


def test_what_is_too_far_or_too_near_does_not_count() -> None:
    line = [(1.0 + 0.1 * step, 1.0) for step in range(11)]
    assert driven(line) == 0.0
    near = [(1.0 + 0.1 * step, 0.1) for step in range(11)]
    assert driven(near, nearest=0.3) == 0.0


def test_a_jump_to_another_side_does_not_count() -> None:
    assert driven([(2.0, 0.0), (2.0, 4.0)]) == 0.0


def test_a_whole_lap() -> None:
    angles = [step * 2 * math.pi / 400 for step in range(401)]
    lap = [(2 + 2 * math.cos(each), 2 + 2 * math.sin(each)) for each in angles]
    assert driven(lap, farthest=0.9) == pytest.approx(16.0)


@given(st.lists(st.tuples(st.floats(-10, 10), st.floats(-10, 10)), max_size=30))
def test_standing_still_and_leaping_gains_little(points: list[tuple[float, float]]) -> None:
    assert abs(driven(points)) <= 1.3 * len(points)
