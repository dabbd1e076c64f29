"""The controllers: what they decide for a scan, and how they drive in a world, without any transport."""

from __future__ import annotations

import math
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Header
from robolink.sim import Pose
from tests.drives import Drive, Follower, Reactive, follower, reactive, world
from tests.nodefiles import load_node_file
from tests.scans import ring, sector

teleop = load_node_file("teleop")


def steer(scan: LaserScan, side: int = 0, **settings: Any) -> Any:
    return reactive.steer(scan, reactive.Settings(**settings), reactive.Memory(side))


def follow(scan: LaserScan, memory: Any = None, **goal: Any) -> Any:
    return follower.follow(scan, follower.Goal(**goal), memory or follower.Memory())


def at(scan: LaserScan, seconds: float) -> LaserScan:
    """The scan with a stamp."""
    scan.header = Header(stamp=Time(sec=int(seconds), nanosec=round(seconds % 1 * 1e9)))
    return scan


NOTHING = [ring(*[math.inf] * 360), ring(0.0, 0.05, 11.0, -1.0), ring(*[math.inf, math.nan] * 50)]
BLIND = [ring(), ring(*[math.nan] * 90), sector(30, 150), sector(-30, -150), ring(1.0, start=math.nan)]


# The reactive controller


@pytest.mark.parametrize("scan", NOTHING)
def test_with_nothing_in_reach_it_drives_ahead(scan: LaserScan) -> None:
    twist, memory, words = steer(scan, speed=0.4)
    assert (twist.linear.x, twist.angular.z, memory.side) == (0.4, 0.0, 0)
    assert words == "driving ahead, all free"


def test_it_turns_away_from_what_is_near_and_stops_at_the_stop_distance() -> None:
    ranges = [5.0] * 360
    ranges[182:190] = [0.8] * 8  # a little to the left
    twist, memory, words = steer(ring(*ranges), stop_distance=0.5)
    assert 0.0 < twist.linear.x < 0.4
    assert twist.angular.z < 0.0
    assert (memory.side, words) == (-1, "turning right, something 0.8 m ahead")
    ranges[182:190] = [0.45] * 8
    twist = steer(ring(*ranges), stop_distance=0.5, turn_speed=0.7).twist
    assert (twist.linear.x, twist.angular.z) == (0.0, -0.7)


def test_it_goes_on_turning_to_the_side_that_it_has_chosen_until_the_lane_is_free() -> None:
    ranges = [5.0] * 360
    ranges[182:190] = [0.8] * 8
    assert steer(ring(*ranges), side=1).memory.side == 1
    assert steer(ring(*[5.0] * 360), side=1).memory.side == 0


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
    often, seldom = (
        reactive.steer(at(ring(*ranges), 10.0), reactive.Settings(), reactive.Memory(1, 10.0 - dt)).twist
        for dt in (0.1, 1.0)
    )
    assert often.linear.x == 0.4
    assert 0.0 < seldom.linear.x < 0.4
    ranges[180] = 0.3
    often, seldom = (
        reactive.steer(at(ring(*ranges), 10.0), reactive.Settings(), reactive.Memory(1, 10.0 - dt)).twist
        for dt in (0.1, 1.0)
    )
    assert (often.angular.z, seldom.angular.z) == (1.0, pytest.approx(0.6))


CORNERS = {"corners": Pose(6.5, 0.5, -0.8), "empty_room": Pose(5.7, 5.7, 0.8), "obstacles": Pose(9.5, 7.5, 0.8)}


@pytest.mark.parametrize(("name", "pose"), CORNERS.items())
def test_wandering_comes_out_of_corners(name: str, pose: Pose) -> None:
    drive = Drive(world(name, pose), Reactive(), 60.0)
    assert drive.robot.contacts == 0
    assert drive.driven() > 8.0


# The wall follower


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
@settings(max_examples=50, deadline=None)
def test_the_left_is_the_mirror_image_of_the_right(centimetres: list[int]) -> None:
    ranges = [each / 100 for each in centimetres]
    step = 6.0 / (len(ranges) - 1)
    scans = [
        LaserScan(angle_min=-3.0, angle_increment=step, range_min=0.1, range_max=10.0, ranges=each)
        for each in (ranges, ranges[::-1])
    ]
    right, left = follow(scans[0], side="right").twist, follow(scans[1], side="left").twist
    assert (left.linear.x, left.angular.z) == pytest.approx((right.linear.x, -right.angular.z), abs=1e-6)


@pytest.mark.parametrize("side", ["right", "left"])
def test_it_goes_round_the_cornered_room_at_half_a_metre(side: str) -> None:
    drive = Drive(world("corners"), Follower(side=side), 120.0)
    assert drive.robot.contacts == 0
    assert drive.rms(0.5, after=30.0) < 0.05
    assert (drive.laps() if side == "right" else -drive.laps()) >= 1.0


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
    scan, memory = sector(-45, 45), follower.Memory("right", 0.0, 0.3, 0.0)
    seen = follower.Points(*(np.array([each]) for each in (0.03, -0.5, 0.0)))
    decision = follow(at(scan, 0.1), memory._replace(near=seen))
    assert decision.words == "following the wall on the right at 0.51 m"
    assert decision.memory.near.x[0] == pytest.approx(0.0)
    assert decision.memory.near.ago[0] == pytest.approx(0.03)
    gone = seen._replace(ago=np.array([1.3]))
    assert follow(at(scan, 0.1), memory._replace(near=gone)).words == "no wall in reach: driving ahead"
    assert (
        follow(at(ring(*[math.inf] * 360), 0.1), memory._replace(near=seen)).words == "no wall in reach: driving ahead"
    )


def test_what_is_remembered_turns_with_the_robot() -> None:
    seen = follower.Points(*(np.array([each]) for each in (0.0, -0.5, 0.0)))
    for turn in (1.5, -1.5):
        memory = follower.Memory("right", 0.0, 0.0, turn, seen)
        near = follower.remembered(memory, 0.2)
        assert math.degrees(math.atan2(near.y[0], near.x[0])) == pytest.approx(-90 - math.degrees(turn * 0.2))


@pytest.mark.parametrize(
    ("before", "scan_time", "dt"),
    [
        (9.9, 0.5, 0.1),
        (10.0, 0.5, 0.5),
        (math.nan, 0.5, 0.5),
        (11.0, 0.5, 0.0),
        (2.0, 0.5, 0.0),
        (10.0, 0.0, 0.0),
        (10.0, math.nan, 0.0),
        (10.0, -1.0, 0.0),
        (10.0, math.inf, 0.0),
    ],
)
def test_time_goes_by_the_stamps(before: float, scan_time: float, dt: float) -> None:
    scan = at(ring(1.0), 10.0)
    scan.scan_time = scan_time
    assert follower.seconds_since(before, scan) == pytest.approx(dt)
    assert reactive.seconds_between(before, 10.0, scan_time) == pytest.approx(dt)


def test_what_was_remembered_of_one_side_is_nothing_to_the_other() -> None:
    seen = follower.Points(*(np.array([each]) for each in (0.0, -0.5, 0.0)))
    memory = follower.Memory("right", 0.0, 0.3, 0.0, seen)
    assert follow(at(sector(-45, 45), 0.1), memory, side="left").words == "no wall in reach: driving ahead"


def test_it_gains_speed_gently_and_is_slower_when_scans_come_seldom() -> None:
    scan = ring(*[math.inf] * 360)
    assert follow(at(scan, 0.1), follower.Memory("right", 0.0, 0.1, 0.0)).twist.linear.x == pytest.approx(0.2)
    assert follow(at(scan, 1.0), follower.Memory("right", 0.0, 0.3, 0.0)).twist.linear.x == pytest.approx(0.125)


@pytest.mark.parametrize("pose", [Pose(0.4, 0.4, 2.0), Pose(3.0, 4.5, -3.0), Pose(2.0, 3.2, 0.0), Pose(6.6, 3.1, 1.0)])
def test_it_finds_a_wall_from_anywhere(pose: Pose) -> None:
    drive = Drive(world("corners", pose), Follower(distance=0.4), 60.0)
    assert drive.robot.contacts == 0
    assert drive.rms(0.4, after=30.0) < 0.05


def test_it_makes_up_its_mind_between_walls_that_are_equally_far() -> None:
    assert Drive(world("empty_room"), Follower(), 40.0).rms(0.5, after=30.0) < 0.05


# Both


@pytest.mark.parametrize("scan", BLIND)
def test_a_scan_that_does_not_look_ahead_makes_them_stand_still(scan: LaserScan) -> None:
    for decision in (steer(scan), follow(scan)):
        assert decision.twist == Twist()
        assert decision.words == "no beam looks ahead: standing still"


@pytest.mark.parametrize("beams", [10, 3600])
@pytest.mark.parametrize("clockwise", [False, True])
def test_any_number_of_beams_in_any_order_shows_what_is_ahead(beams: int, clockwise: bool) -> None:
    scan = sector(*((60.0, -60.0) if clockwise else (-60.0, 60.0)), beams=beams + 1, distance=0.3)
    assert steer(scan).twist.linear.x == follow(scan).twist.linear.x == 0.0


@given(
    st.lists(st.floats(width=32), max_size=50),
    st.floats(-10, 10),
    st.floats(-1, 1),
    st.floats(0, 1),
    st.floats(0, 20),
    st.sampled_from(["left", "right"]),
)
@settings(deadline=None)
def test_no_scan_brings_a_controller_out_of_its_limits(
    ranges: list[float], start: float, step: float, low: float, high: float, side: str
) -> None:
    scan = LaserScan(angle_min=start, angle_increment=step, range_min=low, range_max=high, ranges=ranges)
    decision = follow(scan, side=side)
    again = follow(at(scan, 0.1), decision.memory._replace(stamp=0.0), side=side)
    for twist, speed, turn in ((steer(scan).twist, 0.4, 1.0), (decision.twist, 0.3, 1.5), (again.twist, 0.3, 1.5)):
        assert 0.0 <= twist.linear.x <= speed
        assert abs(twist.angular.z) <= turn


# Teleop


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("wI ", ["w", "i", " "]),
        ("\x1b[A\x1bOBa", ["up", "down", "a"]),
        ("\xe0H\x00M", ["up", "right"]),
        ("\x1b[1;2D\x1b[3~\x1b[15~j", ["left", "", "", "j"]),
        ("\x1b", ["\x1b"]),
        ("", []),
    ],
)
def test_keys_are_what_terminals_send(text: str, expected: list[str]) -> None:
    assert teleop.keys(text) == expected


@given(st.text())
def test_no_typing_is_too_much(text: str) -> None:
    assert len(teleop.keys(text)) <= len(text)


VELOCITIES = {"w": (0.3, 0), "down": (-0.3, 0), "j": (0, 1), "right": (0, -1), "u": (0.3, 1), "k": (0, 0)}


@pytest.mark.parametrize(("key", "expected"), VELOCITIES.items())
def test_a_key_asks_for_a_velocity(key: str, expected: tuple[float, float]) -> None:
    twist = teleop.wanted(key, teleop.Speeds())
    assert (twist.linear.x, twist.angular.z) == expected


def test_other_keys_ask_for_nothing_and_q_and_z_change_the_speeds() -> None:
    assert [teleop.wanted(key, teleop.Speeds()) for key in ("", "1", "q", "\x1b")] == [None] * 4
    faster = teleop.changed(teleop.Speeds(0.2, 1.0), "q")
    assert faster == pytest.approx((0.22, 1.1))
    assert teleop.changed(faster, "z") == pytest.approx((0.2, 1.0))


def test_without_a_terminal_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    with Path(os.devnull).open() as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        with pytest.raises(teleop.NoTerminalError, match="reads keys from a terminal"):
            teleop.open_keyboard()
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(OSError, match="reads keys from a terminal"):
        teleop.open_keyboard()


if sys.platform != "win32":
    import pty
    import termios

    def test_a_terminal_gives_keys_at_once_and_is_given_back() -> None:
        controller, terminal = pty.openpty()
        try:
            found = termios.tcgetattr(terminal)
            keyboard = teleop.PosixKeyboard(terminal)
            assert not termios.tcgetattr(terminal)[3] & (termios.ECHO | termios.ICANON)
            assert keyboard.read() == ""
            os.write(controller, b"w\x1b[A")
            assert keyboard.read() == "w\x1b[A"
            keyboard.close()
            assert termios.tcgetattr(terminal) == found
        finally:
            os.close(controller)
            os.close(terminal)
        keyboard.close()  # the terminal is gone: nothing to give back
