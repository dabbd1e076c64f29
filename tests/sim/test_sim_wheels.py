"""Wheels as motors turn them: speeds by least squares, encoders, limits, and names that are not there."""

from __future__ import annotations

import math

import pytest

from robolink.exceptions import NotFoundError
from robolink.sim import CommandError, Robot, Velocity, World, load_world
from robolink.sim.description import Wheel
from robolink.sim.driving.drive import Wheels
from robolink.sim.quantities import Pose

PAIR = """
  wheels:
    - {motor: left, at: [0, 0.1, 0], radius: 0.05, speed_max: 30}
    - {motor: right, at: [0, -0.1, 0], radius: 0.05, speed_max: 30}
"""


def world(wheels: str = PAIR, drive: str = "a_max: 500, alpha_max: 1000, v_max: 2, w_max: 20", more: str = "") -> World:
    robot = f"robots:\n- name: r\n  pose: [0, 0, 0]\n  drive: {{{drive}}}\n  odom: {{rate: 50}}\n{wheels}"
    return World(load_world("wheels.yaml", text=robot + more))


def run(world: World, seconds: float) -> Robot:
    for _ in range(round(seconds / 0.01)):
        world.step()
    return world.robots["r"]


def test_two_motors_drive_a_robot_and_their_wheels_tell_its_way() -> None:
    made = world()
    robot = made.robots["r"]
    robot.turn_wheels({"left": 6.0, "right": 10.0})
    run(made, 10.01)  # the first step only sets it going
    assert robot.twist == pytest.approx((0.4, 1.0, 0.0))
    assert robot.pose.theta == pytest.approx(math.remainder(10.0, math.tau))
    assert [wheel.motor for wheel in robot.wheels] == ["left", "right"]
    assert [wheel.speed for wheel in robot.wheels] == pytest.approx([6.0, 10.0])
    assert [wheel.position for wheel in robot.wheels] == pytest.approx([60.0, 100.0])


def test_a_motor_keeps_its_speed_and_the_others_theirs() -> None:
    made = world()
    made.robots["r"].turn_wheels({"left": 4.0, "right": 4.0})
    run(made, 5.0)
    made.robots["r"].turn_wheels({"right": 8.0})
    robot = run(made, 5.0)
    assert [wheel.speed for wheel in robot.wheels] == pytest.approx([4.0, 8.0])


def test_a_velocity_command_takes_over_and_times_out() -> None:
    made = world()
    robot = made.robots["r"]
    robot.turn_wheels({"left": 4.0, "right": 4.0})
    run(made, 1.0)
    robot.command(0.1, 0.0)
    assert run(made, 0.4).twist.v == pytest.approx(0.1)
    assert run(made, 0.3).twist.v == pytest.approx(0.0, abs=1e-12)
    robot.turn_wheels({"left": 4.0})
    assert [wheel.speed for wheel in run(made, 1.0).wheels] == pytest.approx([4.0, 0.0])


def test_motors_turn_no_faster_than_they_can() -> None:
    made = world()
    made.robots["r"].turn_wheels({"left": 1000.0, "right": 15.0})
    assert [wheel.speed for wheel in run(made, 1.0).wheels] == pytest.approx([30.0, 15.0])


def test_within_the_drives_limits_the_way_stays_the_same() -> None:
    made = world(drive="v_max: 0.5, w_max: 20, a_max: 500, alpha_max: 1000")
    made.robots["r"].turn_wheels({"left": 10.0, "right": 30.0})
    robot = run(made, 1.0)
    assert robot.twist.v == pytest.approx(0.5)
    assert [wheel.speed for wheel in robot.wheels] == pytest.approx([5.0, 15.0])


def test_an_unknown_motor_is_named_with_the_nearest_and_none_turns() -> None:
    made = world()
    with pytest.raises(NotFoundError, match=r"no motor named 'rigth' in robot 'r' \(did you mean 'right'"):
        made.robots["r"].turn_wheels({"left": 5.0, "rigth": 5.0})
    assert run(made, 0.5).twist.v == 0.0
    with pytest.raises(LookupError, match="no motor named 'left'"):
        world(wheels="").robots["r"].turn_wheels({"left": 5.0})


@pytest.mark.parametrize("speed", [math.nan, math.inf, -math.inf])
def test_a_speed_that_is_not_finite_is_refused(speed: float) -> None:
    made = world()
    with pytest.raises(CommandError, match="expected a finite speed of motor 'right'"):
        made.robots["r"].turn_wheels({"left": 5.0, "right": speed})
    assert run(made, 0.5).twist.v == 0.0


def test_wheels_of_a_blocked_robot_stand_still() -> None:
    made = world(more="walls: [{polyline: [[0.5, -2], [0.5, 2]]}]")
    made.robots["r"].turn_wheels({"left": 8.0, "right": 8.0})
    robot = run(made, 5.0)
    turned = [wheel.position for wheel in robot.wheels]
    assert turned == pytest.approx([robot.pose.x / 0.05] * 2, abs=0.2)
    assert [wheel.speed for wheel in robot.wheels] == pytest.approx([0.0, 0.0], abs=0.2)


def test_three_omni_wheels_go_everywhere() -> None:
    third = math.tau / 3
    poses = [Pose(0.2 * math.cos(k * third), 0.2 * math.sin(k * third), k * third + math.pi / 2) for k in range(3)]
    wheels = Wheels([Wheel(f"m{k}", pose, 0.04) for k, pose in enumerate(poses)], "r", sideways=True)
    for wanted in (Velocity(0.5, 0.0), Velocity(0.0, 0.0, 0.5), Velocity(0.0, 2.0), Velocity(0.3, 1.0, -0.2)):
        told = dict(zip(("m0", "m1", "m2"), wheels.speeds(wanted), strict=True))
        assert wheels.turn(told) == pytest.approx(wanted, abs=1e-12)


def test_wheels_that_contradict_each_other_go_the_middle_way() -> None:
    places = {"fl": 0.1, "fr": -0.1, "rl": 0.1, "rr": -0.1}
    wheels = Wheels([Wheel(name, Pose(0.0, y), 0.1) for name, y in places.items()], "r", sideways=False)
    assert wheels.turn({"fl": 3.0, "rl": 5.0, "fr": 6.0, "rr": 6.0}) == pytest.approx(Velocity(0.5, 1.0))


def test_one_wheel_drives_as_far_as_it_can() -> None:
    wheels = Wheels([Wheel("only", Pose(0.0, 0.0), 0.1)], "r", sideways=False)
    assert wheels.turn({"only": 5.0}) == pytest.approx(Velocity(0.5, 0.0))
