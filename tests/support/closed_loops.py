"""Closed-loop control tests without a transport: robots drive in a world under a controller of pure functions."""

from __future__ import annotations

import functools
import itertools
import math
from typing import Any

import msgspec
import numpy as np

from robolink import Time
from robolink.control.laser import seconds_between
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Header
from robolink.sim import Pose, Scan, World, WorldDescription, load_world
from robolink.sim.sensors import Lidar
from tests.support.nodefiles import ROOT, load_node_file

reactive, follower = load_node_file("reactive_controller"), load_node_file("wall_follower")

SETTLED = 30.0
"""Seconds in which a robot at 0.3 m/s comes to a wall from anywhere in the cornered room, and has settled there."""

DT = 0.02
"""Steps twice as long as usual save time, and change nothing that shows here."""


class Controller:
    """A controller as its node runs it: each call gives the command for a scan."""

    last: LaserScan | None = None

    def __call__(self, scan: LaserScan) -> Twist:
        seconds, self.last = seconds_between(self.last, scan), scan
        return self.decide(scan, seconds)

    def decide(self, scan: LaserScan, seconds: float) -> Twist:
        raise NotImplementedError


class Reactive(Controller):
    def __init__(self, **settings: Any) -> None:
        self.settings, self.side = reactive.Settings(**settings), 0

    def decide(self, scan: LaserScan, seconds: float) -> Twist:
        twist: Twist
        twist, self.side, _ = reactive.steer(scan, self.settings, self.side, seconds)
        return twist


class Follower(Controller):
    def __init__(self, **goal: Any) -> None:
        self.goal, self.memory = follower.Goal(**goal), follower.Memory()

    def decide(self, scan: LaserScan, seconds: float) -> Twist:
        twist: Twist
        twist, self.memory, _ = follower.follow(scan, self.goal, self.memory, seconds)
        return twist


class Run:
    """What a controller makes of a world's robot in so many seconds; a scan takes a step to take effect."""

    def __init__(self, description: WorldDescription, controller: Controller, seconds: float) -> None:
        world = self.world = World(description)
        (self.robot,) = world.robots.values()
        self.period = 1.0 / self.robot.description.sensors[0].rate
        self.path, self.speeds = list[Pose](), list[float]()
        steps = round(self.period / description.world.dt)
        for _ in range(round(seconds / self.period)):
            twist = controller(message(self.robot.scan(), world.time_ns, self.period))
            world.step()
            self.robot.command(twist.linear.x, twist.angular.z)
            for _ in range(steps - 1):
                world.step()
            self.path.append(self.robot.pose)
            self.speeds.append(abs(self.robot.twist.v))

    def driven(self) -> float:
        """The length of the way in metres."""
        return sum(math.dist((one.x, one.y), (other.x, other.y)) for one, other in itertools.pairwise(self.path))

    def rms(self, distance: float, after: float) -> float:
        """The root mean square of the distance error, from `after` seconds on."""
        path = self.path[round(after / self.period) :]
        errors = np.array([self.world.nearest_wall_distance(pose.x, pose.y) for pose in path]) - distance
        return float(np.sqrt((errors**2).mean()))

    def in_motion(self) -> float:
        """The share of the time in which the robot was faster than 5 cm/s."""
        return float(np.mean(np.array(self.speeds) > 0.05))

    def cells(self) -> int:
        """How many squares of a metre it has come to."""
        return len({(math.floor(pose.x), math.floor(pose.y)) for pose in self.path})

    def laps(self) -> float:
        """How often the heading has gone round, counter-clockwise."""
        headings = np.unwrap([pose.theta for pose in self.path])
        return float(headings[-1] - headings[0]) / math.tau


def follow(seed: int, seconds: float, goal: dict[str, Any] | None = None, **lidar: Any) -> Run:
    """Follow the walls of the cornered room from a random start."""
    pose = random_start("corners", seed)
    return Run(world("corners", pose, seed, DT, **lidar), Follower(**(goal or {})), seconds)


def wander(seed: int, seconds: float, settings: dict[str, Any] | None = None, **lidar: Any) -> Run:
    """Wander among obstacles from a random start."""
    pose = random_start("obstacles", seed)
    return Run(world("obstacles", pose, seed, DT, **lidar), Reactive(**(settings or {})), seconds)


LIDARS: dict[str, dict[str, Any]] = {
    "90 degrees": {"fov": 90.0, "beams": 91},
    "180 degrees": {"fov": 180.0, "beams": 181},
    "270 degrees, turned": {"fov": 270.0, "beams": 271, "start": -90.0},
    "from the left, few beams": {"start": 90.0, "beams": 36},
    "noise and dropout": {"noise": 0.02, "dropout": 0.2},
    "seldom": {"rate": 2.0},
}


def message(scan: Scan, time_ns: int = 0, period: float = 0.0) -> LaserScan:
    """The message of a scan."""
    fields = {name: getattr(scan, name) for name in ("angle_min", "angle_max", "angle_increment")}
    limits = {name: getattr(scan, name) for name in ("range_min", "range_max", "ranges")}
    header = Header(stamp=Time(nanoseconds=time_ns).to_msg())
    return LaserScan(header=header, scan_time=period, **fields, **limits)


@functools.cache
def loaded(name: str) -> WorldDescription:
    """One of the repository's worlds."""
    return load_world(ROOT / "configs" / "worlds" / f"{name}.yaml")


def world(name: str, pose: Pose | None = None, seed: int = 0, dt: float = 0.01, **lidar: Any) -> WorldDescription:
    """One of the repository's worlds, with its robot at a pose and its lidar changed."""
    description = loaded(name)
    (robot,) = description.robots
    (usual,) = (each for each in robot.sensors if isinstance(each, Lidar))
    sensor = msgspec.structs.replace(usual, **lidar)
    robot = msgspec.structs.replace(robot, pose=pose or robot.pose, sensors=(sensor,))
    settings = msgspec.structs.replace(description.world, seed=seed, dt=dt)
    return msgspec.structs.replace(description, world=settings, robots=(robot,))


def random_start(name: str, seed: int, clearance: float = 0.25) -> Pose:
    """A pose within the room that a world's first wall makes, so far from all that is in it."""
    description = loaded(name)
    empty = World(msgspec.structs.replace(description, robots=()))
    assert description.world.size is not None
    random, (width, height) = np.random.default_rng(seed), description.world.size
    while True:
        pose = Pose(random.uniform(0, width), random.uniform(0, height), random.uniform(-math.pi, math.pi))
        if not is_inside(description.walls[0].polyline, pose):
            continue
        gaps = [
            math.hypot(each.start.x - pose.x, each.start.y - pose.y) - each.outer_radius()
            for each in description.obstacles
        ]
        if min(empty.nearest_wall_distance(pose.x, pose.y), *gaps, 9.0) > clearance:
            return pose


def is_inside(polygon: tuple[tuple[float, float], ...], pose: Pose) -> bool:
    """Whether a pose lies within a polygon: a ray from there crosses its edges an odd number of times."""
    edges = zip(polygon, (*polygon[1:], polygon[0]), strict=True)
    crossed = [
        pose.x < x1 + (pose.y - y1) * (x2 - x1) / (y2 - y1)
        for (x1, y1), (x2, y2) in edges
        if (y1 > pose.y) != (y2 > pose.y)
    ]
    return sum(crossed) % 2 == 1
