"""Schedule of the sensors of all robots: measures those that are due at a step, lidars that are alike together."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from typing import Any, NamedTuple

from robolink.sim.description import steps_between
from robolink.sim.robot import Robot
from robolink.sim.sensing.devices import Device, LidarBank, LidarSensor
from robolink.sim.sensors import Sensor


class Reading(NamedTuple):
    """Measurement of one `sensor` of a `robot`.

    `value` is what the sensor's device in sensing/devices.py returns: a `Scan` of a lidar, of a bumper True if it was
    touched since its last reading, the `Inertia` of an imu, the metres of a range finder (inf and -inf as of a scan),
    the `WheelState` of each wheel that has an encoder, the `Shot` of a camera.
    """

    robot: Robot
    sensor: Sensor
    value: Any


class Schedule:
    """Schedule of sensors, each with its robot; a sensor is due at a fixed number of steps of `dt` seconds."""

    def __init__(self, sensors: Iterable[tuple[Robot, Device]], dt: float) -> None:
        self._all = [(steps_between(device.description.rate, dt), robot, device) for robot, device in sensors]
        self._periods = sorted({period for period, _, _ in self._all if period})
        self._common = math.gcd(*self._periods) or 1
        self._rounds: dict[tuple[int, ...], _Round] = {}

    def readings(self, step: int) -> list[Reading]:
        """Measure with all sensors that are due at a step, robot by robot."""
        if step % self._common:
            return []
        periods = tuple([period for period in self._periods if step % period == 0])
        if not periods:
            return []
        found = self._rounds.get(periods)
        if found is None:
            chosen = [(robot, device) for period, robot, device in self._all if period in periods]
            found = self._rounds[periods] = _round(chosen)
        return found.readings()


class _Round(NamedTuple):
    """Sensors that are due together, and the lidars among them by their kinds, each with its place."""

    sensors: list[tuple[Robot, Device]]
    lidars: list[tuple[list[int], LidarBank]]

    def readings(self) -> list[Reading]:
        values: dict[int, Any] = {}
        for places, bank in self.lidars:
            values.update(zip(places, bank.measure(), strict=True))
        return [
            Reading(robot, device.description, values[place] if place in values else device.measure())
            for place, (robot, device) in enumerate(self.sensors)
        ]


def _round(sensors: list[tuple[Robot, Device]]) -> _Round:
    kinds = defaultdict[object, list[tuple[int, LidarSensor]]](list)
    for place, (_, device) in enumerate(sensors):
        if isinstance(device, LidarSensor):
            kinds[device.kind].append((place, device))
    banks = [([place for place, _ in kind], LidarBank([lidar for _, lidar in kind])) for kind in kinds.values()]
    return _Round(sensors, banks)
