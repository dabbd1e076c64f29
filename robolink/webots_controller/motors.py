"""Webots' motors and position sensors, and a proxy of a device of which only the name is known."""

from __future__ import annotations

import math
from typing import Any, Protocol, TypeAlias

from robolink.webots_controller.cameras import Camera, RangeFinder
from robolink.webots_controller.sensors import (
    Accelerometer,
    DistanceSensor,
    Gyro,
    InertialUnit,
    Lidar,
    RobotTopics,
    Sensor,
    TouchSensor,
    nothing,
    plain,
)

GAIN = 10.0
"""Gain of Webots' P controller of positions, in 1/s."""

MAX_VELOCITY = 10.0
"""Webots' default speed limit, in rad/s. No topic tells the motor's own; the world cuts higher speeds."""

Known: TypeAlias = "Motor | PositionSensor | Sensor[Any]"

SENSORS: tuple[type[Sensor[Any]], ...] = (Lidar, DistanceSensor, TouchSensor, InertialUnit, RangeFinder, Camera)
"""Sensor classes, one for each type of message, and of images two: whatever has depths is a range finder."""

WORDS: dict[str, type[Sensor[Any]]] = {"lidar": Lidar, "gyro": Gyro, "acc": Accelerometer, "inertial": InertialUnit}
"""Sensor classes by the beginning of a device's name."""


class Joints(Protocol):
    """The robot as a motor needs it: the angles of its joints, in radians, by motor."""

    positions: dict[str, float]

    def joint_of(self, sensor: str) -> str:
        """Return the joint that a position sensor belongs to; '' while it is not known."""

    def warn(self, text: str) -> None:
        """Log a warning once."""


class Motor:
    """A motor; its command is sent at the world's next step, as in Webots."""

    def __init__(self, joints: Joints, name: str) -> None:
        self._joints, self._name = joints, name
        self._target: float | None = None
        self._velocity = MAX_VELOCITY
        self.is_set = False

    def getName(self) -> str:
        """Return the name that the motor has in the world."""
        return self._name

    def setPosition(self, position: float) -> None:
        """Turn to the angle `position` in radians and hold it; with inf, turn at the velocity without end."""
        if math.isnan(position):
            self._joints.warn(f"motor '{self._name}': setPosition was given NaN: ignored")
            return
        self._target, self.is_set = float(position), True

    def setVelocity(self, velocity: float) -> None:
        """Set the velocity in rad/s: the limit on the way to a position, or the speed of turning without end."""
        if not math.isfinite(velocity):
            self._joints.warn(f"motor '{self._name}': setVelocity was given {velocity:g}: ignored")
            return
        self._velocity, self.is_set = float(velocity), True

    def getVelocity(self) -> float:
        """Return the velocity that was set, in rad/s."""
        return self._velocity

    def getMaxVelocity(self) -> float:
        """Return Webots' default, 10 rad/s: the world does not publish a motor's own limit, it only applies it."""
        return MAX_VELOCITY

    def getTargetPosition(self) -> float:
        """Return the angle that was set, in radians; 0 if none was."""
        return 0.0 if self._target is None else self._target

    def getPositionSensor(self) -> PositionSensor:
        """Return the sensor of the joint that it turns."""
        return PositionSensor(self._joints, self._name)

    def speed(self) -> float:
        """Return the present target speed in rad/s, by Webots' rule for position and for velocity control."""
        if self._target is None:
            return 0.0
        if math.isinf(self._target):
            return math.copysign(1.0, self._target) * self._velocity
        most = abs(self._velocity)
        missing = self._target - self._joints.positions.get(self._name, self._target)
        return min(max(GAIN * missing, -most), most)


class PositionSensor:
    """A joint's angle. It belongs to the motor of its own name, else to the one whose name has most words of its."""

    def __init__(self, joints: Joints, name: str) -> None:
        self._joints, self._name, self._period = joints, name, 0

    def getName(self) -> str:
        """Return the name that the sensor has in the world."""
        return self._name

    def enable(self, samplingPeriod: int) -> None:
        """Enable the sensor; the world decides how often it measures, not `samplingPeriod` (ms)."""
        self._period = int(samplingPeriod)

    def disable(self) -> None:
        """Disable the sensor."""
        self._period = 0

    def getSamplingPeriod(self) -> int:
        """Return the sampling period in ms; 0 if disabled."""
        return self._period

    def getValue(self) -> float:
        """Return the angle in radians; NaN as long as it is not known."""
        joint = self._joints.joint_of(self._name) if self._period else ""
        return self._joints.positions.get(joint, math.nan)


class DeviceOwner(Joints, Protocol):
    """The robot as `AnyDevice` needs it: its topics, its motors and its joints."""

    topics: RobotTopics

    def getMotor(self, name: str) -> Motor:
        """Return a motor by its name."""

    def getPositionSensor(self, name: str) -> PositionSensor:
        """Return the position sensor of a joint."""


class AnyDevice:
    """Proxy that becomes a motor or a sensor at the first call that only one of them has."""

    def __init__(self, robot: DeviceOwner, name: str) -> None:
        self._robot, self._name, self._period = robot, name, 0
        self._device: Known | None = None

    def getName(self) -> str:
        """Return the name that the device has in the world."""
        return self._name

    def enable(self, samplingPeriod: int) -> None:
        """Enable the sensor, as soon as the world has it; `samplingPeriod` in ms, but the world decides how often."""
        self._period = int(samplingPeriod)
        if sensor := self._sensor():
            sensor.enable(self._period)

    def disable(self) -> None:
        """Disable the sensor."""
        self._period = 0
        if sensor := self._sensor():
            sensor.disable()

    def getSamplingPeriod(self) -> int:
        """Return the sampling period in ms; 0 if disabled."""
        return self._period

    def getValue(self) -> float:
        """Return the value of a sensor of one number; NaN before the first reading."""
        sensor = self._sensor()
        return sensor.getValue() if isinstance(sensor, PositionSensor | DistanceSensor | TouchSensor) else math.nan

    def getValues(self) -> list[float]:
        """Return the values of a sensor of three numbers; NaN before the first reading."""
        sensor = self._sensor()
        return sensor.getValues() if isinstance(sensor, Gyro | Accelerometer) else nothing(3)

    def __getattr__(self, method: str) -> Any:
        """Become the only kind of device that has this method, and return the method."""
        if method.startswith("_"):
            raise AttributeError(method)
        if not hasattr(self._device, method):
            every: tuple[type[Any], ...] = (Motor, PositionSensor, *SENSORS)
            kinds = [kind for kind in every if hasattr(kind, method)]
            if not kinds:
                raise AttributeError(f"device '{self._name}' has no {method}() here")
            found = self._found() if len(kinds) > 1 else None
            if found is not None and isinstance(found, tuple(kinds)):
                self._be(found)
            else:
                self._be(self._robot.getMotor(self._name) if kinds[0] is Motor else self._made(kinds[0]))
        return getattr(self._device, method)

    def is_there(self) -> bool:
        """True if the world has a sensor of this name, or its only lidar may be meant."""
        return self._found() is not None or len(self._robot.topics.of_type(Lidar.message)) == 1

    def _sensor(self) -> PositionSensor | Sensor[Any] | None:
        if self._device is None and (found := self._found()):
            self._be(found)
        return None if isinstance(self._device, Motor) else self._device

    def _be(self, device: Known) -> None:
        self._device = device
        if self._period and not isinstance(device, Motor):
            device.enable(self._period)  # it was asked for before the world was there

    def _found(self) -> PositionSensor | Sensor[Any] | None:
        """Find a sensor by its name: among the topics, then by the kind in its name, then among the joints."""
        topics, name = self._robot.topics, self._name
        kind = next((each for word, each in WORDS.items() if plain(name).startswith(word)), None)
        named = next((each for each in SENSORS if each.found(topics, name, or_only=False)), None)
        if kind is None or (named is not None and named.message is not kind.message):
            kind = named
        if kind and kind.found(topics, name, or_only=kind.any_name):
            return kind(topics, name)
        return self._robot.getPositionSensor(self._name) if self._robot.joint_of(self._name) else None

    def _made(self, kind: type[Any]) -> Any:
        return kind(self._robot if kind is PositionSensor else self._robot.topics, self._name)
