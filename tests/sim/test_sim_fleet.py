"""Few robots and many are driven by the same formulas: to the last bit, also without pymunk's batch calls."""

from __future__ import annotations

import hashlib
import math
import os
import subprocess
import sys
from pathlib import Path

import pymunk
import pytest
from pymunk.batch import BodyFields

from robolink.sim import Pose, Scan, World, load_world
from robolink.sim.driving import fleet
from robolink.sim.physics import body_columns
from robolink.sim.physics.body_columns import BodyColumns
from robolink.sim.physics.placing import WorldError

DRIVES = ("type: diff", "type: omni", "type: ackermann, wheelbase: 0.15, w_max: 4")
WHEELS = "{motor: a, at: [0, 0.05, 0]}, {motor: b, at: [0, -0.05, 0]}"
ASIDE = "{motor: c, at: [0.05, 0, 1.5]}"
SENSORS = (
    "{lidar: scan, beams: 24, noise: 0.01}, {imu: imu}, {bumper: bumper}, {encoders: encoders}, {range_finder: sonar}"
)
LIFE = """
walls: [{polyline: [[0, 0], [6, 0], [6, 6], [0, 6]], closed: true}]
obstacles:
  - {circle: 0.2, pose: [3, 5.5], mass: 1.0}
  - {polygon: [[-0.3, -0.3], [0.3, -0.3], [0.3, 0], [0, 0], [0, 0.3], [-0.3, 0.3]], pose: [5.4, 5.4, 0.4], mass: 2.0}
  - {box: [0.3, 0.3], path: [[0.3, 5.5], [2.5, 5.5]], speed: 0.4}
robots:
"""


def lively(robots: int = 12) -> World:
    """Robots of all kinds, close enough to run into each other, walls, crates and what moves."""
    lines = []
    for index in range(robots):
        x, y, turn = 0.5 + 0.9 * (index % 6), 0.6 + 0.9 * (index // 6), index % 6 - 3
        wheels = f"{WHEELS}, {ASIDE}" if index % 3 == 1 else WHEELS
        shape = "circle: 0.15" if index % 2 else "box: [0.3, 0.2]"
        place = f"name: r{index}, pose: [{x:.2f}, {y:.2f}, {turn}], shape: {{{shape}}}"
        drive = (
            f"drive: {{{DRIVES[index % 3]}}}, wheels: [{wheels}], odom: {{noise: {{v: {0.02 * (index % 2)}, w: 0.01}}}}"
        )
        lines.append(f"  - {{{place}, {drive}, sensors: [{SENSORS}]}}")
    return World(load_world("lively.yaml", text=LIFE + "\n".join(lines)))


def disturb(world: World, step: int) -> None:
    """Take robots away, hold some for a while, and let others jump and come."""
    if step == 150:
        world.delete("r3")
    if step in (200, 290):
        for name in ("r1", "r2", "r4"):
            (world.robots[name].hold if step == 200 else world.robots[name].release)()
    if step == 300:
        world.robots["r5"].teleport(Pose(3.0, 3.9, 1.0))
        world.spawn(world.robots["r1"].description.__class__("late", Pose(1.0, 4.0)))


def live(world: World, seconds: float) -> str:
    """Drive about, with robots that come, go and jump; give a digest of all that is true, believed and sensed."""
    digest = hashlib.sha256()
    for step in range(round(seconds * 100)):
        for index, robot in enumerate(world.robots.values()):
            if step % 30 == index % 30:
                v, w = 0.5 * math.sin(0.01 * step + index), 2 * math.cos(0.013 * step * index)
                if index % 4:
                    robot.command(v, w, v / 2)
                else:
                    robot.turn_wheels({"a": 10 * v, "b": 10 * w})
        disturb(world, step)
        world.step()
        for robot, sensor, value in world.readings():
            seen = value.ranges.tobytes() if isinstance(value, Scan) else repr(value).encode()
            digest.update(robot.name.encode() + sensor.topic.encode() + seen)
        if step % 10 == 0:
            for robot in world.robots.values():
                true = (robot.pose, robot.twist, robot.touching, robot.contacts, robot.penetration)
                digest.update(repr((*true, robot.odometry, robot.odometry_twist, robot.wheels)).encode())
    return digest.hexdigest()


@pytest.mark.slow
def test_many_robots_live_as_few_do_to_the_last_bit(monkeypatch: pytest.MonkeyPatch) -> None:
    lives = []
    for many in (1000, 1):
        monkeypatch.setattr(fleet, "MANY", many)
        lives.append(live(lively(), 6.0))
    assert lives[0] == lives[1]


def test_looking_at_a_robot_before_it_is_refused_a_place_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """A robot that was put back has turned by less than a whole turn: the sine of its angle has other last bits."""
    monkeypatch.setattr(fleet, "MANY", 1)
    ends: list[list[object]] = []
    for looks in (False, True):
        world = lively()
        for _ in range(200):
            for robot in world.robots.values():
                robot.command(0.2, 3.0)
            world.step()
        for robot in world.robots.values():
            assert not looks or math.isfinite(robot.twist.v)
            with pytest.raises(WorldError):
                robot.teleport(Pose(0.0, 0.0))
        ends.append([robot.twist for robot in world.robots.values()])
    assert ends[0] == ends[1]


@pytest.mark.slow
@pytest.mark.parametrize("many", [1000, 1])
def test_without_batch_calls_life_is_the_same(many: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fleet, "MANY", many)
    batched = live(lively(), 4.0)
    monkeypatch.setattr(body_columns, "_AVAILABLE", False)
    assert live(lively(), 4.0) == batched


def test_batch_calls_that_give_something_else_are_not_used(monkeypatch: pytest.MonkeyPatch) -> None:
    space = pymunk.Space()
    bodies = [pymunk.Body(1, 1) for _ in range(8)]
    for index, body in enumerate(bodies):
        body.velocity, body.angle = (index, 0.5), 0.1 * index
    space.add(*bodies)
    expected = [[body.angle, *body.velocity, body.angular_velocity] for body in bodies]
    assert BodyColumns(space, bodies).batched
    for name, flags in (("_READ", BodyFields.ANGLE), ("_READ", body_columns._WRITE), ("_WRITE", BodyFields.TORQUE)):
        with monkeypatch.context() as patched:
            patched.setattr(body_columns, name, flags)
            other = BodyColumns(space, bodies)
            assert not other.batched
            assert other.read_rows() == expected
            other.write([(float(index), 2.0, 3.0) for index in range(8)])
            assert [(*body.force, body.torque) for body in bodies] == [(index, 2.0, 3.0) for index in range(8)]


def test_bodies_that_come_and_go_get_their_own_forces() -> None:
    space = pymunk.Space()
    bodies = [pymunk.Body(1, 1) for _ in range(10)]
    space.add(*bodies, pymunk.Body(2, 2))
    space.remove(bodies.pop(2), bodies.pop(5))
    made = BodyColumns(space, bodies)
    made.write([(float(index), -float(index), 0.5 * index) for index in range(8)])
    assert made.batched
    assert [(*body.force, body.torque) for body in bodies] == [(index, -index, 0.5 * index) for index in range(8)]


@pytest.mark.processes
def test_two_processes_live_the_same_life_to_the_last_bit() -> None:
    """Their hashes of strings differ, and so do their memory addresses."""
    program = "from tests.sim.test_sim_fleet import lively, live; print(live(lively(), 20.0))"
    home = Path(__file__).parents[2]
    running = [
        subprocess.Popen(
            [sys.executable, "-c", program],
            cwd=home,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(home)},
            stdout=subprocess.PIPE,
            text=True,
        )
        for seed in ("1", "2")
    ]
    lives = [process.communicate()[0].strip() for process in running]
    assert len(lives[0]) == 64
    assert lives[0] == lives[1]


@pytest.mark.slow
def test_ways_and_noise_of_a_robot_do_not_depend_on_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "robots:\n- {{name: r, pose: [0, 0], odom: {{noise: {{v: 0.05, w: 0.1}}}}}}\n{}"
    others = "\n".join(f"- {{name: o{k}, pose: [{k + 3}, 4], odom: {{noise: {{v: 0.1}}}}}}" for k in range(30))
    found = []
    for more in ("", others):
        world = World(load_world("noise.yaml", text=text.format(more)))
        robot = world.robots["r"]
        for _ in range(700):
            robot.command(0.3, 0.4)
            world.step()
            found.append((robot.odometry, robot.odometry_twist, robot.pose))
    assert found[:700] == found[700:]
