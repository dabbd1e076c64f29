"""Drives through simulated worlds, with what a lidar and spoiled odometry measured on the way, for mapping."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import yaml

from robolink.geometry.plane import Pose, seen_from
from robolink.sim import World, load_world
from robolink.sim.description import Obstacle, WorldDescription
from robolink.sim.sensing.scene import fixed_circles, fixed_segments

Floats = npt.NDArray[np.float64]

WORLDS = Path(__file__).parents[2] / "configs/worlds"
TOURS = {
    "lab": "5 1, 5.2 3.6, 7 3.6, 9 1.6, 7.2 1, 7 3.6, 5.2 3.6, 5 6.6, 2.6 6.2, 2.2 3.8, 1 1.2",
    "office": "2.2 4, 2.2 2, 2.9 1.6, 2.2 2.2, 2.2 3.9, 5 4.2, 5 6, 3.6 6.6, 5 5.8, 5 4, 6.5 3.8, 6.5 1.8, "
    "7.8 1.4, 6.5 2, 6.5 3.6, 8.4 3.6, 8.4 5.8, 8.4 3.5, 11 3.6, 11 2, 9.4 1.8, 11 2.2, 11 4, "
    "11.6 4.2, 11.6 6.2, 11.6 4.2, 8.4 3.5, 5 4, 1.5 4.2, 1.5 6, 1.5 4",
    "warehouse": "13.1 4.5, 13.1 7.5, 2.9 7.5, 2.9 4.5, 13.1 4.5, 15.2 6, 18 8, 18 2, 18.2 7, 15.5 9, 13.1 7.5, "
    "2.9 7.5, 2.9 4.5",
}
"""Places that a robot drives to in turn, in metres, again and again."""
ERRORS = {"scale": {"v": 1.03, "w": 0.97}, "drift": 0.01, "noise": {"v": 0.05, "w": 0.05}}
"""Odometry that believes in 3 % too much way, 3 % too little turn, and 0.01 rad a metre that there are not."""


class Drive(NamedTuple):
    """Measurements of a drive, a row for each scan.

    `segments` and `circles` are the walls and fixed obstacles of the world, `moved` where things were that move or can
    be pushed: rows of x, y and a radius around all of it, in metres.
    """

    truth: Floats
    odometry: Floats
    ranges: Floats
    angles: Floats
    segments: Floats
    circles: Floats
    moved: Floats


def described(name: str, *, movers: bool = True) -> dict[str, Any]:
    """Return the description of a world that comes along, with one small robot, whose odometry is spoiled."""
    world: dict[str, Any] = yaml.safe_load((WORLDS / f"{name}.yaml").read_text(encoding="utf-8"))
    lidar = {"lidar": "scan", "beams": 360, "range": [0.12, 12], "noise": 0.01, "dropout": 0.005}
    robot = {"name": "robot", "pose": world["robots"][0]["pose"], "shape": {"circle": 0.17}}
    robot |= {"drive": {"v_max": 0.6, "w_max": 2.0}, "odom": {"rate": 50, **ERRORS}, "sensors": [lidar]}
    world["robots"] = [robot]
    if not movers:
        world["obstacles"] = [each for each in world["obstacles"] if "path" not in each and "mass" not in each]
    if name == "office":  # whose corridor leads outside
        world["walls"] = [{"polyline": [[-0.05, 2.9], [-0.05, 5.1]]}]
    if "map" in world:
        world["map"]["yaml"] = str(WORLDS / world["map"]["yaml"])
    return world


def driven(folder: Path, name: str, seconds: float, seed: int = 0, *, movers: bool = True, rate: float = 10.0) -> Drive:
    """Drive on the tour of a world and return what was measured; `folder` is for the world's file."""
    file = folder / f"{name}.yaml"
    file.write_text(yaml.safe_dump(described(name, movers=movers)), encoding="utf-8")
    description = load_world(file)
    world, driver = World(description, seed=seed), Driver(tour(name))
    robot, between = world.robots["robot"], round(1e9 / rate / world_step(description))
    angles: Any = np.empty(0)
    truth, odometry, scans = [], [], []
    sizes = [_radius(each) for each in description.obstacles]
    moved = set()
    for step in range(round(seconds * 1e9 / world_step(description))):
        if step % between == 0:
            scan = robot.scan()
            angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
            truth.append(Pose(robot.pose.x, robot.pose.y, robot.pose.theta))
            odometry.append((robot.odometry.x, robot.odometry.y, robot.odometry.theta))
            scans.append(np.array(scan.ranges))
            places = zip(world.obstacle_poses(), sizes, strict=True)
            moved |= {(round(place.x, 1), round(place.y, 1), size) for place, size in places if size}
            robot.command(*driver.speeds(truth[-1], scans[-1], angles))
        world.step()
    walls = fixed_segments(description), fixed_circles(description)
    things = np.array(sorted(moved), np.float64).reshape(-1, 3)
    return Drive(np.array(truth), np.array(odometry), np.array(scans), angles, *walls, things)


def _radius(obstacle: Obstacle) -> float:
    """Return the radius in metres around a thing that moves or can be pushed; 0 for one that stands."""
    if obstacle.path is None and obstacle.mass is None:
        return 0.0
    return obstacle.circle or 0.5 * math.hypot(*(obstacle.box or (1.0, 1.0)))


def tour(name: str) -> list[tuple[float, float]]:
    """Return the places of a world's tour."""
    places = (each.split() for each in TOURS[name].split(","))
    return [(float(x), float(y)) for x, y in places]


def world_step(description: WorldDescription) -> int:
    """Return the nanoseconds of a world's step."""
    return round(description.world.dt * 1e9)


class Driver:
    """Drives to places in turn: straight on, slowly where something is near, and to the next one if it is stuck."""

    def __init__(self, places: list[tuple[float, float]]) -> None:
        self._places, self._next, self._stuck = places, 0, 0

    def speeds(self, pose: Pose, ranges: Floats, angles: Floats) -> tuple[float, float]:
        """Return the speeds ahead (m/s) and of turning (rad/s) for a pose and a scan."""
        goal = seen_from(pose, Pose(*self._places[self._next]))
        if math.hypot(goal.x, goal.y) < 0.25 or self._stuck > 60:
            self._next, self._stuck = (self._next + 1) % len(self._places), 0
            goal = seen_from(pose, Pose(*self._places[self._next]))
        turn = math.atan2(goal.y, goal.x)
        free = float(ranges[np.abs(angles) < 0.5].min())
        ahead = min(0.5, 0.8 * max(free - 0.3, 0.0)) * max(math.cos(turn), 0.0) ** 2
        self._stuck = self._stuck + 1 if ahead < 0.03 and abs(turn) < 0.3 else max(self._stuck - 1, 0)
        return ahead, max(-1.0, min(1.0, 2.0 * turn))


def wall_distances(drive: Drive, points: Floats) -> Floats:
    """Return the metres from points (rows of x and y) to the nearest wall or fixed obstacle of the world."""
    found = np.full(len(points), math.inf)
    for x0, y0, x1, y1 in drive.segments.reshape(len(drive.segments), -1)[:, :4].tolist():
        way = np.array([x1 - x0, y1 - y0])
        share = np.clip((points - (x0, y0)) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
        np.minimum(found, np.hypot(*(points - (x0, y0) - share[:, None] * way).T), out=found)
    for x, y, radius in drive.circles.tolist():
        np.minimum(found, np.abs(np.hypot(*(points - (x, y)).T) - radius), out=found)
    return found


def standing(drive: Drive, points: Floats) -> Floats:
    """Return those of the points at which nothing was that moves or can be pushed."""
    near = np.zeros(len(points), np.bool_)
    for x, y, radius in drive.moved.tolist():
        near |= np.hypot(*(points - (x, y)).T) < radius + 0.2
    return points[~near]
