"""Drive ahead; turn away from what is near.

The robot looks at its lane: what it sweeps when it drives on. The less of it is free, the slower it drives and the
faster it turns, to the side with more room, and to that side until the lane is free again, or it would dither in
corners.
"""

import contextlib
import math
from typing import Any, NamedTuple

import numpy as np

from robolink import Node
from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.laser import Array, in_view, lane_ahead, returns
from robolink.parameter_descriptors import described

SLOW_AHEAD, SLOW_SECONDS = 0.6, 1.0
"""So many metres, or so many seconds at full speed, before `stop_distance` the robot slows down and begins to turn."""

SCANS_TO_STOP = 2.0
"""And it begins so many scans before, should they come seldom."""

TURN_BETWEEN_SCANS = 0.6
"""Radians at most by which it turns from one scan to the next: it is not to turn past a gap."""

LONGEST = 2.0
"""Seconds between two scans that still belong together."""


class Settings(NamedTuple):
    """How to drive; the parameters of the node have the same names. Metres, m/s, rad/s."""

    speed: float = 0.4
    stop_distance: float = 0.5
    half_width: float = 0.27
    turn_speed: float = 1.0


PARAMETERS = {
    "speed": described("m/s where the lane is free", 0.01, 5.0),
    "stop_distance": described("metres from the lidar to what it stops for; more than the robot's nose", 0.05, 10.0),
    "half_width": described("metres from the lane's middle to its edge: half the robot and some room", 0.02, 5.0),
    "turn_speed": described("rad/s where the robot stands", 0.05, 10.0),
    "timeout": described("seconds without a scan after which the robot stops", 0.05, 60.0),
}


class Memory(NamedTuple):
    """What one scan leaves to the next: the side it turns to (1 left, -1 right, 0 neither), and its stamp in s."""

    side: int = 0
    stamp: float = math.nan


class Decision(NamedTuple):
    """What to do, what to remember, and why, in words."""

    twist: Twist
    memory: Memory
    words: str


class ReactiveController(Node):
    """Turns each scan into a velocity command; stops the robot when there are no scans, and at its own end."""

    is_driving = False

    def __init__(self, **options: Any) -> None:
        super().__init__("reactive_controller", **options)
        for name, value in Settings()._asdict().items():
            self.declare_parameter(name, value, PARAMETERS[name])
        timeout = self.declare_parameter("timeout", 0.5, PARAMETERS["timeout"]).value
        self.memory = Memory()
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.watchdog = self.create_timer(timeout, self.on_silence)

    def on_scan(self, scan: LaserScan) -> None:
        """Decide and act."""
        settings = Settings(*(self.get_parameter(name).value for name in Settings._fields))
        decision = steer(scan, settings, self.memory)
        self.memory = decision.memory
        self.is_driving = True
        self.cmd_vel.publish(decision.twist)
        self.get_logger().info(decision.words, throttle_duration_sec=2.0)
        self.watchdog.timer_period_ns = int(self.get_parameter("timeout").value * 1e9)
        self.watchdog.reset()

    def on_silence(self) -> None:
        """Stop, and say why, once: the next scan winds the watchdog up again."""
        self.watchdog.cancel()
        self.stop()
        seconds, topic = self.get_parameter("timeout").value, self.resolve_topic_name("scan")
        self.get_logger().warning(f"no scan on {topic} for {seconds:g} s: the robot stands until one comes")

    def stop(self) -> None:
        """Leave the robot standing, if it was driving."""
        if self.is_driving:
            self.is_driving = False
            self.cmd_vel.publish(Twist())

    def destroy_node(self) -> None:
        """Stop the robot, as long as somebody can be told."""
        with contextlib.suppress(RobolinkError):
            self.stop()
        super().destroy_node()


def steer(scan: LaserScan, settings: Settings, memory: Memory) -> Decision:
    """Drive on while the lane ahead is free; else slow down, stop at `stop_distance`, and turn to one side.

    inf, NaN, any number of beams, any field of view and start angle are fine. A scan that does not look ahead, or has
    measured nothing, makes the robot stand still.
    """
    if not in_view(scan, np.zeros(1))[0]:
        return Decision(Twist(), Memory(), "no beam looks ahead: standing still")
    stamp = scan.header.stamp.sec + scan.header.stamp.nanosec * 1e-9
    dt = seconds_between(memory.stamp, stamp, scan.scan_time)
    angles, ranges = returns(scan)
    free = lane_ahead(angles, ranges, settings.half_width)
    slow = max(SLOW_AHEAD, settings.speed * max(SLOW_SECONDS, SCANS_TO_STOP * dt))
    share = min(1.0, max(0.0, (free - settings.stop_distance) / slow))
    if share == 1.0:
        return Decision(Twist(linear=Vector3(x=settings.speed)), Memory(0, stamp), f"driving ahead, {said(free)} free")
    side = memory.side or roomier_side(angles, ranges)
    turn_speed = min(settings.turn_speed, TURN_BETWEEN_SCANS / dt) if dt else settings.turn_speed
    twist = Twist(linear=Vector3(x=settings.speed * share), angular=Vector3(z=side * turn_speed * (1.0 - share)))
    words = f"turning {'left' if side > 0 else 'right'}, something {said(free)} ahead"
    return Decision(twist, Memory(side, stamp), words)


def seconds_between(before: float, now: float, scan_time: float) -> float:
    """Give the seconds from scan to scan: by their stamps, or by `scan_time` if these do not tell; 0 if none does."""
    dt = now - before
    if math.isnan(dt) or dt == 0.0:
        dt = scan_time
    return dt if 0.0 < dt <= LONGEST else 0.0


def roomier_side(angles: Array, ranges: Array) -> int:
    """Tell which side of the way ahead is less crowded: 1 the left, -1 the right; what is near crowds most."""
    ahead = np.cos(angles) > 0.0
    return -1 if float(np.sum(np.sin(angles[ahead]) / ranges[ahead])) > 0.0 else 1


def said(distance: float) -> str:
    """Say a distance."""
    return f"{distance:.1f} m" if math.isfinite(distance) else "all"
