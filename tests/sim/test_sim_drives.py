"""Omnidirectional and car-like drives: exact arcs, limits, what they cannot do, and honesty when blocked."""

from __future__ import annotations

import math

import pytest

from robolink.geometry.plane import wrapped
from robolink.sim import Pose, Robot, World, load_world
from robolink.sim.driving.arithmetic import sinc

SHARP = "a_max: 500, alpha_max: 1000"
CAR = "type: ackermann, wheelbase: 0.3, steer_max: 0.5, v_max: 2, w_max: 6"


def world(drive: str, pose: str = "[0, 0, 0]", more: str = "") -> World:
    text = f"robots: [{{name: r, pose: {pose}, drive: {{{drive}}}, shape: {{circle: 0.25}}}}]\n{more}"
    return World(load_world("test.yaml", text=text))


def drive(world: World, seconds: float, v: float, w: float = 0.0, sideways: float = 0.0) -> Robot:
    robot = world.robots["r"]
    for _ in range(round(seconds / 0.01)):
        robot.command(v, w, sideways)
        world.step()
    return robot


def gap(one: Pose, other: Pose) -> float:
    return math.dist((one.x, one.y), (other.x, other.y)) + abs(wrapped(one.theta - other.theta))


def along_arc(start: Pose, seconds: float, v: float, w: float, sideways: float = 0.0) -> Pose:
    half = w * seconds / 2
    chord, middle = seconds * sinc(half), start.theta + half
    cos, sin = math.cos(middle), math.sin(middle)
    x, y = chord * (v * cos - sideways * sin), chord * (v * sin + sideways * cos)
    return Pose(start.x + x, start.y + y, start.theta + w * seconds)


@pytest.mark.parametrize(("v", "w", "s"), [(0.3, 0.5, 0.2), (0.0, -1.9, 0.4), (-0.1, 0.0, -0.4), (0.0, 0.0, 0.5)])
def test_an_omni_drive_keeps_exact_arcs_for_a_minute(v: float, w: float, s: float) -> None:
    made = world("type: omni, w_max: 2")
    start = drive(made, 2.0, v, w, s).pose
    robot = drive(made, 60.0, v, w, s)
    expected = along_arc(start, 60.0, v, w, s)
    assert robot.twist == pytest.approx((v, w, s), abs=1e-12)
    assert gap(robot.pose, expected) < 1e-9
    assert gap(robot.odometry, expected) < 1e-9


def test_an_omni_drive_that_is_asked_too_much_keeps_its_direction() -> None:
    robot = drive(world(f"type: omni, v_max: 0.5, {SHARP}"), 0.5, 3.0, 0.0, -4.0)
    assert robot.twist == pytest.approx((0.3, 0.0, -0.4), abs=1e-9)


def test_an_omni_drive_gains_speed_no_faster_than_it_may() -> None:
    robot = drive(world("type: omni, a_max: 0.5, v_max: 1"), 0.4, 0.0, 0.0, 0.6)
    assert robot.twist.sideways == pytest.approx(0.2)


def test_a_differential_drive_goes_nowhere_sideways() -> None:
    robot = drive(world("type: diff"), 1.0, 0.2, 0.0, 0.5)
    assert robot.twist == pytest.approx((0.2, 0.0, 0.0), abs=1e-12)
    assert robot.pose.y == 0.0


@pytest.mark.parametrize(("v", "w"), [(0.5, 0.7), (-0.4, 0.5), (1.5, -0.9), (0.6, 0.0)])
def test_a_car_keeps_exact_arcs_for_a_minute(v: float, w: float) -> None:
    made = world(CAR)
    start = drive(made, 3.0, v, w).pose
    robot = drive(made, 60.0, v, w)
    assert robot.twist == pytest.approx((v, w, 0.0), abs=1e-12)
    assert gap(robot.pose, along_arc(start, 60.0, v, w)) < 1e-9
    assert gap(robot.odometry, robot.pose) < 1e-9


def test_a_cars_tightest_circle_is_that_of_its_wheels() -> None:
    robot = drive(world(CAR), 3.0, 0.5, 6.0)
    assert robot.twist.v / robot.twist.w == pytest.approx(0.3 / math.tan(0.5))


def test_a_car_does_not_turn_on_the_spot() -> None:
    robot = drive(world(CAR), 2.0, 0.0, 2.0)
    assert gap(robot.pose, Pose(0.0, 0.0, 0.0)) == 0.0


def test_a_car_turns_its_wheels_no_faster_than_it_may() -> None:
    made = world(f"{CAR}, steer_rate: 0.5, {SHARP}")
    drive(made, 1.0, 1.0)
    robot = drive(made, 0.4, 1.0, 1.0)
    assert robot.twist.w == pytest.approx(math.tan(0.2) / 0.3)


def test_a_car_that_is_too_slow_for_a_command_goes_the_same_way() -> None:
    robot = drive(world(f"{CAR}, v_max: 0.5".replace("v_max: 2, ", "")), 4.0, 5.0, 5.0)
    assert robot.twist == pytest.approx((0.5, 0.5, 0.0))


def test_a_car_that_stops_keeps_its_wheels_as_they_are() -> None:
    made = world(f"{CAR}, steer_rate: 0.5, {SHARP}")
    drive(made, 2.0, 0.5, 0.5)
    assert drive(made, 1.0, 0.0).twist.v == pytest.approx(0.0, abs=1e-12)
    robot = made.robots["r"]
    robot.command(0.5, 0.5)
    made.step()
    assert robot.twist.w == pytest.approx(0.5)


@pytest.mark.parametrize("kind", ["type: omni", CAR, "type: diff"])
def test_every_drive_stops_when_no_command_comes(kind: str) -> None:
    made = world(f"{kind}, timeout: 0.3, {SHARP}")
    robot = drive(made, 1.0, 0.4, 0.3)
    for _ in range(29):  # the last command came one step ago
        made.step()
    assert robot.twist[:2] == pytest.approx((0.4, 0.3))
    for _ in range(3):
        made.step()
    assert robot.twist == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


@pytest.mark.parametrize(("kind", "command"), [("type: omni", (0.0, 0.0, 0.5)), (CAR, (0.5, 0.0, 0.0))])
def test_whoever_is_blocked_says_so(kind: str, command: tuple[float, float, float]) -> None:
    walls = "walls: [{polyline: [[1, -5], [1, 1], [-5, 1]]}]"
    robot = drive(world(kind, more=walls), 10.0, *command)
    assert robot.touching >= 1
    assert robot.twist == pytest.approx((0.0, 0.0, 0.0), abs=0.02)
    assert gap(robot.odometry, robot.pose) < 0.02
    assert robot.penetration < 0.005


def test_the_place_of_a_car_is_the_middle_of_its_rear_axle() -> None:
    text = f"""
    robots:
      - name: r
        pose: [0, 0, 0]
        drive: {{{CAR}, {SHARP}, steer_rate: 100}}
        shape: {{polygon: [[-0.1, -0.15], [0.4, -0.15], [0.4, 0.15], [-0.1, 0.15]]}}
    """
    made = World(load_world("car.yaml", text=text))
    drive(made, 0.5, 1.0, 1.0)
    pose, twist = made.robots["r"].pose, made.robots["r"].twist
    made.step()
    after = made.robots["r"].pose
    assert twist == pytest.approx((1.0, 1.0, 0.0))  # the rear axle itself never slides
    middle = pose.theta + 0.005
    assert (after.y - pose.y) * math.cos(middle) == pytest.approx((after.x - pose.x) * math.sin(middle), abs=1e-12)


@pytest.mark.parametrize("kind", ["type: diff, v_max: 1.5", "type: omni, v_max: 1.5", f"{CAR}, a_max: 1.0"])
def test_a_robot_that_is_held_brakes_as_hard_as_its_wheels_grip(kind: str) -> None:
    made = world(kind)
    robot = drive(made, 4.0, 1.5)
    assert robot.twist.v == pytest.approx(1.5)
    robot.hold()
    steps = 0
    while robot.twist.v > 1e-9:
        robot.command(1.5, 0.0)
        made.step()
        steps += 1
    assert steps == math.ceil(1.5 / (0.8 * 9.81 * 0.01))
    place = robot.pose
    assert gap(drive(made, 10.0, 1.5, 1.0, 1.0).pose, place) < 1e-9
    robot.release()
    made.step()
    assert robot.twist.v == 0.0  # it obeys the next command, and none of before
    assert drive(made, 0.1, 1.5).twist.v < 0.2  # within the drive's limits again
