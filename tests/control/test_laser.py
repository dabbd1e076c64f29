"""What a scan tells: returns by angle, where it looks, and how far the lane ahead is free."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.control.laser import in_view, lane_ahead, looks_ahead, points, returns, seconds_between
from robolink.interfaces.sensor_msgs.msg import LaserScan
from tests.support.scans import at, ring, sector


def test_returns_are_what_a_beam_has_met() -> None:
    angles, ranges = returns(ring(1.0, math.inf, math.nan, -math.inf, 0.05, 10.0, 10.1, 0.1))
    assert ranges.tolist() == pytest.approx([1.0, 0.1, 10.0, 0.1])
    assert np.degrees(angles).tolist() == pytest.approx([-180, -45, 45, 135])


@pytest.mark.parametrize(("start", "left"), [(0.0, 1), (-math.pi, 3), (math.pi / 2, 0), (6.5 * math.pi, 0)])
def test_returns_go_by_angle_wherever_the_first_beam_points(start: float, left: int) -> None:
    angles, ranges = returns(ring(*(1.0 + i for i in range(4)), start=start))
    assert angles[left] == pytest.approx(math.pi / 2)
    assert ranges[left] == 1.0 + left


BOTH_SIDES = np.radians([-170.0, -90.0, 0.0, 90.0, 170.0])


@pytest.mark.parametrize(
    ("scan", "seen"),
    [
        (ring(*[1.0] * 360), [True] * 5),
        (ring(*[1.0] * 10, start=1.0), [True] * 5),
        (sector(-90, 90), [False, True, True, True, False]),
        (sector(90, -90), [False, True, True, True, False]),
        (sector(80, 280), [True, True, False, True, True]),
        (sector(-10, 10, beams=2), [False, False, True, False, False]),
        (ring(), [False] * 5),
        (ring(*[math.nan] * 360), [False] * 5),
        (ring(1.0, 1.0, start=math.inf), [False] * 5),
    ],
)
def test_a_scan_looks_where_its_beams_point(scan: LaserScan, seen: list[bool]) -> None:
    assert in_view(scan, BOTH_SIDES).tolist() == seen


def test_clockwise_beams_are_found_at_their_angles() -> None:
    scan = sector(90, -90, beams=3)
    scan.ranges = [1.0, 2.0, 3.0]
    angles, ranges = returns(scan)
    assert np.degrees(angles).tolist() == pytest.approx([90, 0, -90], abs=1e-4)
    assert lane_ahead(angles, ranges, 0.2) == 2.0


@given(
    st.floats(width=32),
    st.floats(width=32),
    st.lists(st.floats(width=32), max_size=20),
    st.floats(width=32),
    st.floats(width=32),
)
def test_no_scan_is_too_odd_to_be_read(start: float, step: float, ranges: list[float], low: float, high: float) -> None:
    scan = LaserScan(angle_min=start, angle_increment=step, range_min=low, range_max=high, ranges=ranges)
    angles, found = returns(scan)
    assert np.isfinite(angles).all()
    assert (np.isfinite(found) & (found > 0.0)).all()
    assert in_view(scan, np.zeros(1)).tolist() == [looks_ahead(scan)]
    ahead, aside = points(scan)
    assert (ahead.tolist(), aside.tolist()) == ((found * np.cos(angles)).tolist(), (found * np.sin(angles)).tolist())


@pytest.mark.parametrize(
    ("before", "scan_time", "dt"),
    [
        (9.9, 0.5, 0.1),
        (10.0, 0.5, 0.5),
        (None, 0.5, 0.5),
        (11.0, 0.5, 0.0),
        (2.0, 0.5, 0.0),
        (10.0, 0.0, 0.0),
        (10.0, math.nan, 0.0),
        (10.0, -1.0, 0.0),
        (None, math.inf, 0.0),
    ],
)
def test_time_goes_by_the_stamps_or_else_by_the_scan_time(before: float | None, scan_time: float, dt: float) -> None:
    later = at(ring(1.0), 10.0)
    later.scan_time = scan_time
    assert seconds_between(None if before is None else at(ring(1.0), before), later) == pytest.approx(dt)
