"""Wheel kinematics: a robot's speeds from those of its wheels, and the other way round.

A wheel at (x, y) that rolls towards theta goes over the floor at (v - w y) cos theta + (s + w x) sin theta, which
is its own speed times its radius. A robot whose wheels contradict each other goes the way of the least squares.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from robolink.exceptions import NotFoundError
from robolink.sim.description import Wheel
from robolink.sim.readings import Velocity

_DIGITS = 15
"""Decimals kept of the pseudo-inverse: later ones differ between versions of the linear algebra below numpy."""


class Wheels:
    """The wheels of one robot; only with `sideways` can they make it go to the left."""

    def __init__(self, wheels: Sequence[Wheel], robot: str, *, sideways: bool) -> None:
        self.names = [wheel.motor for wheel in wheels]
        self._robot, self._limits = robot, [wheel.speed_max for wheel in wheels]
        self._rows = [_row(wheel) for wheel in wheels]
        self._inverse = _pseudo_inverse(self._rows, sideways)
        self._told = dict.fromkeys(self.names, 0.0)

    def turn(self, speeds: Mapping[str, float]) -> Velocity:
        """Set the speeds of motors, in rad/s; return the robot's speeds that all of them together ask for.

        Raises `NotFoundError` when there is no such motor, and changes none then.
        """
        for name in speeds:
            if name not in self._told:
                raise NotFoundError("motor", name, self.names, f"robot '{self._robot}'")
        self._told.update(speeds)
        cut = [max(-most, min(most, self._told[name])) for name, most in zip(self.names, self._limits, strict=True)]
        v, s, w = (math.fsum(share * speed for share, speed in zip(row, cut, strict=True)) for row in self._inverse)
        return Velocity(v, w, s)

    def forget(self) -> None:
        """Set all motors to 0: a velocity command has come."""
        self._told = dict.fromkeys(self.names, 0.0)

    def speeds(self, robot: Velocity) -> list[float]:
        """Return the speed of each wheel in rad/s from a robot's speeds; or its angle in rad from its way."""
        v, w, s = robot
        return [row[0] * v + row[1] * s + row[2] * w for row in self._rows]


def _row(wheel: Wheel) -> tuple[float, float, float]:
    """Return the speed of a wheel for each of v, s and w."""
    at, cos, sin = wheel.at, math.cos(wheel.at.theta), math.sin(wheel.at.theta)
    return cos / wheel.radius, sin / wheel.radius, (at.x * sin - at.y * cos) / wheel.radius


def _pseudo_inverse(rows: Sequence[tuple[float, float, float]], sideways: bool) -> list[list[float]]:
    forward = np.array(rows, dtype=np.float64).reshape(-1, 3)
    if not sideways:
        forward[:, 1] = 0.0
    inverse: list[list[float]] = np.round(np.linalg.pinv(forward, rcond=1e-9), _DIGITS).tolist()
    return inverse
