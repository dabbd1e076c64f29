"""A robot in a world: what it is told, where it is, what it senses and what it runs into."""

from __future__ import annotations

import math
from typing import NamedTuple

import pymunk

from robolink.sim.bodies import body_at, solid
from robolink.sim.description import Lidar, Pose, RobotDescription, WorldDescription
from robolink.sim.drive import DiffDrive, along
from robolink.sim.lidar import Beams, Scan, distances, limited
from robolink.sim.noise import LidarNoise, stream
from robolink.sim.odometry import Odometry, wrapped
from robolink.sim.scene import Scene


class Velocity(NamedTuple):
    """Forward speed in m/s and turning speed in rad/s, counter-clockwise."""

    v: float
    w: float


class LidarSensor:
    """A lidar on a robot."""

    def __init__(self, lidar: Lidar, noise: LidarNoise) -> None:
        self.description = lidar
        self.beams = Beams(lidar)
        self._noise = noise

    def scan(self, robot: pymunk.Body, scene: Scene) -> Scan:
        """Measure once; each call draws from the sensor's random stream."""
        lidar, beams = self.description, self.beams
        exact = distances(beams, self._pose_on(robot), *scene.around(robot))
        ranges = limited(self._noise.disturbed(exact), *lidar.range)
        angle_max = beams.start + (beams.count - 1) * beams.increment
        return Scan(beams.start, angle_max, beams.increment, *lidar.range, ranges)

    def _pose_on(self, robot: pymunk.Body) -> Pose:
        offset, (x, y), theta = self.description.offset, robot.position, robot.angle
        cos, sin = math.cos(theta), math.sin(theta)
        return Pose(x + cos * offset.x - sin * offset.y, y + sin * offset.x + cos * offset.y, theta + offset.theta)


class Robot:
    """One robot of a `World`, which makes it, moves it and counts its contacts.

    `contacts` counts what it has run into since the start, `touching` what it touches now, `penetration` is the
    deepest that it has ever been inside something, in metres.
    """

    def __init__(self, robot: RobotDescription, world: WorldDescription, scene: Scene, seed: int) -> None:
        self.description, self.name = robot, robot.name
        self.body = body_at(robot.pose, robot.mass, robot.shape)
        self.shape = solid(robot.shape, self.body)
        self.drive = DiffDrive(robot.drive, self.body, robot.shape.outer_radius(), world.world.dt)
        self.sensors = {each.lidar: _sensor(each, robot, seed) for each in robot.sensors}
        self.contacts = self.touching = 0
        self.penetration = 0.0
        self._odometry = Odometry(*_numbers(robot.pose))
        self._scene, self.dt = scene, world.world.dt
        scene.add(self.body, robot.shape)

    def command(self, v: float, w: float) -> None:
        """Drive at `v` m/s and turn at `w` rad/s, within the robot's limits, until the drive's timeout.

        Raises `CommandError` when it is not finite.
        """
        self.drive.command(v, w, self._scene.step)

    def advance(self) -> None:
        """Prepare a step: push the body, and count into the odometry the arc that the step makes."""
        self.drive.push(self.body, self._scene.step)
        self._odometry.advance(self.drive.v, self.drive.w, self.dt)

    @property
    def pose(self) -> Pose:
        """Where the robot truly is, theta in [-pi, pi]."""
        return Pose(*self.body.position, wrapped(self.body.angle))

    @property
    def odometry(self) -> Pose:
        """Where the robot is by its own speeds, in the world's frame (it starts at its true pose)."""
        return Pose(self._odometry.x, self._odometry.y, wrapped(self._odometry.theta))

    @property
    def twist(self) -> Velocity:
        """The robot's true speeds along and about its heading."""
        w = self.body.angular_velocity
        half = w * self.dt / 2
        return Velocity(along(self.body.velocity, self.body.angle + half, half)[0], w)

    def scan(self, sensor: str | None = None) -> Scan:
        """Measure with a lidar (the first one by default); each call is a new measurement.

        Raises `KeyError` when the robot has no such sensor.
        """
        name = sensor if sensor is not None else next(iter(self.sensors), "")
        return self.sensors[name].scan(self.body, self._scene)


def _sensor(lidar: Lidar, robot: RobotDescription, seed: int) -> LidarSensor:
    return LidarSensor(lidar, LidarNoise(lidar, stream(seed, robot.name, lidar.lidar)))


def _numbers(pose: Pose) -> tuple[float, float, float]:
    return pose.x, pose.y, pose.theta
