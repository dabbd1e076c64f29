"""The part of a path ahead: where the robot is along it, and even distances."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.navigation.local_path import ahead, lengths, nearest

CORNER = np.array([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (2.0, 1.0, 3.0)])


def test_lengths() -> None:
    assert lengths(CORNER).tolist() == [0.0, 2.0, 3.0]
    assert lengths(CORNER[:1]).tolist() == [0.0]


def test_part_of_a_path() -> None:
    part = ahead(CORNER, lengths(CORNER), 1.0, 1.5, 0.5)
    assert np.column_stack((part.x, part.y)).tolist() == [[1.0, 0.0], [1.5, 0.0], [2.0, 0.0], [2.0, 0.5]]
    assert part.theta.tolist() == pytest.approx([0.0, 0.0, math.pi / 2, math.pi / 2])
    assert (part.length, part.remaining, part.is_whole) == (1.5, 2.0, False)
    end = ahead(CORNER, lengths(CORNER), 2.8, 1.5, 0.5)
    assert (end.theta[-1], end.is_whole, len(end.x)) == (3.0, True, 2)
    single = ahead(CORNER[:1], lengths(CORNER[:1]), 0.0, 1.5, 0.5)
    assert (single.x.tolist(), single.length) == ([0.0], 0.0)


def test_place_along_a_path_never_goes_back() -> None:
    along = lengths(CORNER)
    assert nearest(CORNER, along, 1.2, 0.3, 0.0, 5.0) == pytest.approx(1.2)
    assert nearest(CORNER, along, 1.2, 0.3, 1.9, 5.0) == pytest.approx(1.9)
    assert nearest(CORNER, along, 9.0, 9.0, 0.0, 9.0) == pytest.approx(3.0)
    assert nearest(CORNER[:1], along[:1], 9.0, 9.0, 0.0, 9.0) == 0.0


@given(
    st.lists(st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(-3, 3)), min_size=1, max_size=8),
    st.floats(0.0, 30.0),
    st.floats(0.1, 5.0),
)
def test_every_part_lies_on_the_path(poses: list[tuple[float, float, float]], start: float, reach: float) -> None:
    path = np.array(poses)
    along = lengths(path)
    start = min(start, float(along[-1]))
    part = ahead(path, along, start, reach, 0.1)
    assert part.length <= reach + 1e-9
    steps = np.hypot(np.diff(part.x), np.diff(part.y))
    assert (steps <= 0.1 + 1e-9).all()
    place = nearest(path, along, float(part.x[0]), float(part.y[0]), start, 0.0)
    assert start <= place <= along[-1] + 1e-9
