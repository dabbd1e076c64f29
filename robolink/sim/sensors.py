"""The sensors on a robot: each measures with its own random stream, so that no other changes what it reads."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from robolink.sim.contacts import Sector
from robolink.sim.description import Bumper, Encoders, Imu, Lidar, Pose, RangeFinder, Sensor
from robolink.sim.lidar import Beams, Scan, limited, measured
from robolink.sim.noise import LidarNoise, stream
from robolink.sim.odometry import wrapped
from robolink.sim.range_finder import nearest_in_cone
from robolink.sim.readings import Inertia, Value, WheelState
from robolink.sim.surroundings import Place

if TYPE_CHECKING:
    from robolink.sim.robot import Robot


class Device(Protocol):
    """A sensor on a robot."""

    @property
    def description(self) -> Sensor:
        """What the world file says of it."""

    def measure(self) -> Value:
        """Measure once; what is random is drawn anew."""


class LidarSensor:
    """A lidar."""

    def __init__(self, lidar: Lidar, robot: Robot, seed: int) -> None:
        self.description, self.robot = lidar, robot
        self.noise = LidarNoise(lidar, stream(seed, robot.name, lidar.topic))
        self._alone: LidarBank | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        """What makes lidars alike, so that they are measured together."""
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
        self._scene = lidars[0].robot.scene
        self._mounts = [(each.robot.body, each.description.offset) for each in lidars]
        self._own = [self._scene.number(each.robot.body) for each in lidars]
        disturbed = any(each.description.noise or each.description.dropout for each in lidars)
        self._noises = [each.noise for each in lidars] if disturbed else None

    def measure(self) -> list[Scan]:
        """Measure once with each."""
        places, surroundings = self._scene.places(), self._scene.surroundings()
        mounted = [mounted_on(places[body], offset) for body, offset in self._mounts]
        ranges, lights = measured(self._beams, mounted, self._own, surroundings, self._lit)
        if self._noises is not None:
            ranges = np.array([noise.disturbed(row) for noise, row in zip(self._noises, ranges, strict=True)])
        ranges = limited(ranges, *self._limits)
        if not self._lit:
            return [Scan(*self._span, row) for row in ranges]
        lights = np.where(np.isposinf(ranges), 0.0, lights)
        return [Scan(*self._span, row, light) for row, light in zip(ranges, lights, strict=True)]


class BumperSensor:
    """A bumper: what has touched it since its last reading."""

    def __init__(self, bumper: Bumper, robot: Robot) -> None:
        self.description, self._sector = bumper, Sector(bumper)
        robot.touches.sectors.append(self._sector)

    def measure(self) -> bool:
        """Say whether anything has touched it, and forget that."""
        touched, self._sector.touched = self._sector.touched, False
        return touched


class ImuSensor:
    """An inertial unit; the acceleration is the mean one of the last step."""

    def __init__(self, imu: Imu, robot: Robot, seed: int) -> None:
        self.description, self._robot = imu, robot
        self._random = stream(seed, robot.name, imu.topic)
        noise = imu.noise
        self._deviations = np.array((noise.gyro, noise.accel, noise.accel)) if noise.gyro or noise.accel else None

    def measure(self) -> Inertia:
        """Measure once."""
        body, motion, dt = self._robot.body, self._robot.motion, self._robot.dt
        (vx, vy), theta = body.velocity, body.angle
        ax, ay, cos, sin = (vx - motion.vx) / dt, (vy - motion.vy) / dt, math.cos(theta), math.sin(theta)
        turning, ahead, aside = body.angular_velocity, ax * cos + ay * sin, ay * cos - ax * sin
        if self._deviations is not None:
            errors = (self._deviations * self._random.standard_normal(3)).tolist()
            turning, ahead, aside = turning + errors[0], ahead + errors[1], aside + errors[2]
        return Inertia(wrapped(theta), turning, ahead, aside)


class RangeFinderSensor:
    """A sonar or infrared sensor."""

    def __init__(self, range_finder: RangeFinder, robot: Robot, seed: int) -> None:
        self.description, self._robot = range_finder, robot
        self._random = stream(seed, robot.name, range_finder.topic)

    def measure(self) -> float:
        """Give the distance in metres, inf for nothing within range and -inf for what is too near (REP 117)."""
        sensor, scene = self.description, self._robot.scene
        body, surroundings = self._robot.body, scene.surroundings()
        pose, own = Pose(*mounted_on(scene.places()[body], sensor.offset)), scene.number(body)
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
    """The wheels' encoders: with `ticks`, positions are whole ticks and speeds what was counted since last time."""

    def __init__(self, encoders: Encoders, robot: Robot) -> None:
        self.description, self._robot = encoders, robot
        self._last, self._last_step = [0] * len(robot.description.wheels), robot.scene.step

    def measure(self) -> tuple[WheelState, ...]:
        """Give each wheel's turns."""
        wheels, ticks = self._robot.wheels, self.description.ticks
        if not ticks:
            return wheels
        tick, step = math.tau / ticks, self._robot.scene.step
        counts = [math.floor(wheel.position / tick) for wheel in wheels]
        seconds = max(1, step - self._last_step) * self._robot.dt
        speeds = [(now - last) * tick / seconds for now, last in zip(counts, self._last, strict=True)]
        self._last, self._last_step = counts, step
        return tuple(
            WheelState(wheel.motor, count * tick, speed)
            for wheel, count, speed in zip(wheels, counts, speeds, strict=True)
        )


def device(sensor: Sensor, robot: Robot, seed: int) -> Device:
    """Put a sensor on a robot."""
    if isinstance(sensor, Lidar):
        return LidarSensor(sensor, robot, seed)
    if isinstance(sensor, Bumper):
        return BumperSensor(sensor, robot)
    if isinstance(sensor, Imu):
        return ImuSensor(sensor, robot, seed)
    if isinstance(sensor, RangeFinder):
        return RangeFinderSensor(sensor, robot, seed)
    if isinstance(sensor, Encoders):
        return EncodersSensor(sensor, robot)
    raise TypeError(f"no device for {sensor!r}")


def mounted_on(place: Place, offset: Pose) -> Place:
    """Give the place in the world of what is mounted on a robot that is at a place."""
    x, y, theta = place
    cos, sin = math.cos(theta), math.sin(theta)
    return x + cos * offset.x - sin * offset.y, y + sin * offset.x + cos * offset.y, theta + offset.theta
