"""Proxy of a device of which only the name is known: its kind follows from the first call, or the topics."""

from __future__ import annotations

import math
from typing import Any, Protocol, TypeAlias

from robolink.webots_controller.cameras import Camera, RangeFinder
from robolink.webots_controller.motors import Joints, Motor, PositionSensor
from robolink.webots_controller.robot_topics import RobotTopics, plain
from robolink.webots_controller.sensors import Accelerometer, DistanceSensor, Gyro, InertialUnit, Lidar, TouchSensor
from robolink.webots_controller.topic_sensor import Sensor, nothing

Known: TypeAlias = "Motor | PositionSensor | Sensor[Any]"

SENSORS: tuple[type[Sensor[Any]], ...] = (Lidar, DistanceSensor, TouchSensor, InertialUnit, RangeFinder, Camera)
"""Sensor classes, one for each type of message, and of images two: whatever has depths is a range finder."""

WORDS: dict[str, type[Sensor[Any]]] = {"lidar": Lidar, "gyro": Gyro, "acc": Accelerometer, "inertial": InertialUnit}
"""Sensor classes by the beginning of a device's name."""


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
