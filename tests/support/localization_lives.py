"""Lives of a robot that wanders about in a world with people, and how far off its localization is at each moment.

The lab is drawn into a map with a corner anywhere, so that its walls lie anywhere in their cells; the office has a map.
Things that move, the lab's crate and ball and the office's parcel are not on it. Odometry drives 3 % too far, turns 3 %
too little and drifts, beside its noise.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from robolink.control.laser import returns
from robolink.geometry.plane import Pose, placed_on, pose_of, seen_from, wrapped
from robolink.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped, Twist, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_srvs.srv import Empty
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.sim.sensing.scene import fixed_circles, fixed_segments
from robolink.sim.worldfile import load_world
from robolink.testing import System

WORLDS = Path(__file__).parents[2] / "configs" / "worlds"
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
RESOLUTION = 0.05
CHI_SQUARE = 7.815
"""Squared distance, in standard deviations, within which 95 % of a normal distribution in three dimensions lie."""

STARTS = {"lab": Pose(1.0, 1.0, 0.5), "office": Pose(1.2, 4.0, 0.0)}
ROBOT = """robots:
  - name: robot
    pose: [{}, {}, {}]
    shape: {{circle: 0.17}}
    drive: {{type: diff, v_max: 0.6, w_max: 2.0}}
    odom: {{rate: 20, noise: {{v: 0.05, w: 0.05}}, scale: {{v: 1.03, w: 0.97}}, drift: 0.01}}
    ground_truth: {{rate: 20}}
    sensors: [{{lidar: scan, beams: 360, range: [0.12, 12], noise: 0.01, dropout: 0.005, offset: [0.05, 0, 0]}}]
"""
PEOPLE = """  - {circle: 0.2, path: [[2, 4.8], [12, 4.8]], speed: 0.3}
  - {circle: 0.2, path: [[5, 0.45], [8, 0.45]], speed: 0.3}
"""


class Files(NamedTuple):
    """A world file, its map's YAML file, and where the robot begins."""

    world: Path
    chart: Path
    start: Pose


def written(name: str, folder: Path, seed: int = 0) -> Files:
    """Write a world, and its map whose corner lies somewhere by the seed."""
    text = (WORLDS / f"{name}.yaml").read_text(encoding="utf-8").split("robots:\n")[0]
    text = text.replace("maps/office.yaml", (WORLDS / "maps/office.yaml").as_posix())
    text += (PEOPLE if name == "office" else "") + ROBOT.format(*STARTS[name])
    world = folder / f"{name}.yaml"
    world.write_text(text, encoding="utf-8")
    chart = WORLDS / "maps/office.yaml" if name == "office" else drawn(world, folder, seed)
    return Files(world, chart, STARTS[name])


def drawn(world: Path, folder: Path, seed: int) -> Path:
    """Draw the fixed things of a world into a map, and return its YAML file."""
    description = load_world(world)
    x, y, radius = fixed_circles(description).T[:, :, None]
    turn = np.linspace(0, math.tau, 90)
    lines = [*_points(fixed_segments(description)), np.array([x + radius * np.cos(turn), y + radius * np.sin(turn)])]
    points = np.concatenate([each.reshape(2, -1) for each in lines], axis=1)
    corner = points.min(axis=1) - 0.3 - np.random.default_rng(seed).uniform(0, RESOLUTION, 2)
    column, row = ((points - corner[:, None]) / RESOLUTION).astype(int)
    shades = np.full((row.max() + 7, column.max() + 7), 254, np.uint8)
    shades[row, column] = 0
    (folder / "map.pgm").write_bytes(b"P5 %d %d 255\n" % shades.shape[::-1] + shades[::-1].tobytes())
    chart = folder / "map.yaml"
    chart.write_text(
        f"image: map.pgm\nresolution: {RESOLUTION}\norigin: [{corner[0]}, {corner[1]}, 0]\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.1\nnegate: 0\n",
        encoding="utf-8",
    )
    return chart


def _points(segments: Any) -> list[Any]:
    """Return points along segments, rows x1, y1, x2, y2."""
    share = np.linspace(0, 1, 1500)
    return [np.array([a + (c - a) * share, b + (d - b) * share]) for a, b, c, d in segments]


class Wanderer(Node):
    """Node that drives to where there is room, and out of the way of what comes near."""

    def __init__(self, **options: Any) -> None:
        super().__init__("wanderer", **options)
        self.random = np.random.default_rng(self.declare_parameter("seed", 0).value)
        self.liking, self.scans = 0.0, 0
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        """Turn to the best direction, and drive as fast as there is room ahead."""
        if self.scans % 40 == 0:
            self.liking = self.random.uniform(-1.5, 1.5)
        self.scans += 1
        angles, ranges = returns(scan)
        if not len(ranges):
            return
        away = wrapped(float(angles[ranges.argmin()]) + math.pi)
        fear = 2.0 * max(0.0, 0.5 - float(ranges.min()))
        choices = np.linspace(-math.pi, math.pi, 24, endpoint=False)
        rooms = [_room(angles, ranges, each) for each in choices]
        worth = np.minimum(rooms, 1.2) + 0.3 * np.cos(choices - self.liking) + 0.4 * np.cos(choices)
        turn = float(choices[(worth + fear * np.cos(choices - away)).argmax()])
        ahead = _room(angles, ranges, 0.0)
        speed = 0.45 * max(0.0, math.cos(turn)) * min(1.0, max(0.0, ahead - 0.25) / 0.4)
        self.cmd_vel.publish(Twist(linear=Vector3(x=speed), angular=Vector3(z=max(-1.2, min(1.2, 1.5 * turn)))))


def _room(angles: Any, ranges: Any, direction: float) -> float:
    gaps = np.abs(np.remainder(angles - direction + math.pi, math.tau) - math.pi)
    return float(ranges[gaps < 0.5].min(initial=3.0))


class Moment(NamedTuple):
    """Error of the pose by transforms at a time: metres and radians."""

    seconds: float
    distance: float
    turn: float


class Judge:
    """Comparison of what localization publishes with the truth. Times are in seconds."""

    def __init__(self, system: System) -> None:
        self.truths, self.poses, self.times = list[Pose](), list[PoseWithCovarianceStamped](), list[float]()
        self.moments, self.shoves = list[Moment](), 0.0
        self._odometry: tuple[float, Pose] | None = None
        self._before: tuple[Pose, Pose] | None = None
        self._origin: Pose | None = None
        node = system.node
        node.create_subscription(Odometry, "/odom", self.on_odometry, 10)
        node.create_subscription(Odometry, "/ground_truth", self.on_truth, 10)
        node.create_subscription(TFMessage, "/tf", self.on_tf, 100)
        node.create_subscription(PoseWithCovarianceStamped, "/amcl_pose", self.poses.append, LATCHED)

    def on_odometry(self, message: Odometry) -> None:
        self._odometry = _time(message), pose_of(message.pose.pose)
        self._compare()

    def on_tf(self, message: TFMessage) -> None:
        for each in message.transforms:
            if each.header.frame_id == "map":
                place, turn = each.transform.translation, each.transform.rotation
                self._origin = Pose(place.x, place.y, 2 * math.atan2(turn.z, turn.w))

    def on_truth(self, message: Odometry) -> None:
        self.truths.append(pose_of(message.pose.pose))
        self.times.append(_time(message))
        self._compare()

    def _compare(self) -> None:
        """Note the error, once both the truth and odometry of a time are there."""
        if self._odometry is None or not self.times or self.times[-1] != self._odometry[0]:
            return
        truth, odometry = self.truths[-1], self._odometry[1]
        if self._before is not None:
            true, measured = seen_from(self._before[0], truth), seen_from(self._before[1], odometry)
            slip = abs(math.hypot(*true[:2]) - math.hypot(*measured[:2]) / 1.03)
            self.shoves += slip if slip > 0.006 else 0.0
        self._before = truth, odometry
        if self._origin is not None:
            found = placed_on(self._origin, odometry)
            self.moments.append(
                Moment(self.times[-1], math.dist(found[:2], truth[:2]), abs(wrapped(found.theta - truth.theta)))
            )

    def truth(self, seconds: float) -> Pose:
        """Return the true pose at a time, between the moments that the world has published."""
        after = min(max(bisect.bisect_left(self.times, seconds), 1), len(self.times) - 1)
        first, way = self.truths[after - 1], seen_from(self.truths[after - 1], self.truths[after])
        share = (seconds - self.times[after - 1]) / (self.times[after] - self.times[after - 1])
        return placed_on(first, Pose(way.x * share, way.y * share, way.theta * share))

    def nees(self, since: float = 0.0) -> list[float]:
        """Return the squared errors of the published poses from a time on, in units of their covariances."""
        found = []
        for each in self.poses:
            at = _time(each)
            if at >= since and self.times[0] <= at <= self.times[-1]:
                pose, truth = pose_of(each.pose.pose), self.truth(at)
                gap = np.array([pose.x - truth.x, pose.y - truth.y, wrapped(pose.theta - truth.theta)])
                whole = np.array(each.pose.covariance).reshape(6, 6)
                covariance = whole[np.ix_((0, 1, 5), (0, 1, 5))]
                found.append(float(gap @ np.linalg.solve(covariance, gap)))
        return found

    def rms(self, since: float = 0.0) -> tuple[float, float]:
        """Return the root mean squares of the errors from a time on: metres, and degrees."""
        chosen = np.array([each[1:] for each in self.moments if each.seconds >= since])
        distance, turn = np.sqrt((chosen**2).mean(axis=0))
        return float(distance), math.degrees(turn)

    def held(self, since: float = 0.0) -> float:
        """Return the share of published poses whose covariance holds the truth, by its ellipsoid of 95 %."""
        return float((np.array(self.nees(since)) < CHI_SQUARE).mean())

    def found_at(self, distance: float = 0.5, turn: float = 0.35) -> float:
        """Return when the error became less than a distance and a turn for good; inf if it did not."""
        lost = [each.seconds for each in self.moments if each.distance > distance or each.turn > turn]
        if not self.moments or (lost and lost[-1] == self.moments[-1].seconds):
            return math.inf
        return next((each.seconds for each in self.moments if not lost or each.seconds > lost[-1]), math.inf)


def _time(message: Any) -> float:
    stamp = message.header.stamp
    return float(stamp.sec + stamp.nanosec * 1e-9)


def start(
    system: System, files: Files, seed: int = 0, *, wander: bool = True, publish_clock: bool = False, **values: Any
) -> None:
    """Start a world, its map, AMCL and a robot that wanders; `values` are AMCL's parameters."""
    world = {"world": str(files.world), "seed": seed, "publish_map": False, "publish_clock": publish_clock}
    system.start("world", parameters=world)
    system.start("nav2_map_server map_server", parameters={"yaml_filename": str(files.chart)})
    system.start("nav2_amcl amcl", parameters={"base_frame_id": "base_link", "random_seed": seed, **values})
    names: Mapping[str, Any] = {"node_names": ["map_server", "amcl"], "autostart": True}
    system.start("nav2_lifecycle_manager lifecycle_manager", parameters=names)
    if wander:
        system.start(Wanderer, parameters={"seed": seed})


def initial(pose: Pose) -> dict[str, Any]:
    """Return the parameters of AMCL that make it begin at a pose."""
    x, y, theta = map(float, pose)
    named = {"initial_pose.x": x, "initial_pose.y": y, "initial_pose.yaw": theta}
    return {"set_initial_pose": True, **named}


def track(system: System, files: Files, seed: int, seconds: float = 180.0, **values: Any) -> Judge:
    """Let a robot wander that knows where it begins, with 1,000 particles."""
    judge = Judge(system)
    start(system, files, seed, **{"max_particles": 1000, **initial(files.start), **values})
    system.run(seconds)
    return judge


def search(system: System, files: Files, seed: int, seconds: float = 60.0, **values: Any) -> tuple[Judge, float]:
    """Let a robot wander that does not know where it is, with 3,000 particles; return when it began to search, too."""
    judge = Judge(system)
    start(system, files, seed, **{"max_particles": 3000, **values})
    system.run(3.0 + seed)  # somewhere else with each seed
    began = system.time
    system.call(Empty, "/reinitialize_global_localization")
    system.run(seconds)
    return judge, began
