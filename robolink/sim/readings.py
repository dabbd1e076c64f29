"""What a robot tells of itself: its speeds, its wheels, and what its sensors have measured."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from robolink.sim.arrays import Array
from robolink.sim.description import Sensor

if TYPE_CHECKING:
    from robolink.sim.robot import Robot


class Scan(NamedTuple):
    """One scan: angles in radians, ranges in metres as float64; +inf no return, -inf nearer than `range_min`.

    `intensities` are the shares of light that came back, 0 to 1, if the lidar has them.
    """

    angle_min: float
    angle_max: float
    angle_increment: float
    range_min: float
    range_max: float
    ranges: Array
    intensities: Array | None = None


class Velocity(NamedTuple):
    """Forward speed in m/s, turning speed in rad/s counter-clockwise, and speed to the left in m/s."""

    v: float
    w: float
    sideways: float = 0.0


class WheelState(NamedTuple):
    """How far a motor has turned its wheel since the start, in radians, and how fast it turns, in rad/s."""

    motor: str
    position: float
    speed: float


class Inertia(NamedTuple):
    """What an inertial unit reads: heading in radians, turning in rad/s, acceleration ahead and to the left in m/s²."""

    heading: float
    turning: float
    ax: float
    ay: float


Value: TypeAlias = "Scan | bool | Inertia | float | tuple[WheelState, ...]"


class Reading(NamedTuple):
    """What one sensor has measured.

    `value` is a `Scan` of a lidar, whether a bumper was touched since its last reading, the `Inertia` of an imu,
    the metres of a range finder (inf and -inf as of a scan), the `WheelState` of each of the encoders' wheels.
    """

    robot: Robot
    sensor: Sensor
    value: Value
