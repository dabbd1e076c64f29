"""Accuracy of the simulated world, and of the controllers that drive in it: figures for `benchmarks/simulator.py`.

    python benchmarks/exactness.py

What the tests hold to a limit is measured here, by other formulas than the simulator's own where there are some.
"""

from __future__ import annotations

import json
import math
import statistics
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.lidars import Array  # noqa: E402 - found only now
from robolink.sim import Pose, World, WorldDescription  # noqa: E402
from robolink.sim.description import Drive, RobotDescription, Wall  # noqa: E402
from robolink.sim.sensing.lidar import Beams, distances  # noqa: E402
from robolink.sim.sensing.scene import standing  # noqa: E402
from robolink.sim.sensors import Lidar  # noqa: E402
from tests.support import closed_loops as loops  # noqa: E402

NOTHING_ROUND = np.empty((0, 3))
MINUTE = 6000
SHARP = Drive(v_max=16.0, a_max=500.0, alpha_max=1000.0, timeout=1000.0)


def report() -> None:
    """Print all figures, each with its goal."""
    print("\nExactness")
    print(f"  lidar beside rays cast one by one: off by {lidar_error():.1e} m at most (goal 1e-9)")
    leaks, beams = corner_leaks()
    print(f"  beams aimed at corners: {leaks} of {beams:,} leak (goal 0)")
    print(f"  odometry after a minute of arcs: off by {arc_error():.1e} m at most (goal 1e-9)")
    through, tried = tunnelling()
    print(f"  robots at 10 m/s against a wall: {through} of {tried} get through (goal 0)")
    print(f"  a robot at 0.5 m/s against a wall: {1000 * penetration():.2f} mm deep at most (goal 5)")
    print(f"  all published bytes in two processes: {'the same' if same_bytes() else 'NOT THE SAME'}")
    print("\nControllers")
    for line in closed_loops():
        print(f"  {line}")


def lidar_error(rooms: int = 200) -> float:
    """Return the largest difference in metres between the lidar and rays that are cast one by one, in random scenes."""
    random, beams, worst = np.random.default_rng(3), Beams(Lidar("scan")), 0.0
    for _ in range(rooms):
        ends = random.uniform(-8.0, 8.0, (30, 2))
        segments = np.hstack((ends, ends + random.uniform(-3.0, 3.0, (30, 2))))
        pose = Pose(*random.uniform((-2.0, -2.0, -math.pi), (2.0, 2.0, math.pi)).tolist())
        found, cast = distances(beams, pose, standing(segments, NOTHING_ROUND)), rays(pose, segments)
        near = cast < 12.0
        worst = max(worst, float(np.abs(found[near] - cast[near]).max(initial=0.0)))
    return worst


def rays(pose: Pose, segments: Array) -> Array:
    """Cast a ray for each of 360 beams, from backwards on: by solving for where it crosses each segment's line."""
    angles = pose.theta + np.radians(np.arange(360) - 180.0)
    ux, uy = np.cos(angles)[:, None], np.sin(angles)[:, None]
    dx, dy = segments[:, 2] - segments[:, 0], segments[:, 3] - segments[:, 1]
    px, py = segments[:, 0] - pose.x, segments[:, 1] - pose.y
    cross = ux * dy - uy * dx
    along, share = (px * dy - py * dx) / cross, (px * uy - py * ux) / cross
    nearest: Array = np.where((along >= 0.0) & (share >= 0.0) & (share <= 1.0), along, np.inf).min(axis=1)
    return nearest


def corner_leaks(rooms: int = 2800) -> tuple[int, int]:
    """Count the beams that see more than the corner they are aimed at, in crooked rooms with a corner for each beam."""
    random, beams, leaks = np.random.default_rng(4), Beams(Lidar("scan")), 0
    angles = np.radians(np.arange(360) - 180.0)
    for turn in random.uniform(-math.pi, math.pi, rooms).tolist():
        far = random.uniform(1.0, 5.0, 360)
        corners = far[:, None] * np.column_stack((np.cos(angles + turn), np.sin(angles + turn)))
        room = np.hstack((corners, np.roll(corners, -1, axis=0)))
        found = distances(beams, Pose(0.0, 0.0, turn), standing(room, NOTHING_ROUND))
        leaks += int((found > far + 1e-6).sum())
    return leaks, rooms * 360


def arc_error() -> float:
    """Return how far odometry and pose are from the circle after a minute, in metres, for some speeds."""
    worst = 0.0
    for v, w in ((0.5, 0.0), (0.3, 1.0), (-0.4, 0.7), (1.0, -2.0), (0.0, 1.5)):
        description = RobotDescription(name="r", pose=Pose(0.0, 0.0), drive=SHARP)
        world = World(WorldDescription(robots=(description,)))
        robot = world.robots["r"]
        robot.command(v, w)
        world.step()
        world.step()  # by now it has the speed that it was told
        x, y, theta = robot.pose.x, robot.pose.y, robot.pose.theta
        for _ in range(MINUTE):
            world.step()
        turned = theta + w * 60.0
        radius = v / w if w else 0.0
        x += radius * (math.sin(turned) - math.sin(theta)) if w else v * 60.0 * math.cos(theta)
        y += radius * (math.cos(theta) - math.cos(turned)) if w else v * 60.0 * math.sin(theta)
        worst = max(worst, *(math.dist((each.x, each.y), (x, y)) for each in (robot.pose, robot.odometry)))
    return worst


def tunnelling(angles: int = 60) -> tuple[int, int]:
    """Drive at 10 m/s against a wall from many angles for two seconds; count who is behind it."""
    through = 0
    for heading in np.linspace(-1.2, 1.2, angles).tolist():
        world = walled(heading, SHARP)
        robot = world.robots["r"]
        robot.command(10.0, 0.0)
        for _ in range(200):
            world.step()
        through += robot.pose.x > 3.0
    return through, angles


def penetration() -> float:
    """Return how deep a robot at 0.5 m/s has been inside a wall at most, in metres, from some angles."""
    deepest = 0.0
    for heading in (0.0, 0.3, 0.8, -1.1):
        world = walled(heading, Drive(timeout=1000.0))
        robot = world.robots["r"]
        robot.command(0.5, 0.0)
        for _ in range(2000):
            world.step()
        deepest = max(deepest, robot.penetration)
    return deepest


def walled(heading: float, drive: Drive) -> World:
    """Return a world with a robot, and a long wall 3 m ahead of it."""
    robot = RobotDescription(name="r", pose=Pose(0.0, 0.0, heading), drive=drive)
    return World(WorldDescription(walls=(Wall(((3.0, -60.0), (3.0, 60.0))),), robots=(robot,)))


def same_bytes() -> bool:
    """Return whether two processes publish the same in ten seconds of a noisy laboratory."""
    command = [sys.executable, "-m", "robolink", "simulate", "lab", "--duration", "10", "--json"]
    runs = [subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout for _ in range(2)]
    return len({json.loads(run.splitlines()[-1])["hash"] for run in runs}) == 1


def closed_loops() -> Iterator[str]:
    """Say how well walls are followed from 20 random starts, and how much robots drive from 10."""
    drives = [loops.follow(seed, 120.0) for seed in range(20)]
    errors = [drive.rms(0.5, loops.SETTLED) for drive in drives]
    contacts = sum(drive.robot.contacts for drive in drives)
    yield f"wall following, 20 starts: median RMS {statistics.median(errors):.3f} m (goal 0.05), {contacts} contacts"
    drives = [loops.wander(seed, 300.0) for seed in range(10)]
    contacts, least = sum(drive.robot.contacts for drive in drives), min(drive.in_motion() for drive in drives)
    metres = min(drive.driven() for drive in drives)
    yield f"reactive driving, 10 starts: at least {100 * least:.0f} % in motion (goal 60), {contacts} contacts"
    yield f"  and at least {metres:.0f} m in 300 s"


if __name__ == "__main__":
    report()
