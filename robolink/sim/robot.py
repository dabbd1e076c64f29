"""A robot in a world: what it is told, where it is, what it senses and what it runs into."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import pymunk

from robolink.exceptions import NotFoundError
from robolink.plane import Area, wrapped
from robolink.sim.description import Pose, RobotDescription, Wall
from robolink.sim.driving.arithmetic import sinc
from robolink.sim.driving.drive import Driver
from robolink.sim.driving.fleet import Fleet, Member
from robolink.sim.driving.motion import Motion
from robolink.sim.driving.odometry_noise import OdometryNoise
from robolink.sim.physics.bodies import body_at, placed, solids
from robolink.sim.physics.contacts import Contacts, Touches
from robolink.sim.physics.placing import WorldError, check_place, check_pose
from robolink.sim.readings import Scan, Velocity, WheelState
from robolink.sim.sensing.random_streams import stream
from robolink.sim.sensing.scene import Scene
from robolink.sim.sensing.sensors import Carrier, LidarSensor, device


class Robot:
    """One robot of a `World`, which makes it and moves it. Its pose is that of its shape's origin, base_link.

    `dt` is the seconds of the world's steps.
    """

    def __init__(self, description: RobotDescription, parts: WorldParts) -> None:
        self.description, self.name, self.dt = description, description.name, parts.dt
        self._parts, self._scene = parts, parts.scene
        self._body = body_at(description.pose, description.mass, description.shape)
        self._shapes = solids(description.shape, self._body)
        self._touches = Touches(self._body)
        x, y = description.pose.x, description.pose.y
        self._area = Area(x, y, x, y)
        self._driver = Driver(description, self._body, parts.dt)
        noise = description.odom.noise
        random = stream(parts.seed, self.name, "odom")
        self._noise = OdometryNoise(noise, random) if noise.v or noise.w else None
        self._member = Member(self._body, self._driver.motion, self._noise)
        carrier = self._carrier()
        self._devices = {each.topic: device(each, carrier) for each in description.sensors}

    def _carrier(self) -> Carrier:
        """Give what sensors need of this robot."""
        return Carrier(
            self.description,
            self._parts.seed,
            self.dt,
            self._body,
            self._scene,
            self._touches.sectors,
            lambda: self._motion,
            lambda: self.wheels,
        )

    def _enter(self) -> None:
        """Come into the world."""
        self._parts.space.add(self._body, *self._shapes)
        self._parts.contacts.add(self._touches, self._shapes)
        self._scene.add(self._body, self.description.shape)
        self._parts.fleet.add(self._member)

    def _leave(self) -> None:
        """Go out of the world."""
        self._parts.space.remove(self._body, *self._shapes)
        self._parts.contacts.remove(self._touches, self._shapes)
        self._scene.remove(self._body)
        self._parts.fleet.remove(self._member)

    def command(self, v: float, w: float, sideways: float = 0.0) -> None:
        """Drive at `v` m/s, turn at `w` rad/s and go left at `sideways` m/s, until the drive's timeout.

        That is cut to the drive's limits, and only `omni` goes sideways. `ackermann` steers so that it goes on the
        circle that v and w make; it doesn't turn on the spot. Raises `CommandError` when it is not finite.
        """
        self._driver.command(Velocity(v, w, sideways), self._scene.step)
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
            self._check_place(pose)
        except WorldError:
            self._put(before)
            raise
        self._body.velocity, self._body.angular_velocity = (0.0, 0.0), 0.0
        self._parts.fleet.rest(self._member)

    def _check_place(self, pose: Pose) -> None:
        """Raise `WorldError` when the robot, which is at this pose, is inside of something."""
        check_place(self._parts.space, self._shapes, self.name, pose, self._parts.walls)

    def _put(self, pose: Pose) -> None:
        placed(self._body, pose)
        self._parts.space.reindex_shapes_for_body(self._body)
        self._scene.moved()

    @property
    def _motion(self) -> Motion[float]:
        """What drives the robot, as it is now."""
        return self._parts.fleet.motion(self._member)

    @property
    def pose(self) -> Pose:
        """Where the robot truly is, theta in [-pi, pi]."""
        return Pose(*self._body.position, wrapped(self._body.angle))

    @property
    def odometry(self) -> Pose:
        """Where the robot is by its own speeds, in the world's frame (it starts at its true pose)."""
        x, y, theta = self._parts.fleet.odometry(self._member)
        return Pose(x, y, wrapped(theta))

    @property
    def driven(self) -> float:
        """How many metres the robot has driven since the start, there and back alike."""
        return float(self._motion.driven)

    @property
    def area(self) -> Area:
        """The box in metres in which its pose has been since the start: what circles on the spot has a small one."""
        self._note_place()
        return self._area

    def _note_place(self) -> None:
        self._area = self._area.grown(*self._body.position)

    @property
    def twist(self) -> Velocity:
        """The robot's true speeds along, about and across its heading."""
        body = self._body
        (vx, vy), w = body.velocity, body.angular_velocity
        half = w * self.dt / 2
        middle = body.angle + half
        cos, sin, chord = math.cos(middle), math.sin(middle), sinc(half)
        return Velocity((vx * cos + vy * sin) / chord, w, (vy * cos - vx * sin) / chord)

    @property
    def odometry_twist(self) -> Velocity:
        """The robot's speeds as odometry believes them: with its noise, and without slipping."""
        v, w, sideways = self.twist
        if self.description.drive.type != "omni":
            sideways = 0.0
        if self._noise is None:
            return Velocity(v, w, sideways)
        of_v, of_s, of_w = self._noise.at(self._scene.step)
        return Velocity(v * of_v, w * of_w, sideways * of_s)

    @property
    def wheels(self) -> tuple[WheelState, ...]:
        """How far each wheel has turned since the start, and how fast it turns, as the robot truly goes."""
        return self._driver.wheels(self._motion, self.twist)

    @property
    def contacts(self) -> int:
        """How many things the robot has run into since the start."""
        return self._touches.contacts

    @property
    def touching(self) -> int:
        """How many things the robot touches now."""
        return self._touches.touching

    @property
    def penetration(self) -> float:
        """The deepest that the robot has ever been inside something, in metres."""
        return self._touches.penetration

    def scan(self, sensor: str | None = None) -> Scan:
        """Measure with a lidar (the first one by default); each call is a new measurement.

        Raises `NotFoundError` when the robot has no such lidar, or none at all.
        """
        lidars = {topic: each for topic, each in self._devices.items() if isinstance(each, LidarSensor)}
        name = sensor if sensor is not None else next(iter(lidars), "scan")
        if name not in lidars:
            raise NotFoundError("lidar", name, lidars, f"robot '{self.name}'")
        return lidars[name].measure()


class WorldParts(NamedTuple):
    """The parts of a world that each robot has to do with."""

    space: pymunk.Space
    scene: Scene
    fleet: Fleet
    contacts: Contacts
    dt: float
    seed: int
    walls: tuple[Wall, ...]
