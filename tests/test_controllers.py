"""The controllers: what they decide for a scan, and how they drive in a world, without any transport."""

from __future__ import annotations

import itertools
import math
import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.laser import returns
from robolink.sim import Pose, Scan, World, WorldDescription, load_world
from tests.nodefiles import ROOT, load_node_file

reactive, follower, teleop = map(load_node_file, ("reactive_controller", "wall_follower", "teleop"))
Controller = Callable[[LaserScan], Twist]


class Reactive:
    """The reactive controller as its node runs it."""

    side = 0

    def __call__(self, scan: LaserScan) -> Twist:
        decision = reactive.steer(scan, side=self.side)
        self.side = decision.side
        twist: Twist = decision.twist
        return twist


class Follower:
    """The wall follower as its node runs it."""

    def __init__(self, **goal: Any) -> None:
        self.goal, self.integral = follower.Goal(**goal), 0.0

    def __call__(self, scan: LaserScan) -> Twist:
        decision = follower.follow(scan, self.goal, self.integral)
        self.integral = decision.integral
        twist: Twist = decision.twist
        return twist


class Drive:
    """A robot's way through a world under a controller, with a scan each 0.1 s that takes a step to arrive."""

    def __init__(self, description: WorldDescription, controller: Controller, seconds: float) -> None:
        world = World(description)
        (self.robot,) = world.robots.values()
        self.gaps, self.path = list[float](), list[Pose]()
        for _ in range(round(seconds * 10)):
            twist = controller(message(self.robot.scan()))
            world.step()
            self.robot.command(twist.linear.x, twist.angular.z)
            for _ in range(9):
                world.step()
            self.path.append(self.robot.pose)
            self.gaps.append(world.nearest_wall_distance(self.robot.pose.x, self.robot.pose.y))

    def driven(self) -> float:
        """The length of the way in metres."""
        return sum(math.dist((one.x, one.y), (other.x, other.y)) for one, other in itertools.pairwise(self.path))

    def rms(self, distance: float, after: float) -> float:
        """The root mean square of the distance error, from `after` seconds on."""
        errors = np.array(self.gaps[round(after * 10) :]) - distance
        return float(np.sqrt((errors**2).mean()))

    def laps(self) -> float:
        """How often the heading has gone round, counter-clockwise."""
        headings = np.unwrap([pose.theta for pose in self.path])
        return float(headings[-1] - headings[0]) / math.tau


def message(scan: Scan) -> LaserScan:
    return LaserScan(**scan._asdict())


def world(name: str, pose: Pose | None = None, **lidar: Any) -> WorldDescription:
    description = load_world(ROOT / "configs" / "worlds" / f"{name}.yaml")
    (robot,) = description.robots
    sensor = msgspec.structs.replace(robot.sensors[0], **lidar)
    robot = msgspec.structs.replace(robot, pose=pose or robot.pose, sensors=(sensor,))
    return msgspec.structs.replace(description, robots=(robot,))


def ring(*ranges: float, start: float = -math.pi) -> LaserScan:
    """A scan of a full circle."""
    step = math.tau / max(1, len(ranges))
    return LaserScan(angle_min=start, angle_increment=step, range_min=0.1, range_max=10.0, ranges=list(ranges))


NOTHING = [ring(), ring(*[math.inf] * 360), ring(*[math.nan] * 90), ring(0.0, 0.05, 11.0, -1.0)]


# The scan


def test_returns_are_what_a_beam_has_met() -> None:
    angles, ranges = returns(ring(1.0, math.inf, math.nan, -math.inf, 0.05, 10.0, 10.1, 0.1))
    assert ranges.tolist() == pytest.approx([1.0, 0.1, 10.0, 0.1])
    assert np.degrees(angles).tolist() == pytest.approx([-180, -45, 45, 135])


@pytest.mark.parametrize(("start", "left"), [(0.0, 1), (-math.pi, 3), (math.pi / 2, 0), (6.5 * math.pi, 0)])
def test_returns_go_by_angle_wherever_the_first_beam_points(start: float, left: int) -> None:
    angles, ranges = returns(ring(*(1.0 + i for i in range(4)), start=start))
    assert angles[left] == pytest.approx(math.pi / 2)
    assert ranges[left] == 1.0 + left


# The reactive controller


@pytest.mark.parametrize("scan", NOTHING)
def test_with_nothing_in_reach_it_drives_ahead(scan: LaserScan) -> None:
    twist, side, words = reactive.steer(scan, speed=0.4)
    assert (twist.linear.x, twist.angular.z, side) == (0.4, 0.0, 0)
    assert words == "driving ahead, all free"


def test_it_turns_away_from_what_is_near_and_stops_at_the_stop_distance() -> None:
    ranges = [5.0] * 360
    ranges[182:190] = [0.8] * 8  # a little to the left
    twist, side, words = reactive.steer(ring(*ranges), stop_distance=0.5)
    assert 0.0 < twist.linear.x < 0.4
    assert twist.angular.z < 0.0
    assert (side, words) == (-1, "turning right, something 0.8 m ahead")
    ranges[182:190] = [0.45] * 8
    twist = reactive.steer(ring(*ranges), stop_distance=0.5).twist
    assert (twist.linear.x, twist.angular.z) == (0.0, -reactive.TURN_SPEED)


def test_it_goes_on_turning_to_the_side_that_it_has_chosen_until_the_lane_is_free() -> None:
    ranges = [5.0] * 360
    ranges[182:190] = [0.8] * 8
    assert reactive.steer(ring(*ranges), side=1).side == 1
    assert reactive.steer(ring(*[5.0] * 360), side=1).side == 0


def test_what_is_beside_the_lane_does_not_turn_it() -> None:
    ranges = [5.0] * 360
    ranges[90] = ranges[270] = 0.3
    assert reactive.steer(ring(*ranges)).twist.angular.z == 0.0


def test_nearer_than_the_lidar_can_measure_is_near() -> None:
    ranges = [5.0] * 360
    ranges[180] = -math.inf
    assert reactive.steer(ring(*ranges)).twist.linear.x == 0.0


@pytest.mark.parametrize("lidar", [{}, {"fov": 120.0, "beams": 121}, {"start": 0.0}, {"noise": 0.02, "dropout": 0.1}])
def test_wandering_for_a_minute_drives_eight_metres_and_touches_nothing(lidar: dict[str, Any]) -> None:
    drive = Drive(world("obstacles", **lidar), Reactive(), 60.0)
    assert drive.robot.contacts == 0
    assert drive.driven() > 8.0


CORNERS = {"corners": Pose(6.5, 0.5, -0.8), "empty_room": Pose(5.7, 5.7, 0.8), "obstacles": Pose(9.5, 7.5, 0.8)}


@pytest.mark.parametrize(("name", "pose"), CORNERS.items())
def test_wandering_comes_out_of_corners(name: str, pose: Pose) -> None:
    drive = Drive(world(name, pose), Reactive(), 60.0)
    assert drive.robot.contacts == 0
    assert drive.driven() > 8.0


# The wall follower


@pytest.mark.parametrize("scan", NOTHING)
def test_with_no_wall_in_reach_it_drives_ahead(scan: LaserScan) -> None:
    twist, integral, words = follower.follow(scan, follower.Goal(speed=0.3), 0.05)
    assert (twist.linear.x, twist.angular.z, integral) == (pytest.approx(0.3), 0.0, 0.0)
    assert words == "no wall in reach: driving ahead"


@pytest.mark.parametrize(("gap", "turn"), [(0.5, 0.0), (0.4, 1.0), (0.6, -1.0)])
def test_it_turns_to_its_distance(gap: float, turn: float) -> None:
    ranges = [math.inf] * 360
    ranges[90] = gap  # on the right
    twist, _, words = follower.follow(ring(*ranges), follower.Goal())
    assert np.sign(round(twist.angular.z, 6)) == turn
    assert twist.linear.x == pytest.approx(0.3)
    assert words == f"following the wall on the right at {gap:.2f} m"


def test_it_goes_to_a_wall_when_none_is_near() -> None:
    ranges = [math.inf] * 360
    ranges[210] = 3.0
    twist, _, words = follower.follow(ring(*ranges), follower.Goal())
    assert twist.angular.z > 0.0
    assert words == "driving to a wall 3.0 m away"


def test_it_turns_before_what_is_in_front() -> None:
    ranges = [math.inf] * 360
    ranges[90], ranges[180] = 0.5, 0.4
    twist, _, words = follower.follow(ring(*ranges), follower.Goal())
    assert twist.linear.x == pytest.approx(0.0)
    assert twist.angular.z == follower.TURN_SPEED
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
    right = follower.follow(scans[0], follower.Goal(side="right")).twist
    left = follower.follow(scans[1], follower.Goal(side="left")).twist
    assert (left.linear.x, left.angular.z) == pytest.approx((right.linear.x, -right.angular.z), abs=1e-6)


@pytest.mark.parametrize("side", ["right", "left"])
def test_it_goes_round_the_cornered_room_at_half_a_metre(side: str) -> None:
    drive = Drive(world("corners"), Follower(side=side), 120.0)
    assert drive.robot.contacts == 0
    assert drive.rms(0.5, after=30.0) < 0.05
    assert (drive.laps() if side == "right" else -drive.laps()) >= 1.0


@pytest.mark.parametrize(
    "lidar", [{"fov": 180.0, "beams": 181}, {"start": 0.0, "beams": 90}, {"noise": 0.02, "dropout": 0.05}]
)
def test_it_follows_with_any_lidar(lidar: dict[str, Any]) -> None:
    drive = Drive(world("corners", **lidar), Follower(), 90.0)
    assert drive.robot.contacts == 0
    assert drive.rms(0.5, after=30.0) < 0.1


@pytest.mark.parametrize("pose", [Pose(0.4, 0.4, 2.0), Pose(3.0, 4.5, -3.0), Pose(2.0, 3.2, 0.0), Pose(6.6, 3.1, 1.0)])
def test_it_finds_a_wall_from_anywhere(pose: Pose) -> None:
    drive = Drive(world("corners", pose), Follower(distance=0.4), 60.0)
    assert drive.robot.contacts == 0
    assert drive.rms(0.4, after=30.0) < 0.05


def test_it_makes_up_its_mind_between_walls_that_are_equally_far() -> None:
    assert Drive(world("empty_room"), Follower(), 40.0).rms(0.5, after=30.0) < 0.05


# Both


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
    for twist, speed, turn in (
        (reactive.steer(scan).twist, 0.4, reactive.TURN_SPEED),
        (follower.follow(scan, follower.Goal(side=side)).twist, 0.3, follower.TURN_SPEED),
    ):
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
