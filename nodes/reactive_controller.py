"""Drive ahead; turn away from what is near.

The robot looks at its lane: what it sweeps when it drives on. The less of it is free, the slower it drives and the
faster it turns, to the side with more room, and to that side until the lane is free again, or it would dither in
corners.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from robolink.control.laser import Array, in_view, lane_ahead, returns
from robolink.control.scan_controller import ScanController
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.parameters.descriptors import described

SLOW_AHEAD, SLOW_SECONDS = 0.6, 1.0
"""Distance before `stop_distance` at which it slows down and begins to turn: metres, or seconds at full speed."""

SCANS_TO_STOP = 2.0
"""Least number of scans in that distance, if they come seldom."""

TURN_BETWEEN_SCANS = 0.6
"""Largest turn from one scan to the next, in radians, so that it does not turn past a gap."""


class Settings(NamedTuple):
    """Settings of the controller; the parameters of the node have the same names. Metres, m/s, rad/s."""

    speed: float = 0.4
    stop_distance: float = 0.5
    half_width: float = 0.27
    turn_speed: float = 1.0


PARAMETERS = {
    "speed": described("m/s where the lane is free", 0.01, 5.0),
    "stop_distance": described("metres from the lidar to what it stops for; more than the robot's nose", 0.05, 10.0),
    "half_width": described("metres from the lane's middle to its edge: half the robot and some room", 0.02, 5.0),
    "turn_speed": described("rad/s where the robot stands", 0.05, 10.0),
}


class Decision(NamedTuple):
    """A command, the side to which it turns (1 left, -1 right, 0 neither), and the reason in words."""

    twist: Twist
    side: int
    words: str


class ReactiveController(ScanController):
    """Reactive controller: turns each scan into a velocity command; stops without scans, and at its own end."""

    side = 0

    def __init__(self, **options: Any) -> None:
        super().__init__("reactive_controller", **options)
        for name, value in Settings()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])

    def decide(self, scan: LaserScan, seconds: float) -> tuple[Twist, str]:
        """Steer by a scan, and remember the side."""
        settings = Settings(*(self.get_parameter(name).value for name in Settings._fields))
        twist, self.side, words = steer(scan, settings, self.side, seconds)
        return twist, words


def steer(scan: LaserScan, settings: Settings, side: int, seconds: float) -> Decision:
    """Drive on while the lane ahead is free; else slow down, stop at `stop_distance`, and turn to one side.

    `side` is the one to which it has been turning, `seconds` have passed since the last scan (0: not known). inf, NaN,
    any number of beams, any field of view and start angle are fine. A scan that does not look ahead, or has measured
    nothing, makes the robot stand still.
    """
    if not in_view(scan, np.zeros(1))[0]:
        return Decision(Twist(), 0, "no beam looks ahead: standing still")
    angles, ranges = returns(scan)
    free = lane_ahead(angles, ranges, settings.half_width)
    slow = max(SLOW_AHEAD, settings.speed * max(SLOW_SECONDS, SCANS_TO_STOP * seconds))
    share = min(1.0, max(0.0, (free - settings.stop_distance) / slow))
    if share == 1.0:
        return Decision(Twist(linear=Vector3(x=settings.speed)), 0, f"driving ahead, {said(free)} free")
    side = side or roomier_side(angles, ranges)
    turn_speed = min(settings.turn_speed, TURN_BETWEEN_SCANS / seconds) if seconds else settings.turn_speed
    twist = Twist(linear=Vector3(x=settings.speed * share), angular=Vector3(z=side * turn_speed * (1.0 - share)))
    return Decision(twist, side, f"turning {'left' if side > 0 else 'right'}, something {said(free)} ahead")


def roomier_side(angles: Array, ranges: Array) -> int:
    """Return the side of the way ahead with more room: 1 the left, -1 the right; near things count most."""
    ahead = np.cos(angles) > 0.0
    return -1 if float(np.sum(np.sin(angles[ahead]) / ranges[ahead])) > 0.0 else 1


def said(distance: float) -> str:
    """Return a distance in words."""
    return f"{distance:.1f} m" if math.isfinite(distance) else "all"
