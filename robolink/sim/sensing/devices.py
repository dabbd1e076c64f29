"""Devices: what each kind of sensor measures, with a stream of random numbers of its own."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
import pymunk

from robolink.geometry import plane
from robolink.geometry.plane import placed_on, wrapped
from robolink.sim.arrays import Array
from robolink.sim.description import RobotDescription
from robolink.sim.driving.motion import Motion
from robolink.sim.physics.contacts import Sector
from robolink.sim.quantities import Pose
from robolink.sim.readings import Inertia, Scan, WheelState
from robolink.sim.rendering.pinhole import view_from
from robolink.sim.rendering.renderer import Shooter, Shot
from robolink.sim.sensing.lidar import Beams, limited, measured, nearest_in_cone
from robolink.sim.sensing.scene import Scene
from robolink.sim.sensors import Bumper, Camera, Encoders, Imu, Lidar, RangeFinder, Sensor, kind_of


def stream(seed: int, robot: str, sensor: str) -> np.random.Generator:
    """Return the random stream of one sensor of one robot; the same on every machine and in every process."""
    digest = hashlib.sha256(f"{seed}/{robot}/{sensor}".encode()).digest()
    return np.random.Generator(np.random.PCG64(int.from_bytes(digest[:16], "little")))


class LidarNoise:
    """Gaussian noise and lost returns; each scan draws the same count of numbers, whatever the beams hit."""

    def __init__(self, lidar: Lidar, random: np.random.Generator) -> None:
        self._noise, self._dropout, self._random = lidar.noise, lidar.dropout, random

    def disturbed(self, ranges: Array) -> Array:
        """Return the ranges as this scanner reads them; a lost beam is inf."""
        if self._noise:
            ranges = ranges + self._noise * self._random.standard_normal(len(ranges))
        if self._dropout:
            ranges = np.where(self._random.random(len(ranges)) < self._dropout, np.inf, ranges)
        return ranges


class Carrier(NamedTuple):
    """The parts of a robot that its sensors need; those that feel touches add their sectors."""

    robot: RobotDescription
    seed: int
    dt: float
    body: pymunk.Body
    scene: Scene
    sectors: list[Sector]
    motion: Callable[[], Motion[float]]
    wheels: Callable[[], tuple[WheelState, ...]]

    def random(self, sensor: Sensor) -> np.random.Generator:
        """Return the random stream of one of its sensors."""
        return stream(self.seed, self.robot.name, sensor.topic)

    def pose(self, sensor: Sensor) -> Pose:
        """Return the pose of one of its sensors in the world: of the robot itself if it has no mount."""
        robot = plane.Pose(*self.scene.poses()[self.body])
        return Pose(*(robot if sensor.mount is None else placed_on(robot, sensor.mount.place)))


class Device(Protocol):
    """A sensor mounted on a robot."""

    @property
    def description(self) -> Sensor:
        """The sensor as the world file describes it."""

    def measure(self) -> Any:
        """Measure once, with new noise: the `value` of a Reading."""


class LidarSensor:
    """A lidar."""

    def __init__(self, lidar: Lidar, carrier: Carrier) -> None:
        self.description, self.carrier = lidar, carrier
        self.noise = LidarNoise(lidar, carrier.random(lidar))
        self._alone: LidarBank | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        """Key of lidars that are alike, so that they are measured together."""
        lidar = self.description
        return lidar.beams, lidar.fov, lidar.start, lidar.range, lidar.noise, lidar.intensities

    def measure(self) -> Scan:
        """Measure once."""
        if self._alone is None:
            self._alone = LidarBank([self])
        return self._alone.measure()[0]


class LidarBank:
    """Lidars of one kind that are measured at once; each scan is the same as if it were measured alone."""

    def __init__(self, lidars: Sequence[LidarSensor]) -> None:
        first = lidars[0].description
        self._beams = beams = Beams(first)
        angle_max = beams.start + (beams.count - 1) * beams.increment
        self._span = (beams.start, angle_max, beams.increment, *first.range)
        self._lit, self._limits = first.intensities, first.range
        self._scene = lidars[0].carrier.scene
        offsets = [each.description.offset.place for each in lidars]
        self._mounts = [
            (each.carrier.body, offset if any(offset) else None) for each, offset in zip(lidars, offsets, strict=True)
        ]
        self._own = [self._scene.number(each.carrier.body) for each in lidars]
        disturbed = any(each.description.noise or each.description.dropout for each in lidars)
        self._noises = [each.noise for each in lidars] if disturbed else None

    def measure(self) -> list[Scan]:
        """Measure once with each."""
        places, surroundings = self._scene.poses(), self._scene.surroundings()
        mounted = [
            places[body] if mount is None else placed_on(plane.Pose(*places[body]), mount)
            for body, mount in self._mounts
        ]
        ranges, lights = measured(self._beams, mounted, self._own, surroundings, self._lit)
        if self._noises is not None:
            ranges = np.array([noise.disturbed(row) for noise, row in zip(self._noises, ranges, strict=True)])
        ranges = limited(ranges, *self._limits)
        if not self._lit:
            return [Scan(*self._span, row) for row in ranges]
        lights = np.where(np.isposinf(ranges), 0.0, lights)
        return [Scan(*self._span, row, light) for row, light in zip(ranges, lights, strict=True)]


class BumperSensor:
    """A bumper: notes touches since its last reading."""

    def __init__(self, bumper: Bumper, carrier: Carrier) -> None:
        self.description, self._sector = bumper, Sector(bumper)
        carrier.sectors.append(self._sector)

    def measure(self) -> bool:
        """Return True if anything has touched it since the last reading."""
        touched, self._sector.touched = self._sector.touched, False
        return touched


class ImuSensor:
    """An inertial unit; the acceleration is the mean one of the last step."""

    def __init__(self, imu: Imu, carrier: Carrier) -> None:
        self.description, self._carrier = imu, carrier
        self._random = carrier.random(imu)
        noise = imu.noise
        self._deviations = np.array((noise.gyro, noise.accel, noise.accel)) if noise.gyro or noise.accel else None

    def measure(self) -> Inertia:
        """Measure once."""
        body, motion, dt = self._carrier.body, self._carrier.motion(), self._carrier.dt
        (vx, vy), theta = body.velocity, body.angle
        ax, ay, cos, sin = (vx - motion.vx) / dt, (vy - motion.vy) / dt, math.cos(theta), math.sin(theta)
        turning, ahead, aside = body.angular_velocity, ax * cos + ay * sin, ay * cos - ax * sin
        if self._deviations is not None:
            errors = (self._deviations * self._random.standard_normal(3)).tolist()
            turning, ahead, aside = turning + errors[0], ahead + errors[1], aside + errors[2]
        return Inertia(wrapped(theta), turning, ahead, aside)


class RangeFinderSensor:
    """A sonar or infrared sensor."""

    def __init__(self, range_finder: RangeFinder, carrier: Carrier) -> None:
        self.description, self._carrier = range_finder, carrier
        self._random = carrier.random(range_finder)

    def measure(self) -> float:
        """Return the distance in metres, inf for nothing within range and -inf for a thing too near (REP 117)."""
        sensor, scene = self.description, self._carrier.scene
        surroundings, pose = scene.surroundings(), self._carrier.pose(sensor)
        own = scene.number(self._carrier.body)
        segments = surroundings.segments_near(pose.x, pose.y, sensor.range[1] + 8 * sensor.noise, own)
        circles = surroundings.circles
        others = np.stack((circles.x, circles.y, circles.radius))[:, circles.owner != own]
        distance = nearest_in_cone(pose, sensor.fov, segments, others)
        if sensor.noise:
            distance += sensor.noise * self._random.standard_normal()
        if distance > sensor.range[1]:
            return math.inf
        return -math.inf if distance < sensor.range[0] else distance


class EncodersSensor:
    """Wheel encoders: with `ticks`, positions are whole ticks, and speeds come from the ticks since last time."""

    def __init__(self, encoders: Encoders, carrier: Carrier) -> None:
        self.description, self._carrier = encoders, carrier
        self._last, self._last_step = [0] * len(carrier.robot.wheels), carrier.scene.step

    def measure(self) -> tuple[WheelState, ...]:
        """Return the state of each wheel."""
        wheels, ticks = self._carrier.wheels(), self.description.ticks
        if not ticks:
            return wheels
        tick, step = math.tau / ticks, self._carrier.scene.step
        counts = [math.floor(wheel.position / tick) for wheel in wheels]
        seconds = max(1, step - self._last_step) * self._carrier.dt
        speeds = [(now - last) * tick / seconds for now, last in zip(counts, self._last, strict=True)]
        self._last, self._last_step = counts, step
        return tuple(
            WheelState(wheel.motor, count * tick, speed)
            for wheel, count, speed in zip(wheels, counts, speeds, strict=True)
        )


class CameraSensor:
    """A camera; what it sees is rendered only if somebody wants to see it."""

    def __init__(self, camera: Camera, carrier: Carrier) -> None:
        self.description, self._carrier = camera, carrier
        self._shooter = Shooter(camera, f"{carrier.seed}/{carrier.robot.name}/{camera.topic}")
        self._pitch = math.radians(camera.pitch)

    def measure(self) -> Shot:
        """Take a shot, which is rendered when it is asked for its image."""
        scene, pose = self._carrier.scene, self._carrier.pose(self.description)
        setting, places = scene.sight(self._carrier.body)
        view = view_from((pose.x, pose.y, self.description.z), pose.theta, self._pitch)
        return Shot(self._shooter, setting, view, places, scene.step)


def device(sensor: Sensor, carrier: Carrier) -> Device:
    """Make the device of a sensor on a robot."""
    made: Device = kind_of(sensor).part("device")(sensor, carrier)
    return made
