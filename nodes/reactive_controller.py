"""Drive ahead; turn away from what is near."""

import math
from typing import Any, NamedTuple

import numpy as np

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.laser import Array, returns

TURN_SPEED = 1.0
SLOW_AHEAD = 0.6
"""Metres before `stop_distance` in which the robot slows down and begins to turn."""


class Decision(NamedTuple):
    """What to do, the side it is turning to (1 left, -1 right, 0 neither) to remember, and why, in words."""

    twist: Twist
    side: int
    words: str


class ReactiveController(Node):
    """Turns each scan into a velocity command."""

    def __init__(self, **options: Any) -> None:
        super().__init__("reactive_controller", **options)
        self.declare_parameter("speed", 0.4)
        self.declare_parameter("stop_distance", 0.5)
        self.declare_parameter("half_width", 0.27)
        self.side = 0
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        """Decide and act."""
        speed, stop_distance, half_width = (
            self.get_parameter(name).value for name in ("speed", "stop_distance", "half_width")
        )
        decision = steer(scan, speed, stop_distance, half_width, self.side)
        self.side = decision.side
        self.cmd_vel.publish(decision.twist)
        self.get_logger().info(decision.words, throttle_duration_sec=2.0)


def steer(
    scan: LaserScan, speed: float = 0.4, stop_distance: float = 0.5, half_width: float = 0.27, side: int = 0
) -> Decision:
    """Drive at `speed` while the lane ahead is free; else slow down, stop at `stop_distance`, turn to one side.

    The lane is what the robot sweeps when it drives on, `half_width` metres to both sides. Once it has begun to
    turn it goes on turning to that `side` until the lane is free, or it would dither in corners. inf, NaN, an
    empty scan and any field of view are fine.
    """
    angles, ranges = returns(scan)
    free = lane_ahead(angles, ranges, half_width)
    share = min(1.0, max(0.0, (free - stop_distance) / SLOW_AHEAD))
    if share == 1.0:
        return Decision(Twist(linear=Vector3(x=speed)), 0, f"driving ahead, {said(free)} free")
    side = side or roomier_side(angles, ranges)
    twist = Twist(linear=Vector3(x=speed * share), angular=Vector3(z=side * TURN_SPEED * (1.0 - share)))
    return Decision(twist, side, f"turning {'left' if side > 0 else 'right'}, something {said(free)} ahead")


def lane_ahead(angles: Array, ranges: Array, half_width: float) -> float:
    """Give the free length of the lane ahead, in metres from the sensor; inf when nothing is in it."""
    forward, aside = ranges * np.cos(angles), ranges * np.sin(angles)
    inside = (forward > 0.0) & (np.abs(aside) < half_width)
    return float(forward[inside].min(initial=math.inf))


def roomier_side(angles: Array, ranges: Array) -> int:
    """Tell which side of the way ahead is less crowded: 1 the left, -1 the right; what is near crowds most."""
    ahead = np.cos(angles) > 0.0
    return -1 if float(np.sum(np.sin(angles[ahead]) / ranges[ahead])) > 0.0 else 1


def said(distance: float) -> str:
    """Say a distance."""
    return f"{distance:.1f} m" if math.isfinite(distance) else "all"
