"""Poses in the plane: placed on each other and seen from each other, read from messages, and limited."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.geometry.plane import Area, Pose, clipped, placed_on, pose_of, seen_from, wrapped
from robolink.interfaces.geometry_msgs.msg import Point, Quaternion
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage

angles = st.floats(-math.pi, math.pi)
poses = st.builds(Pose, st.floats(-10.0, 10.0), st.floats(-10.0, 10.0), angles)


def test_what_is_ahead_of_a_robot_and_to_its_left() -> None:
    robot = Pose(1.0, 2.0, math.pi / 2)
    assert placed_on(robot, Pose(3.0, 1.0, 0.5)) == pytest.approx((0.0, 5.0, math.pi / 2 + 0.5))
    assert seen_from(robot, Pose(0.0, 5.0, 0.0)) == pytest.approx((3.0, 1.0, -math.pi / 2))


@given(st.lists(poses, min_size=1))
def test_an_area_holds_what_it_has_grown_by_and_no_more(places: list[Pose]) -> None:
    area = Area(places[0].x, places[0].y, places[0].x, places[0].y)
    for each in places:
        area = area.grown(each.x, each.y)
    xs, ys = [each.x for each in places], [each.y for each in places]
    assert area == (min(xs), min(ys), max(xs), max(ys))
    assert (area.width, area.height) == (max(xs) - min(xs), max(ys) - min(ys))


@given(poses, poses)
def test_placed_and_seen_undo_each_other(base: Pose, pose: Pose) -> None:
    x, y, theta = seen_from(base, placed_on(base, pose))
    assert (x, y) == pytest.approx(pose[:2], abs=1e-9)
    assert wrapped(theta - pose.theta) == pytest.approx(0.0, abs=1e-9)


@given(angles, st.floats(0.1, 10.0))
def test_a_quaternion_of_any_length_is_a_heading(theta: float, length: float) -> None:
    turn = Quaternion(z=length * math.sin(theta / 2), w=length * math.cos(theta / 2))
    pose = PoseMessage(position=Point(x=1.0, y=2.0, z=3.0), orientation=turn)
    assert pose_of(pose)[:2] == (1.0, 2.0)
    assert math.remainder(pose_of(pose).theta - theta, math.tau) == pytest.approx(0.0, abs=1e-9)


@given(st.floats(-1e6, 1e6))
def test_an_angle_is_brought_into_one_turn(angle: float) -> None:
    assert abs(wrapped(angle)) <= math.pi
    assert math.sin(wrapped(angle)) == pytest.approx(math.sin(angle), abs=1e-6)


@pytest.mark.parametrize(("value", "expected"), [(0.5, 0.5), (2.0, 1.0), (-2.0, -1.0), (math.inf, 1.0)])
def test_a_value_is_brought_within_a_limit(value: float, expected: float) -> None:
    assert clipped(value, 1.0) == expected
