"""Inertial units, bumpers, range finders, encoders and noisy odometry; which sensors are due, and measured how."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robolink.exceptions import NotFoundError
from robolink.geometry.plane import wrapped
from robolink.sim import Inertia, Pose, Robot, Scan, World, load_world
from robolink.sim.driving.arithmetic import sinc
from robolink.sim.sensing.lidar import Beams, distances, nearest_in_cone
from robolink.sim.sensing.scene import standing
from robolink.sim.sensors import Lidar

SHARP = "a_max: 500, alpha_max: 1000"
ROOM = "walls: [{polyline: [[0, 0], [8, 0], [8, 5], [0, 5]], closed: true}]\n"


def world(robot: str, more: str = "") -> World:
    return World(load_world("test.yaml", text=f"{ROOM}robots:\n  - {{name: r, {robot}}}\n{more}"))


def drive(world: World, seconds: float, v: float, w: float = 0.0, sideways: float = 0.0) -> Robot:
    for _ in range(round(seconds / 0.01)):
        world.robots["r"].command(v, w, sideways)
        world.step()
    return world.robots["r"]


def values(world: World, steps: int, topic: str) -> list[Any]:
    """What a sensor has read in so many steps without a command."""
    found = []
    for _ in range(steps):
        world.step()
        found += [reading.value for reading in world.readings() if reading.sensor.topic == topic]
    return found


def test_sensors_are_due_at_their_own_rates_robot_by_robot() -> None:
    some = "sensors: [{imu: imu, rate: 100}, {lidar: scan, rate: 20}, {bumper: bumper, rate: 10}]"
    made = world(f"pose: [2, 2], {some}", f"  - {{name: s, pose: [4, 2], {some}}}\n")
    counts = Counter[tuple[str, str]]()
    for _ in range(200):
        made.step()
        found = [(reading.robot.name, reading.sensor.topic) for reading in made.readings()]
        counts.update(found)
        assert found == sorted(found, key=lambda pair: (pair[0], ("imu", "scan", "bumper").index(pair[1])))
    assert counts == {(name, topic): n for name in "rs" for topic, n in (("imu", 200), ("scan", 40), ("bumper", 20))}


def test_lidars_that_are_measured_together_read_what_they_would_alone() -> None:
    lidar = "sensors: [{lidar: scan, noise: 0.02, dropout: 0.1, intensities: true}, {lidar: rear, beams: 90}]"
    more = "".join(f"  - {{name: s{k}, pose: [{k + 1}, 4, 1], {lidar}}}\n" for k in range(6))
    together, alone = (world(f"pose: [2, 2, 0.3], {lidar}", more) for _ in range(2))
    for made in (together, alone):
        drive(made, 0.1, 0.3)
    read = {(reading.robot.name, reading.sensor.topic): reading.value for reading in together.readings()}
    assert len(read) == 14
    for (name, topic), scan in read.items():
        other = alone.robots[name].scan(topic)
        assert isinstance(scan, Scan)
        assert scan.ranges.tobytes() == other.ranges.tobytes()
        assert (scan.intensities is None) == (topic == "rear")
        if scan.intensities is not None and other.intensities is not None:
            assert scan.intensities.tobytes() == other.intensities.tobytes()
            assert not scan.intensities[np.isposinf(scan.ranges)].any()


def test_an_inertial_unit_feels_heading_turning_and_the_pull_to_the_middle() -> None:
    made = world(f"pose: [4, 2, 1], drive: {{type: diff, {SHARP}}}, sensors: [{{imu: imu}}]")
    robot = drive(made, 1.0, 0.4, 1.5)
    (reading,) = made.readings()
    assert isinstance(reading.value, Inertia)
    assert reading.value.heading == pytest.approx(robot.pose.theta)
    assert reading.value.turning == pytest.approx(1.5)
    assert (reading.value.ax, reading.value.ay) == pytest.approx((0.0, 0.4 * 1.5 * sinc(0.0075) ** 2), abs=1e-9)


def test_an_inertial_unit_feels_how_a_robot_gains_speed_ahead_and_aside() -> None:
    made = world("pose: [4, 2, 2], drive: {type: omni, a_max: 0.5}, sensors: [{imu: imu}]")
    drive(made, 0.2, 0.5, 0.0, -0.5)
    value = made.readings()[0].value
    assert isinstance(value, Inertia)
    assert (value.ax, value.ay) == pytest.approx((0.5, -0.5))


def test_an_inertial_units_noise_has_its_size() -> None:
    noisy = "sensors: [{imu: imu, rate: 100, noise: {gyro: 0.02, accel: 0.3}}]"
    read = np.array(values(world(f"pose: [4, 2], {noisy}"), 3000, "imu"))
    assert read.std(axis=0) == pytest.approx([0.0, 0.02, 0.3, 0.3], rel=0.05)
    assert read.mean(axis=0) == pytest.approx([0.0] * 4, abs=0.03)


def test_a_bumper_remembers_a_touch_until_it_is_read() -> None:
    ram = "  - {name: s, pose: [3, 2, 3.14159], drive: {v_max: 1, a_max: 500}}\n"
    made = world("pose: [2, 2], mass: 50, sensors: [{bumper: bumper, rate: 1}, {bumper: fast, rate: 100}]", ram)
    slow, fast = list[Any](), list[Any]()
    for step in range(400):
        made.robots["s"].command(1.0 if step < 130 and made.robots["r"].contacts == 0 else -1.0, 0.0)
        made.step()
        for reading in made.readings():
            (slow if reading.sensor.rate == 1 else fast).append(reading.value)
    assert slow == [True, False, False, False]
    assert 1 <= sum(fast) < 20


@pytest.mark.parametrize(
    ("theta", "touched"), [(0.0, {"ahead", "all"}), (math.pi / 2, {"right", "all"}), (3.0, {"back", "all"})]
)
def test_bumpers_feel_their_own_sectors(theta: float, touched: set[str]) -> None:
    sides = "{bumper: right, start: -120, fov: 60}, {bumper: back, start: 150, fov: 60}"
    sectors = f"{{bumper: all}}, {{bumper: ahead, fov: 60}}, {sides}"
    text = f"{ROOM}obstacles: [{{box: [0.5, 0.5], path: [[3, 2.5], [2.2, 2.5]], speed: 0.2}}]\n"
    robot = f"robots: [{{name: r, pose: [2, 2.5, {theta}], sensors: [{sectors}]}}]"
    made = World(load_world("sectors.yaml", text=text + robot))
    found = set()
    for _ in range(350):
        made.step()
        found |= {reading.sensor.topic for reading in made.readings() if reading.value}
    assert found == touched


@pytest.mark.slow
@example(segments=[(2.0, 2.0, 5.0, 5.5)], circles=[], fov=152.0, theta=0.0)
@given(
    st.lists(st.tuples(*[st.floats(-6, 6)] * 4), max_size=6),
    st.lists(st.tuples(st.floats(-6, 6), st.floats(-6, 6), st.floats(0.05, 2)), max_size=4),
    st.floats(1, 180),
    st.floats(-4, 4),
)
@settings(max_examples=150, deadline=None)
def test_a_range_finder_agrees_with_a_fine_fan_of_beams(
    segments: list[tuple[float, ...]], circles: list[tuple[float, ...]], fov: float, theta: float
) -> None:
    lines = np.array([each for each in segments if steepness(each, 0.3, -0.2) > STEEP]).reshape(-1, 4)
    rounds = np.array([each for each in circles if math.hypot(*each[:2]) > each[2] + 0.01]).reshape(-1, 3)
    sensor = Pose(0.3, -0.2, theta)
    found = nearest_in_cone(sensor, fov, lines[:, [0, 2, 1, 3]].T, rounds.T)
    beams = Beams(Lidar("fan", beams=3601, fov=fov, range=(0.0, 50.0)))
    if any(math.hypot(x - 0.3, y + 0.2) <= radius + 0.01 for x, y, radius in rounds):
        return  # inside of a circle, where a fan sees its rim
    fan = float(distances(beams, sensor, standing(lines, rounds)).min())
    assert found <= fan + 1e-9
    slack = 2 * math.radians(fov) / 3600  # beams may miss an end by this angle
    wider = nearest_in_cone(sensor, fov - math.degrees(slack) * 2, lines[:, [0, 2, 1, 3]].T, rounds.T)
    assert fan <= wider / (1 - slack / STEEP) + 0.02 or fan == wider


STEEP = 0.1
"""The sine of the angle at which a beam meets a wall, at least: along a wall, the next beam may meet it far behind."""


def steepness(segment: tuple[float, ...], x: float, y: float) -> float:
    """The least sine of the angle between a segment and the rays from a point to it; 0 for a very short segment."""
    ends = np.reshape(segment, (2, 2)) - (x, y)
    along = ends[1] - ends[0]
    length, farthest = math.hypot(*along), max(math.hypot(*each) for each in ends)
    return 0.0 if length < 0.5 else abs(float(along[0] * ends[0][1] - along[1] * ends[0][0])) / length / farthest


def test_a_range_finder_sees_the_nearest_corner_and_its_limits() -> None:
    sonar = "sensors: [{range_finder: sonar, rate: 100, fov: 30, range: [0.3, 3.0], offset: [0.1, 0, 0]}]"
    assert values(world(f"pose: [5.9, 2.5], {sonar}"), 1, "sonar") == pytest.approx([2.0])
    assert values(world(f"pose: [4.0, 2.5], {sonar}"), 1, "sonar") == [math.inf]
    assert values(world(f"pose: [7.7, 2.5], {sonar}"), 1, "sonar") == [-math.inf]
    slanted = values(world(f"pose: [6, 2.5, 0.1], {sonar}"), 1, "sonar")
    assert slanted == pytest.approx([2 - 0.1 * math.cos(0.1)])  # the foot of the wall lies within the cone
    post = "  - {name: post, pose: [5.0, 2.5], shape: {circle: 0.2}}\n"
    assert values(world(f"pose: [4, 2.5], {sonar}", post), 1, "sonar") == pytest.approx([0.7])


@pytest.mark.slow
def test_a_range_finders_noise_has_its_size() -> None:
    sonar = "sensors: [{range_finder: sonar, rate: 100, noise: 0.02}]"
    read = np.array(values(world(f"pose: [6, 2.5], {sonar}"), 2000, "sonar"))
    assert (read.mean(), read.std()) == (pytest.approx(2.0, abs=0.002), pytest.approx(0.02, rel=0.06))


PAIR = "wheels: [{motor: left, at: [0, 0.1]}, {motor: right, at: [0, -0.1]}]"


def test_encoders_count_whole_ticks_and_lose_none() -> None:
    encoders = "sensors: [{encoders: exact, rate: 10}, {encoders: coarse, rate: 10, ticks: 20}]"
    made = world(f"pose: [2, 2.5], drive: {{v_max: 1, {SHARP}}}, {PAIR}, {encoders}")
    made.robots["r"].turn_wheels({"left": 2.0, "right": 3.0})
    last = [0.0, 0.0]
    for _ in range(300):
        made.step()
        read: dict[str, Any] = {reading.sensor.topic: reading.value for reading in made.readings()}
        for index, (true, counted) in enumerate(zip(read.get("exact", ()), read.get("coarse", ()), strict=True)):
            ticks = counted.position / (math.tau / 20)
            assert ticks == pytest.approx(round(ticks))
            assert 0.0 <= true.position - counted.position < math.tau / 20 + 1e-9
            assert counted.speed == pytest.approx((counted.position - last[index]) / 0.1)
            last[index] = counted.position
    assert last == pytest.approx([6.0, 9.0], abs=math.tau / 20 + 0.05)


def noisy_odometry(v: float, w: float, seconds: float = 600.0) -> World:
    noise = f"odom: {{noise: {{v: {v}, w: {w}}}}}, drive: {{{SHARP}}}"
    made = World(load_world("open.yaml", text=f"robots: [{{name: r, pose: [0, 0], {noise}}}]"))
    drive(made, seconds, 0.3, 0.0)
    return made


@pytest.mark.slow
def test_noise_of_odometry_has_its_size_and_leaves_the_truth_alone() -> None:
    robot = noisy_odometry(0.1, 0.0).robots["r"]
    assert robot.pose.x == pytest.approx(0.3 * 600, abs=0.01)
    spread = 0.1 * 0.3 * 0.01 * math.sqrt(60_000)  # of so many independent steps
    assert 0.0 < abs(robot.odometry.x - robot.pose.x) < 4 * spread
    assert robot.odometry_twist.v != robot.twist.v
    assert robot.odometry_twist.v == pytest.approx(robot.twist.v, rel=0.5)


def test_odometry_goes_where_its_own_twist_says() -> None:
    noise = "odom: {noise: {v: 0.1, w: 0.1}}"
    made = world(f"pose: [4, 2, 0], {noise}")
    robot = drive(made, 2.0, 0.3, 0.5)
    for _ in range(40):
        before, said, true = robot.odometry, robot.odometry_twist, robot.twist
        robot.command(0.3, 0.5)
        made.step()
        after = robot.odometry
        assert wrapped(after.theta - before.theta) == pytest.approx(said.w * 0.01)
        assert math.dist((after.x, after.y), (before.x, before.y)) == pytest.approx(said.v * 0.01, rel=1e-4)
        assert said != true


def test_a_lidar_that_is_not_there_is_named() -> None:
    blind = World(load_world("w.yaml", text="robots: [{name: r, pose: [1, 1], sensors: [{imu: imu}]}]")).robots["r"]
    with pytest.raises(NotFoundError, match="no lidar named 'scan' in robot 'r'"):
        blind.scan()
    seeing = World(load_world("w.yaml", text="robots: [{name: r, pose: [1, 1], sensors: [{lidar: front}]}]")).robots[
        "r"
    ]
    with pytest.raises(NotFoundError, match=r"no lidar named 'frnt' in robot 'r' \(did you mean 'front'\?\)"):
        seeing.scan("frnt")
