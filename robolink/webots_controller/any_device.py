"""A device of which only the name is known: what it is shows in what it is asked, or in the world's topics."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink.webots_controller.motors import Motor, PositionSensor
from robolink.webots_controller.robot_topics import plain
from robolink.webots_controller.sensors import Accelerometer, DistanceSensor, Gyro, InertialUnit, Lidar, TouchSensor
from robolink.webots_controller.topic_sensor import Sensor, nothing

if TYPE_CHECKING:
    from robolink.webots_controller.robot import Robot

Known: TypeAlias = "Motor | PositionSensor | Sensor[Any]"

SENSORS: tuple[type[Sensor[Any]], ...] = (Lidar, DistanceSensor, TouchSensor, InertialUnit)
"""One for each type of message."""

WORDS: dict[str, type[Sensor[Any]]] = {"lidar": Lidar, "gyro": Gyro, "acc": Accelerometer, "inertial": InertialUnit}
"""What a name begins with that says the kind."""


class AnyDevice:
    """A device that becomes a motor or a sensor at the first call that only one of them has."""

    def __init__(self, robot: Robot, name: str) -> None:
        self._robot, self._name, self._period = robot, name, 0
        self._device: Known | None = None

    def getName(self) -> str:
        """Give the name that the device has in the world."""
        return self._name

    def enable(self, samplingPeriod: int) -> None:
        """Begin to sense, as soon as the world has such a sensor."""
        self._period = int(samplingPeriod)
        if sensor := self._sensor():
            sensor.enable(self._period)

    def disable(self) -> None:
        """Sense no more."""
        self._period = 0
        if sensor := self._sensor():
            sensor.disable()

    def getSamplingPeriod(self) -> int:
        """Give what it was enabled with, in ms; 0 when it is not."""
        return self._period

    def getValue(self) -> float:
        """Give what a sensor of one number measures; NaN before that is known."""
        sensor = self._sensor()
        return sensor.getValue() if isinstance(sensor, PositionSensor | DistanceSensor | TouchSensor) else math.nan

    def getValues(self) -> list[float]:
        """Give what a sensor of three numbers measures; NaN before that is known."""
        sensor = self._sensor()
        return sensor.getValues() if isinstance(sensor, Gyro | Accelerometer) else nothing(3)

    def __getattr__(self, method: str) -> Any:
        """Be what alone has this method."""
        if method.startswith("_"):
            raise AttributeError(method)
        if not hasattr(self._device, method):
            every: tuple[type[Any], ...] = (Motor, PositionSensor, *SENSORS)
            kinds = [kind for kind in every if hasattr(kind, method)]
            if not kinds:
                raise AttributeError(f"device '{self._name}' has no {method}() here")
            self._be(self._robot.getMotor(self._name) if kinds[0] is Motor else self._made(kinds[0]))
        return getattr(self._device, method)

    def is_there(self) -> bool:
        """Whether the world has a sensor of this name, or its only lidar may be meant."""
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
        """Look for a sensor by its name: among the topics, then by what its name says, then among the joints."""
        topics, name = self._robot.topics, self._name
        kind = next((each for word, each in WORDS.items() if plain(name).startswith(word)), None)
        named = next((each for each in SENSORS if topics.find(each.message, name, or_only=False)), None)
        if kind is None or (named is not None and named.message is not kind.message):
            kind = named
        if kind and topics.find(kind.message, name, or_only=kind.any_name):
            return kind(topics, name)
        return self._robot.getPositionSensor(self._name) if self._robot.joint_of(self._name) else None

    def _made(self, kind: type[Any]) -> Any:
        return kind(self._robot if kind is PositionSensor else self._robot.topics, self._name)
