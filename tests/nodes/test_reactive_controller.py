"""The reactive controller: what it decides for a scan, and that it comes out of corners, without any transport."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.sim import Pose
from tests.support.closed_loops import Reactive, Run, reactive, world
from tests.support.scans import BLIND, NOTHING, any_scan, ring, sector


def steer(scan: LaserScan, side: int = 0, seconds: float = 0.0, **settings: Any) -> Any:
    return reactive.steer(scan, reactive.Settings(**settings), side, seconds)


@pytest.mark.parametrize("scan", NOTHING)
def test_with_nothing_in_reach_it_drives_ahead(scan: LaserScan) -> None:
    twist, side, words = steer(scan, speed=0.4)
    assert (twist.linear.x, twist.angular.z, side) == (0.4, 0.0, 0)
    assert words == "driving ahead, all free"


def test_it_turns_away_from_what_is_near_and_stops_at_the_stop_distance() -> None:
    ranges = [5.0] * 360
    ranges[182:190] = [0.8] * 8  # a little to the left
    twist, side, words = steer(ring(*ranges), stop_distance=0.5)
    assert 0.0 < twist.linear.x < 0.4
    assert twist.angular.z < 0.0
    assert (side, words) == (-1, "turning right, something 0.8 m ahead")
    ranges[182:190] = [0.45] * 8
    twist = steer(ring(*ranges), stop_distance=0.5, turn_speed=0.7).twist
    assert (twist.linear.x, twist.angular.z) == (0.0, -0.7)


def test_it_goes_on_turning_to_the_side_that_it_has_chosen_until_the_lane_is_free() -> None:
    ranges = [5.0] * 360
    ranges[182:190] = [0.8] * 8
    assert steer(ring(*ranges), side=1).side == 1
    assert steer(ring(*[5.0] * 360), side=1).side == 0


def test_what_is_beside_the_lane_does_not_turn_it() -> None:
    ranges = [5.0] * 360
    ranges[90] = ranges[270] = 0.3
    assert steer(ring(*ranges)).twist.angular.z == 0.0


def test_nearer_than_the_lidar_can_measure_is_near() -> None:
    ranges = [5.0] * 360
    ranges[180] = -math.inf
    assert steer(ring(*ranges)).twist.linear.x == 0.0


def test_when_scans_come_seldom_it_slows_down_earlier_and_turns_slower() -> None:
    ranges = [5.0] * 360
    ranges[180] = 1.2
    often, seldom = (steer(ring(*ranges), 1, seconds).twist for seconds in (0.1, 1.0))
    assert often.linear.x == 0.4
    assert 0.0 < seldom.linear.x < 0.4
    ranges[180] = 0.3
    often, seldom = (steer(ring(*ranges), 1, seconds).twist for seconds in (0.1, 1.0))
    assert (often.angular.z, seldom.angular.z) == (1.0, pytest.approx(0.6))


CORNERS = {"corners": Pose(6.5, 0.5, -0.8), "empty_room": Pose(5.7, 5.7, 0.8), "obstacles": Pose(9.5, 7.5, 0.8)}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "pose"), CORNERS.items())
def test_wandering_comes_out_of_corners(name: str, pose: Pose) -> None:
    run = Run(world(name, pose), Reactive(), 60.0)
    assert run.robot.contacts == 0
    assert run.driven() > 8.0


@pytest.mark.parametrize("scan", BLIND)
def test_a_scan_that_does_not_look_ahead_makes_it_stand_still(scan: LaserScan) -> None:
    decision = steer(scan)
    assert decision.twist == Twist()
    assert decision.words == "no beam looks ahead: standing still"


@pytest.mark.parametrize("beams", [10, 3600])
@pytest.mark.parametrize("ends", [(-60.0, 60.0), (60.0, -60.0)])
def test_any_number_of_beams_in_any_order_shows_what_is_ahead(beams: int, ends: tuple[float, float]) -> None:
    scan = sector(*ends, beams=beams + 1, distance=0.3)
    assert steer(scan).twist.linear.x == 0.0


@given(any_scan(), st.sampled_from([-1, 0, 1]), st.sampled_from([0.0, 0.1, 2.0]))
def test_no_scan_brings_it_out_of_its_limits(scan: LaserScan, side: int, seconds: float) -> None:
    twist = steer(scan, side, seconds).twist
    assert 0.0 <= twist.linear.x <= 0.4
    assert abs(twist.angular.z) <= 1.0
