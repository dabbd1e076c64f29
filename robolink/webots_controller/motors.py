"""Webots' motors and position sensors, from the topics joint_states and joint_command."""

from __future__ import annotations

import math
from typing import Protocol

GAIN = 10.0
"""Gain of Webots' P controller of positions, in 1/s."""

MAX_VELOCITY = 10.0
"""Webots' default speed limit, in rad/s. No topic tells the motor's own; the world cuts higher speeds."""


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
        self.is_told = False

    def getName(self) -> str:
        """Return the name that the motor has in the world."""
        return self._name

    def setPosition(self, position: float) -> None:
        """Turn to the angle `position` in radians and hold it; with inf, turn at the velocity without end."""
        if math.isnan(position):
            self._joints.warn(f"motor '{self._name}': setPosition was given NaN: ignored")
            return
        self._target, self.is_told = float(position), True

    def setVelocity(self, velocity: float) -> None:
        """Set the velocity in rad/s: the limit on the way to a position, or the speed of turning without end."""
        if not math.isfinite(velocity):
            self._joints.warn(f"motor '{self._name}': setVelocity was given {velocity:g}: ignored")
            return
        self._velocity, self.is_told = float(velocity), True

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
