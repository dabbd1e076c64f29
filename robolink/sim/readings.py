"""Values that a robot and its sensors measure: speeds, wheels, scans, inertia."""

from __future__ import annotations

from typing import NamedTuple

from robolink.sim.arrays import Array


class Scan(NamedTuple):
    """Scan of a lidar.

    Args:
        angle_min: Angle of the first beam, in radians.
        angle_max: Angle of the last beam, in radians.
        angle_increment: Angle from beam to beam, in radians.
        range_min: Shortest range that is measured, in metres.
        range_max: Longest range that is measured, in metres.
        ranges: Ranges in metres, float64; +inf means no return, -inf is nearer than `range_min`.
        intensities: Shares of the light that came back, 0 to 1, if the lidar has them.
    """

    angle_min: float
    angle_max: float
    angle_increment: float
    range_min: float
    range_max: float
    ranges: Array
    intensities: Array | None = None


class Velocity(NamedTuple):
    """Velocity: `v` forward in m/s, `w` of turning in rad/s counter-clockwise, and `sideways`, to the left, in m/s."""

    v: float
    w: float
    sideways: float = 0.0


class WheelState(NamedTuple):
    """State of the wheel of a `motor`: `position`, the angle turned since the start in rad, and `speed` in rad/s."""

    motor: str
    position: float
    speed: float


class Inertia(NamedTuple):
    """Reading of an inertial unit.

    Args:
        heading: Heading in radians.
        turning: Turning speed in rad/s, to the left if positive.
        ax: Acceleration ahead, in m/s².
        ay: Acceleration to the left, in m/s².
    """

    heading: float
    turning: float
    ax: float
    ay: float
