"""A robot in a world: its commands, pose, sensors and contacts."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import pymunk

from robolink.exceptions import NotFoundError
from robolink.geometry.plane import Area, wrapped
from robolink.sim.description import RobotDescription, Wall
from robolink.sim.driving.drive import Driver
from robolink.sim.driving.fleet import Fleet, Member
from robolink.sim.driving.motion import Motion
from robolink.sim.driving.odometry_errors import OdometryErrors
from robolink.sim.physics.bodies import body_at, placed, solids
from robolink.sim.physics.contacts import Contacts, Touches
from robolink.sim.physics.placing import WorldError, check_place, check_pose
from robolink.sim.quantities import Pose
from robolink.sim.readings import Scan, Velocity, WheelState
from robolink.sim.sensing.devices import Carrier, LidarSensor, device, stream
from robolink.sim.sensing.scene import Scene


class Robot:
    """A robot of a `World`, which makes it and moves it. Its pose is that of its shape's origin, base_link.

    Args:
        description: The robot as a world file describes it.
        parts: The parts of the world that it lives in; its `dt` is the length of a step in seconds.
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
        odom, random = description.odom, stream(parts.seed, self.name, "odom")
        self._errors = OdometryErrors(odom, random) if odom.errs else None
        self._member = Member(self._body, self._driver.motion, self._errors)
        carrier = self._carrier()
        self._devices = {each.topic: device(each, carrier) for each in description.sensors}

    def _carrier(self) -> Carrier:
        """Return the parts of this robot that its sensors need."""
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
        """Add the robot to the world."""
        self._parts.space.add(self._body, *self._shapes)
        self._parts.contacts.add(self._touches, self._shapes)
        self._scene.add(self._body, self.description.shape, thing=self.description)
        self._parts.fleet.add(self._member)

    def _leave(self) -> None:
        """Remove the robot from the world."""
        self._parts.space.remove(self._body, *self._shapes)
        self._parts.contacts.remove(self._touches, self._shapes)
        self._scene.remove(self._body)
        self._parts.fleet.remove(self._member)

    def command(self, v: float, w: float, sideways: float = 0.0) -> None:
        """Drive at these speeds until the drive's timeout.

        They are cut to the drive's limits. A drive of type `ackermann` steers so that it goes on the circle that v and
        w make; it does not turn on the spot.

        Args:
            v: Speed ahead in m/s.
            w: Turning speed in rad/s, counter-clockwise.
            sideways: Speed to the left in m/s; only `omni` has one.

        Raises:
            CommandError: if a speed is not finite.
        """
        self._driver.command(Velocity(v, w, sideways), self._scene.step)
        self._parts.fleet.take_targets(self._member)

    def turn_wheels(self, speeds: Mapping[str, float]) -> None:
        """Turn motors one by one, each until its next command or a velocity command.

        Motors have no timeout. The speeds are cut to each motor's limit, and all by one factor to the drive's limits.

        Args:
            speeds: Speeds in rad/s by the names of motors.

        Raises:
            NotFoundError: if there is no such motor.
            CommandError: if a speed is not finite.
        """
        self._driver.turn_wheels(speeds)
        self._parts.fleet.take_targets(self._member)

    @property
    def held(self) -> bool:
        """True while the robot obeys no command: from `hold` to `release`."""
        return self._driver.held

    def hold(self) -> None:
        """Brake as hard as the wheels grip the floor, about 0.8 g, and obey no command until `release`."""
        self._parts.fleet.take_limits()
        self._driver.hold()

    def release(self) -> None:
        """Obey commands again; the robot stands until the next one."""
        self._parts.fleet.take_limits()
        self._driver.release()

    def teleport(self, pose: Pose) -> None:
        """Put the robot elsewhere at once, at rest; odometry does not notice, and a command goes on.

        Args:
            pose: The new pose in the world.

        Raises:
            WorldError: if that is inside of something or not finite; the robot stays where it was.
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
        """Raise `WorldError` if the robot, which is at this pose, is inside of something."""
        check_place(self._parts.space, self._shapes, self.name, pose, self._parts.walls)

    def _put(self, pose: Pose) -> None:
        placed(self._body, pose)
        self._parts.space.reindex_shapes_for_body(self._body)
        self._scene.moved()
        self._parts.fleet.moved()

    @property
    def _motion(self) -> Motion[float]:
        """The present motion of the robot."""
        return self._parts.fleet.motion(self._member)

    @property
    def pose(self) -> Pose:
        """The true pose, theta in [-pi, pi]."""
        return Pose(*self._body.position, wrapped(self._body.angle))

    @property
    def odometry(self) -> Pose:
        """The pose by odometry, in the world's frame (it starts at the true pose)."""
        return self._parts.fleet.odometry(self._member)

    @property
    def driven(self) -> float:
        """Distance driven since the start in metres, forwards and backwards alike."""
        return float(self._motion.driven)

    @property
    def area(self) -> Area:
        """Bounding box of its poses since the start, in metres: that of a robot that circles on the spot is small."""
        x, y = self._body.position
        self._area = self._area.grown(x, y)
        return self._area

    def note_place(self) -> None:
        """Let `area` contain the place where the scene has seen the robot; called by the world now and then."""
        x, y, _ = self._scene.poses()[self._body]
        self._area = self._area.grown(x, y)

    @property
    def twist(self) -> Velocity:
        """The robot's true speeds along, about and across its heading."""
        return self._parts.fleet.twist(self._member)

    @property
    def odometry_twist(self) -> Velocity:
        """The speeds by odometry: with its errors, and without slipping."""
        v, w, sideways = self.twist
        if self.description.drive.type != "omni":
            sideways = 0.0
        if self._errors is None:
            return Velocity(v, w, sideways)
        of_v, of_s, of_w, drift = self._errors.at(self._scene.step)
        return Velocity(v * of_v, w * of_w + v * drift, sideways * of_s)

    @property
    def wheels(self) -> tuple[WheelState, ...]:
        """State of each wheel: its angle since the start and its speed, by the robot's true motion."""
        return self._driver.wheels(self._motion, self.twist)

    @property
    def contacts(self) -> int:
        """Number of contacts that have begun since the start."""
        return self._touches.contacts

    @property
    def touching(self) -> int:
        """Number of things that the robot touches now."""
        return self._touches.touching

    @property
    def penetration(self) -> float:
        """Deepest penetration of any contact so far, in metres."""
        return self._touches.penetration

    def scan(self, sensor: str | None = None) -> Scan:
        """Measure with a lidar; each call is a new measurement.

        Args:
            sensor: The topic of the lidar; None: the first one.

        Raises:
            NotFoundError: if the robot has no such lidar, or none at all.
        """
        lidars = {topic: each for topic, each in self._devices.items() if isinstance(each, LidarSensor)}
        name = sensor if sensor is not None else next(iter(lidars), "scan")
        if name not in lidars:
            raise NotFoundError("lidar", name, lidars, f"robot '{self.name}'")
        return lidars[name].measure()


class WorldParts(NamedTuple):
    """Parts of a world that its robots use; `dt` is the length of a step in seconds."""

    space: pymunk.Space
    scene: Scene
    fleet: Fleet
    contacts: Contacts
    dt: float
    seed: int
    walls: tuple[Wall, ...]
