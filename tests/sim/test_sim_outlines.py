"""Outlines: which are degenerate, and how any other is cut into convex parts."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from robolink.sim.checks.shapes import has_area, in_line, meeting, repeated
from robolink.sim.description import signed_area
from robolink.sim.physics.convex import convex_parts
from robolink.sim.quantities import Point

GRID = st.tuples(st.integers(0, 5), st.integers(0, 5)).map(lambda each: (float(each[0]), float(each[1])))
POLYGONS = st.lists(GRID, min_size=3, max_size=8, unique=True)


def side(a: Point, b: Point, c: Point) -> int:
    (ax, ay), (bx, by), (cx, cy) = (tuple(map(Fraction, each)) for each in (a, b, c))
    cross = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (cross > 0) - (cross < 0)


def on(a: Point, b: Point, c: Point) -> bool:
    return side(a, b, c) == 0 and min(a, b) <= c <= max(a, b)


def crosses_itself(polygon: list[Point]) -> bool:
    """The textbook's way, edge by edge, in exact numbers."""
    edges = list(zip(polygon, [*polygon[1:], polygon[0]], strict=True))
    for i, (a, b) in enumerate(edges):
        for j, (c, d) in enumerate(edges[:i]):
            if i - j == 1 or i - j == len(edges) - 1:
                far = (d, b) if i - j == 1 else (c, a)
                other = a if i - j == 1 else b
                first, last = (c, b) if i - j == 1 else (d, a)
                assert far is not None
                if side(first, other, last) == 0 and (on(other, last, first) or on(other, first, last)):
                    return True
            elif any((on(a, b, c), on(a, b, d), on(c, d, a), on(c, d, b))) or (
                side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0
            ):
                return True
    return False


@given(POLYGONS)
@example([(0.0, 0.0), (2.0, 0.0), (1.0, 0.0), (1.0, 1.0)])
@example([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])
def test_edges_that_meet_are_found_and_no_others(polygon: list[Point]) -> None:
    assert (meeting(polygon) is not None) == crosses_itself(polygon)


def test_the_edges_that_meet_are_named() -> None:
    assert meeting([(0, 0), (2, 2), (2, 0), (0, 2)]) == (0, 2)
    assert meeting([(0, 0), (2, 0), (2, 2), (0, 2)]) is None


def test_what_encloses_nothing_is_noticed() -> None:
    assert in_line([(0, 0), (1, 1), (3, 3)])
    assert not in_line([(0, 0), (1, 1), (3, 3.01)])
    assert has_area([(0, 0), (0, 0.002), (0.002, 0)])
    assert not has_area([(0, 0), (0, 0.001), (0.001, 0)])


def test_points_that_repeat_are_found() -> None:
    assert list(repeated([(0, 0), (0, 0), (1, 0), (1, 1e-9), (0, 0)], closed=False)) == [1, 3]
    assert list(repeated([(0, 0), (1, 0), (1, 1), (0, 0)], closed=True)) == [3]


@given(POLYGONS)
def test_any_polygon_is_cut_into_convex_parts(polygon: list[Point]) -> None:
    assume(not crosses_itself(polygon) and signed_area(polygon) != 0.0)
    corners = polygon if signed_area(polygon) > 0.0 else polygon[::-1]
    parts = convex_parts(corners)
    assert sum(map(signed_area, parts)) == pytest.approx(signed_area(corners))
    for part in parts:
        turns = zip(part, part[1:] + part[:1], part[2:] + part[:2], strict=True)
        assert all(side(*each) >= 0 for each in turns)


def test_parts_are_joined_where_they_can_be() -> None:
    assert len(convex_parts([(0, 0), (3, 0), (3, 1), (1, 1), (1, 3), (0, 3)])) == 2
    star = [(math.cos(k * math.pi / 50) * (1 + k % 2), math.sin(k * math.pi / 50) * (1 + k % 2)) for k in range(100)]
    assert len(convex_parts(star)) <= 51


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), min_size=3, max_size=9))
def test_no_corners_at_all_end_the_process(corners: list[Point]) -> None:
    assert len(convex_parts(corners)) < len(corners)


def test_a_line_is_no_part() -> None:
    assert convex_parts([(0, 0), (1, 0), (2, 0), (1, 1e-13), (0.5, -1e-13)]) == []
