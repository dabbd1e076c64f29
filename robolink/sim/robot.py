"""A robot in a world: what it is told, where it is, what it senses and what it runs into."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import pymunk

from robolink.sim.arithmetic import sinc
from robolink.sim.bodies import body_at, placed, solids
from robolink.sim.contacts import Contacts, Touches
from robolink.sim.description import Pose, RobotDescription, Wall
from robolink.sim.drive import Driver
from robolink.sim.fleet import Fleet, Member
from robolink.sim.lidar import Scan
from robolink.sim.motion import Motion
from robolink.sim.noise import stream
from robolink.sim.odometry import OdometryNoise, wrapped
from robolink.sim.placing import WorldError, check_place, check_pose
from robolink.sim.readings import Velocity, WheelState
from robolink.sim.scene import Scene
from robolink.sim.sensors import LidarSensor, device


class Parts(NamedTuple):
    """The parts of a world that each robot has to do with."""

    space: pymunk.Space
    scene: Scene
    fleet: Fleet
    contacts: Contacts
    dt: float
    seed: int
    walls: tuple[Wall, ...]


class Robot:
    """One robot of a `World`, which makes it and moves it. Its pose is that of its shape's origin, base_link."""

    def __init__(self, description: RobotDescription, parts: Parts) -> None:
        self.description, self.name = description, description.name
        self.dt, self.scene, self._parts = parts.dt, parts.scene, parts
        self.body = body_at(description.pose, description.mass, description.shape)
        self.shapes = solids(description.shape, self.body)
        self.touches = Touches(self.body)
        self._driver = Driver(description, self.body, parts.dt)
        noise = description.odom.noise
        random = stream(parts.seed, self.name, "odom")
        self._noise = OdometryNoise(noise, random) if noise.v or noise.w else None
        self._member = Member(self.body, self._driver.motion, self._noise)
        self.devices = {each.topic: device(each, self, parts.seed) for each in description.sensors}

    def enter(self) -> None:
        """Come into the world."""
        self._parts.space.add(self.body, *self.shapes)
        self._parts.contacts.add(self.touches, self.shapes)
        self._parts.scene.add(self.body, self.description.shape)
        self._parts.fleet.add(self._member)

    def leave(self) -> None:
        """Go out of the world."""
        self._parts.space.remove(self.body, *self.shapes)
        self._parts.contacts.remove(self.touches, self.shapes)
        self._parts.scene.remove(self.body)
        self._parts.fleet.remove(self._member)

    def command(self, v: float, w: float, sideways: float = 0.0) -> None:
        """Drive at `v` m/s, turn at `w` rad/s and go left at `sideways` m/s, until the drive's timeout.

        That is cut to the drive's limits, and only `omni` goes sideways. `ackermann` steers so that it goes on the
        circle that v and w make; it doesn't turn on the spot. Raises `CommandError` when it is not finite.
        """
        self._driver.command(v, w, sideways, self.scene.step)
        self._parts.fleet.told(self._member)

    def turn_wheels(self, speeds: Mapping[str, float]) -> None:
        """Turn motors at speeds in rad/s, each until it is told otherwise or a velocity command comes.

        Motors have no timeout. The speeds are cut to each motor's own, and all by one share to the drive's limits.
        Raises `NotFoundError` for a motor that is not there, `CommandError` for a speed that is not finite.
        """
        self._driver.turn_wheels(speeds)
        self._parts.fleet.told(self._member)

    def teleport(self, pose: Pose) -> None:
        """Stand at another place at once, at rest; odometry doesn't notice, and a command goes on.

        Raises `WorldError` when that is inside of something, or no place at all; the robot stays where it was.
        """
        check_pose(self.name, pose)
        before = self.pose
        try:
            self._put(pose)
            check_place(self._parts.space, self.shapes, self.name, pose, self._parts.walls)
        except WorldError:
            self._put(before)
            raise
        self.body.velocity, self.body.angular_velocity = (0.0, 0.0), 0.0
        self._parts.fleet.rest(self._member)

    def _put(self, pose: Pose) -> None:
        placed(self.body, pose)
        self._parts.space.reindex_shapes_for_body(self.body)
        self.scene.moved()

    @property
    def motion(self) -> Motion[float]:
        """What drives the robot, as it is now."""
        return self._parts.fleet.motion(self._member)

    @property
    def pose(self) -> Pose:
        """Where the robot truly is, theta in [-pi, pi]."""
        return Pose(*self.body.position, wrapped(self.body.angle))

    @property
    def odometry(self) -> Pose:
        """Where the robot is by its own speeds, in the world's frame (it starts at its true pose)."""
        x, y, theta = self._parts.fleet.odometry(self._member)
        return Pose(x, y, wrapped(theta))

    @property
    def twist(self) -> Velocity:
        """The robot's true speeds along, about and across its heading."""
        return Velocity(*self._speeds())

    def _speeds(self) -> tuple[float, float, float]:
        body = self.body
        (vx, vy), w = body.velocity, body.angular_velocity
        half = w * self.dt / 2
        middle = body.angle + half
        cos, sin, chord = math.cos(middle), math.sin(middle), sinc(half)
        return (vx * cos + vy * sin) / chord, w, (vy * cos - vx * sin) / chord

    @property
    def odometry_twist(self) -> Velocity:
        """The robot's speeds as odometry believes them: with its noise, and without slipping."""
        v, w, sideways = self._speeds()
        if self.description.drive.type != "omni":
            sideways = 0.0
        if self._noise is None:
            return Velocity(v, w, sideways)
        of_v, of_s, of_w = self._noise.at(self.scene.step)
        return Velocity(v * of_v, w * of_w, sideways * of_s)

    @property
    def wheels(self) -> tuple[WheelState, ...]:
        """How far each wheel has turned since the start, and how fast it turns, as the robot truly goes."""
        v, w, sideways = self.twist
        return self._driver.wheels(self.motion, v, sideways, w)

    @property
    def contacts(self) -> int:
        """How many things the robot has run into since the start."""
        return self.touches.contacts

    @property
    def touching(self) -> int:
        """How many things the robot touches now."""
        return self.touches.touching

    @property
    def penetration(self) -> float:
        """The deepest that the robot has ever been inside something, in metres."""
        return self.touches.penetration

    def scan(self, sensor: str | None = None) -> Scan:
        """Measure with a lidar (the first one by default); each call is a new measurement.

        Raises `KeyError` when the robot has no such lidar.
        """
        lidars = {topic: each for topic, each in self.devices.items() if isinstance(each, LidarSensor)}
        name = sensor if sensor is not None else next(iter(lidars), "")
        return lidars[name].measure()
