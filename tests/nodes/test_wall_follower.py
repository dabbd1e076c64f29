"""The wall follower: what it decides for a scan, and how it drives in a world, without any transport."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.sim import Pose
from tests.support.closed_loops import Follower, Run, follower, world
from tests.support.scans import BLIND, NOTHING, any_scan, ring, sector


def follow(scan: LaserScan, memory: Any = None, seconds: float = 0.0, **goal: Any) -> Any:
    return follower.follow(scan, follower.Goal(**goal), memory or follower.Memory(), seconds)


@pytest.mark.parametrize("scan", NOTHING)
def test_with_no_wall_in_reach_it_drives_ahead(scan: LaserScan) -> None:
    twist, _, words = follow(scan, speed=0.3)
    assert (twist.linear.x, twist.angular.z) == (pytest.approx(0.3), 0.0)
    assert words == "no wall in reach: driving ahead"


@pytest.mark.parametrize(("gap", "turn"), [(0.5, 0.0), (0.4, 1.0), (0.6, -1.0)])
def test_it_turns_to_its_distance(gap: float, turn: float) -> None:
    ranges = [math.inf] * 360
    ranges[90] = gap  # on the right
    twist, _, words = follow(ring(*ranges))
    assert np.sign(round(twist.angular.z, 6)) == turn
    assert twist.linear.x == pytest.approx(0.3, abs=0.02)
    assert words == f"following the wall on the right at {gap:.2f} m"


def test_it_goes_to_a_wall_when_none_is_near() -> None:
    ranges = [math.inf] * 360
    ranges[210] = 3.0
    twist, _, words = follow(ring(*ranges))
    assert twist.angular.z > 0.0
    assert words == "driving to a wall 3.0 m away"


def test_it_turns_before_what_is_in_front() -> None:
    ranges = [math.inf] * 360
    ranges[90], ranges[180] = 0.5, 0.4
    twist, _, words = follow(ring(*ranges))
    assert twist.linear.x == pytest.approx(0.0)
    assert twist.angular.z == 1.5
    assert words == "turning left, 0.4 m free ahead"


@given(st.lists(st.integers(20, 900), min_size=8, max_size=40, unique=True))
def test_the_left_is_the_mirror_image_of_the_right(centimetres: list[int]) -> None:
    ranges = [each / 100 for each in centimetres]
    step = 6.0 / (len(ranges) - 1)
    scans = [
        LaserScan(angle_min=-3.0, angle_increment=step, range_min=0.1, range_max=10.0, ranges=each)
        for each in (ranges, ranges[::-1])
    ]
    right, left = follow(scans[0], side="right").twist, follow(scans[1], side="left").twist
    assert (left.linear.x, left.angular.z) == pytest.approx((right.linear.x, -right.angular.z), abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("side", ["right", "left"])
def test_it_goes_round_the_cornered_room_at_half_a_metre(side: str) -> None:
    run = Run(world("corners"), Follower(side=side), 120.0)
    assert run.robot.contacts == 0
    assert run.rms(0.5, after=30.0) < 0.05
    assert (run.laps() if side == "right" else -run.laps()) >= 1.0


def test_it_turns_to_the_middle_of_a_passage_that_is_too_narrow() -> None:
    ranges = [math.inf] * 360
    ranges[90], ranges[270] = 0.4, 0.4
    twist = follow(ring(*ranges)).twist
    assert (twist.linear.x, twist.angular.z) == (pytest.approx(0.3), pytest.approx(0.0))
    ranges[270] = 0.3
    assert follow(ring(*ranges)).twist.angular.z < 0.0


def test_it_keeps_no_nearer_than_the_robot_is_wide() -> None:
    ranges = [math.inf] * 360
    ranges[90] = 0.45
    assert follow(ring(*ranges), distance=0.1, robot_radius=0.4).twist.angular.z == pytest.approx(0.0, abs=1e-6)


def test_what_has_left_the_view_is_remembered_for_a_short_way_and_moves_with_the_robot() -> None:
    scan, memory = sector(-45, 45), follower.Memory("right", 0.3, 0.0)
    seen = follower.Points(*(np.array([each]) for each in (0.03, -0.5, 0.0)))
    decision = follow(scan, memory._replace(near=seen), 0.1)
    assert decision.words == "following the wall on the right at 0.51 m"
    assert decision.memory.near.x[0] == pytest.approx(0.0)
    assert decision.memory.near.ago[0] == pytest.approx(0.03)
    gone = seen._replace(ago=np.array([1.3]))
    assert follow(scan, memory._replace(near=gone), 0.1).words == "no wall in reach: driving ahead"
    assert follow(ring(*[math.inf] * 360), memory._replace(near=seen), 0.1).words == "no wall in reach: driving ahead"


def test_what_is_remembered_turns_with_the_robot() -> None:
    seen = follower.Points(*(np.array([each]) for each in (0.0, -0.5, 0.0)))
    for turn in (1.5, -1.5):
        memory = follower.Memory("right", 0.0, turn, seen)
        near = follower.remembered(memory, 0.2)
        assert math.degrees(math.atan2(near.y[0], near.x[0])) == pytest.approx(-90 - math.degrees(turn * 0.2))


def test_what_was_remembered_of_one_side_is_nothing_to_the_other() -> None:
    seen = follower.Points(*(np.array([each]) for each in (0.0, -0.5, 0.0)))
    memory = follower.Memory("right", 0.3, 0.0, seen)
    assert follow(sector(-45, 45), memory, 0.1, side="left").words == "no wall in reach: driving ahead"


def test_it_gains_speed_gently_and_is_slower_when_scans_come_seldom() -> None:
    scan = ring(*[math.inf] * 360)
    assert follow(scan, follower.Memory("right", 0.1, 0.0), 0.1).twist.linear.x == pytest.approx(0.2)
    assert follow(scan, follower.Memory("right", 0.3, 0.0), 1.0).twist.linear.x == pytest.approx(0.125)


@pytest.mark.slow
@pytest.mark.parametrize("pose", [Pose(0.4, 0.4, 2.0), Pose(3.0, 4.5, -3.0), Pose(2.0, 3.2, 0.0), Pose(6.6, 3.1, 1.0)])
def test_it_finds_a_wall_from_anywhere(pose: Pose) -> None:
    run = Run(world("corners", pose), Follower(distance=0.4), 60.0)
    assert run.robot.contacts == 0
    assert run.rms(0.4, after=30.0) < 0.05


@pytest.mark.slow
def test_it_makes_up_its_mind_between_walls_that_are_equally_far() -> None:
    assert Run(world("empty_room"), Follower(), 40.0).rms(0.5, after=30.0) < 0.05


@pytest.mark.parametrize("scan", BLIND)
def test_a_scan_that_does_not_look_ahead_makes_it_stand_still(scan: LaserScan) -> None:
    decision = follow(scan)
    assert decision.twist == Twist()
    assert decision.words == "no beam looks ahead: standing still"


@pytest.mark.parametrize("beams", [10, 3600])
@pytest.mark.parametrize("ends", [(-60.0, 60.0), (60.0, -60.0)])
def test_any_number_of_beams_in_any_order_shows_what_is_ahead(beams: int, ends: tuple[float, float]) -> None:
    scan = sector(*ends, beams=beams + 1, distance=0.3)
    assert follow(scan).twist.linear.x == 0.0


@given(any_scan(), st.sampled_from(["left", "right"]))
def test_no_scan_brings_it_out_of_its_limits(scan: LaserScan, side: str) -> None:
    decision = follow(scan, side=side)
    for twist in (decision.twist, follow(scan, decision.memory, 0.1, side=side).twist):
        assert 0.0 <= twist.linear.x <= 0.3
        assert abs(twist.angular.z) <= 1.5
