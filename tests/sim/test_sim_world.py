"""Driving, contact, odometry, time and determinism of the simulated world."""

from __future__ import annotations

import math
import random

import pytest

from robolink import sim
from robolink.exceptions import RobolinkError
from robolink.geometry.plane import wrapped
from robolink.sim import CommandError, Pose, Robot, World, load_world
from robolink.sim.driving.arithmetic import sinc
from robolink.sim.driving.motion import motion_of_one

ROOM = "walls: [{polyline: [[0, 0], [8, 0], [8, 5], [0, 5]], closed: true}]\n"
SHARP = "a_max: 500, alpha_max: 1000"


def world(robot: str = "pose: [2, 2.5, 0]", more: str = "", seed: int | None = None) -> World:
    text = ROOM + f"robots:\n  - {{name: r, {robot}}}\n" + more
    return World(load_world("test.yaml", text=text), seed=seed)


def drive(world: World, seconds: float, v: float, w: float = 0.0) -> Robot:
    robot = world.robots["r"]
    for _ in range(round(seconds / 0.01)):
        robot.command(v, w)
        world.step()
    return robot


def gap(one: Pose, other: Pose) -> float:
    return math.dist((one.x, one.y), (other.x, other.y)) + abs(wrapped(one.theta - other.theta))


@pytest.mark.parametrize(("v", "w"), [(0.3, 0.5), (0.5, -2.0), (-0.2, 0.7), (0.0, 1.0), (0.4, 1e-9), (0.0, 0.0)])
def test_a_steady_turn_is_an_exact_circle_for_a_minute(v: float, w: float) -> None:
    made = world("pose: [4, 2.5, 0]")
    if abs(w) < 0.1:
        made = World(load_world("open.yaml", text="robots: [{name: r, pose: [0, 0, 1]}]"))
    start = drive(made, 2.0, v, w).pose
    robot = drive(made, 60.0, v, w)
    half = w * 60 / 2
    chord, middle = v * 60 * sinc(half), start.theta + half
    expected = Pose(start.x + chord * math.cos(middle), start.y + chord * math.sin(middle), start.theta + w * 60)
    assert gap(robot.pose, expected) < 1e-9
    assert gap(robot.odometry, expected) < 1e-9


def test_odometry_stays_with_the_truth_through_changing_commands() -> None:
    made, dice = World(load_world("open.yaml", text="robots: [{name: r, pose: [1, -2, 0.3]}]")), random.Random(2)
    robot = made.robots["r"]
    for step in range(6000):
        if step % 20 == 0:
            robot.command(dice.uniform(-1, 1), dice.uniform(-3, 3))
        made.step()
    assert gap(robot.odometry, robot.pose) < 1e-9
    assert math.dist((robot.pose.x, robot.pose.y), (1, -2)) > 0.5


def test_odometry_is_exact_in_one_step_or_many() -> None:
    one, many = (motion_of_one(dt, Pose(1.0, 2.0, 0.5), {}) for dt in (10.0, 0.01))
    for motion, steps in ((one, 1), (many, 1000)):
        motion.v, motion.w, motion.chord = 0.4, 0.3, sinc(0.3 * motion.dt / 2)
        for _ in range(steps):
            motion.count(None)
    assert (many.x, many.y, many.theta) == pytest.approx((one.x, one.y, one.theta), abs=1e-11)


def test_speed_and_acceleration_are_limited() -> None:
    made = world("pose: [1, 2.5, 0], drive: {v_max: 0.5, w_max: 1.0, a_max: 0.5, alpha_max: 2}")
    robot = drive(made, 0.5, 9.0, -9.0)
    assert robot.twist[:2] == pytest.approx((0.25, -1.0))
    drive(made, 1.0, 9.0, -9.0)
    assert robot.twist[:2] == pytest.approx((0.5, -1.0))
    drive(made, 0.2, -9.0, 0.0)
    assert robot.twist[:2] == pytest.approx((0.4, -0.6))


def test_the_robot_stops_when_no_command_comes() -> None:
    made = world(f"pose: [1, 2.5, 0], drive: {{timeout: 0.5, {SHARP}}}")
    robot = drive(made, 1.0, 0.4)
    for _ in range(49):  # the last command came one step ago
        made.step()
    assert robot.twist.v == pytest.approx(0.4)
    for _ in range(2):
        made.step()
    assert robot.twist.v == pytest.approx(0.0)


@pytest.mark.parametrize("command", [(math.nan, 0.0), (0.0, math.inf), (-math.inf, math.nan)])
def test_a_command_that_is_not_finite_is_refused(command: tuple[float, float]) -> None:
    robot = drive(world(), 1.0, 0.3)
    with pytest.raises(CommandError, match="expected a finite velocity") as caught:
        robot.command(*command)
    assert isinstance(caught.value, (RobolinkError, ValueError))
    assert robot.twist.v == pytest.approx(0.3)


@pytest.mark.parametrize("heading", [0.0, 0.7, 1.5707963267948966, 2.4])
def test_at_walking_speed_a_wall_gives_way_by_less_than_5_mm(heading: float) -> None:
    robot = drive(world(f"pose: [2, 2.5, {heading}]"), 20.0, 0.5)
    assert robot.contacts >= 1
    assert robot.touching >= 1
    assert 0.0 < robot.penetration < 0.005


@pytest.mark.parametrize("speed", [0.5, 2.0, 5.0, 10.0, 16.8])
@pytest.mark.parametrize("shape", ["circle: 0.17", "box: [0.5, 0.34]"])
def test_no_speed_takes_a_robot_through_a_wall(speed: float, shape: str) -> None:
    made = world(f"pose: [0.6, 2.5, 3], shape: {{{shape}}}, drive: {{v_max: {speed}, w_max: 1, {SHARP}}}")
    robot, dice = made.robots["r"], random.Random(1)
    for step in range(1500):
        if step % 50 == 0:
            turn = dice.uniform(-1, 1)
        robot.command(speed, turn)
        made.step()
        assert 0.0 < robot.pose.x < 8.0
        assert 0.0 < robot.pose.y < 5.0
    assert robot.contacts > 0


def test_a_blocked_robot_says_that_it_stands() -> None:
    robot = drive(world(), 30.0, 0.5)
    assert robot.touching == 1
    assert robot.twist.v == pytest.approx(0.0, abs=0.01)
    assert gap(robot.odometry, robot.pose) < 0.01
    assert robot.pose.x == pytest.approx(8 - 0.17, abs=0.002)


def test_a_robot_that_backs_off_touches_no_more() -> None:
    made = world()
    robot = drive(made, 20.0, 0.5)
    drive(made, 2.0, -0.5)
    assert robot.touching == 0
    assert robot.contacts == 1
    assert made.nearest_wall_distance(robot.pose.x, robot.pose.y) > 0.5


def test_a_crate_with_a_mass_is_pushed_and_one_without_stands() -> None:
    for mass, travelled in ((", mass: 2.0", True), ("", False)):
        made = world(more=f"obstacles: [{{box: [0.3, 0.3], pose: [4, 2.5]{mass}}}]\n")
        robot = drive(made, 10.0, 0.3)
        assert (robot.pose.x > 4.0) is travelled
        assert robot.contacts >= 1
        drive(made, 1.0, -0.3)
        assert robot.touching == 0


def test_a_pushed_crate_comes_to_rest() -> None:
    made = world("pose: [2, 2.5, 0], sensors: [{lidar: scan}]", "obstacles: [{circle: 0.2, pose: [3, 2.5], mass: 1}]\n")
    robot = drive(made, 4.0, 0.4)
    drive(made, 3.0, -0.4)
    drive(made, 1.0, 0.0)
    seen = robot.scan().ranges[180]
    drive(made, 2.0, 0.0)
    assert robot.scan().ranges[180] == pytest.approx(seen, abs=1e-6)
    assert 0.3 < seen < 4.0


def test_the_distance_to_the_nearest_wall_counts_what_is_fixed() -> None:
    fixed = "{circle: 0.5, pose: [6, 2]}, {box: [1, 1], pose: [4, 1]}"
    made = world("pose: [1, 1]", f"obstacles: [{fixed}, {{circle: 0.3, pose: [2, 4], mass: 1}}]\n")
    found = [made.nearest_wall_distance(*point) for point in ((1, 2), (6, 3), (4, 2), (7.9, 4), (2, 4))]
    assert found == pytest.approx([1.0, 0.5, 0.5, 0.1, 1.0])
    empty = World(load_world("empty.yaml", text="{}"))
    assert empty.nearest_wall_distance(0.0, 0.0) == math.inf


def test_time_is_a_count_of_steps() -> None:
    made = World(load_world("fast.yaml", text="world: {dt: 0.003}"))
    for _ in range(1000):
        made.step()
    assert (made.steps, made.time_ns) == (1000, 3_000_000_000)


def trace(seed: int | None) -> list[object]:
    made = world(
        "pose: [2, 2.5, 0.3], sensors: [{lidar: scan, noise: 0.01}]",
        "obstacles: [{circle: 0.2, pose: [3, 3], mass: 1}]\n",
        seed,
    )
    robot, found = made.robots["r"], list[object]()
    for step in range(1500):
        if step % 10 == 0:
            ahead = robot.scan().ranges[150:210].min()
            robot.command(min(0.5, ahead / 4), 0.3 * math.sin(step / 70))
            found += [robot.pose, robot.odometry, robot.twist, ahead]
        made.step()
    return [*found, robot.contacts, robot.penetration]


@pytest.mark.slow
def test_the_same_seed_gives_the_same_life_to_the_last_bit() -> None:
    first, again, other = trace(3), trace(3), trace(4)
    assert first == again
    assert first != other


def test_headings_are_wrapped() -> None:
    robot = drive(world(), 20.0, 0.0, 1.9)
    assert -math.pi <= robot.pose.theta <= math.pi
    assert robot.odometry.theta == pytest.approx(robot.pose.theta, abs=1e-9)


def test_robots_that_run_into_each_other_both_count_it_once() -> None:
    made = world("pose: [2, 2.5, 0]", more="  - {name: s, pose: [4, 2.5]}\n")
    first, second = drive(made, 6.0, 0.3), made.robots["s"]
    assert (first.contacts, second.contacts) == (1, 1)
    assert (first.touching, second.touching) == (1, 1)
    drive(made, 2.0, -0.3)
    assert (first.touching, second.touching) == (0, 0)


def test_odometry_does_not_notice_that_a_robot_is_pushed_aside() -> None:
    made = world("pose: [4, 2.5, 0]", "obstacles: [{box: [0.5, 0.5], path: [[4, 1], [4, 3.5]], speed: 0.5}]\n")
    robot = drive(made, 5.0, 0.0)
    assert robot.pose.y == pytest.approx(3.5 + 0.25 + 0.17, abs=0.01)
    assert robot.odometry.y == 2.5
    slipping = world("pose: [4, 2.5, 0]", "obstacles: [{box: [0.5, 0.5], path: [[4, 1], [4, 4]], speed: 0.5}]\n")
    robot = drive(slipping, 4.0, 0.0)
    assert robot.twist.sideways == pytest.approx(0.5, abs=0.01)
    assert robot.odometry_twist.sideways == 0.0


def test_the_face_is_the_table_of_homes() -> None:
    assert sorted(sim._HOMES) == sorted(sim.__all__)
    assert all(getattr(sim, name).__module__ == f"robolink.sim.{home}" for name, home in sim._HOMES.items())
