"""Laser scans as angles and ranges that one can trust: beams by angle, and inf and NaN as REP 117 means them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from robolink.interfaces.sensor_msgs.msg import LaserScan

Array: TypeAlias = npt.NDArray[np.float64]

LONGEST_GAP = 2.0
"""Seconds between two scans that still belong together."""


def returns(scan: LaserScan) -> tuple[Array, Array]:
    """Give the angles (radians, 0 ahead, in [-pi, pi]) and ranges (metres) of the beams that met something.

    +inf, NaN and what lies outside of the scan's limits is no return; -inf is one at `range_min`, since it
    means nearer than that. Any number of beams, any field of view and start angle will do, and both arrays are
    empty when nothing is in reach.
    """
    ranges = np.array(scan.ranges if _has_angles(scan) else (), dtype=np.float64)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges), dtype=np.float64)
    ranges[np.isneginf(ranges)] = max(scan.range_min, 1e-3)
    farthest = scan.range_max if scan.range_max > 0.0 else math.inf
    met = (ranges >= scan.range_min) & (ranges <= farthest) & (ranges > 0.0) & np.isfinite(ranges)
    return wrapped(angles[met]), ranges[met]


def in_view(scan: LaserScan, angles: Array) -> npt.NDArray[np.bool_]:
    """Tell of angles, in radians, whether the scan looks there: anywhere between its first and its last beam.

    A scan without beams looks nowhere, and nor does one of which every beam is NaN: it has measured nothing.
    """
    beams, step = len(scan.ranges), abs(scan.angle_increment)
    if not _has_angles(scan) or np.isnan(scan.ranges).all():
        return np.zeros(len(angles), dtype=np.bool_)
    if beams * step > math.tau - 1e-3:
        return np.ones(len(angles), dtype=np.bool_)
    middle = scan.angle_min + scan.angle_increment * (beams - 1) / 2
    looks: npt.NDArray[np.bool_] = np.abs(wrapped(angles - middle)) <= step * (beams - 1) / 2 + 1e-6
    return looks


def _has_angles(scan: LaserScan) -> bool:
    return len(scan.ranges) > 0 and math.isfinite(scan.angle_min) and math.isfinite(scan.angle_increment)


def seconds_between(earlier: LaserScan | None, later: LaserScan) -> float:
    """Give the seconds from one scan to a later one, by `scan_time` where their stamps do not tell; 0 if nothing does.

    What lies more than two seconds apart does not belong together: that is 0, too, and so is a step back.
    """
    dt = 0.0 if earlier is None else _stamp(later) - _stamp(earlier)
    if dt == 0.0:
        dt = later.scan_time
    return dt if 0.0 < dt <= LONGEST_GAP else 0.0


def _stamp(scan: LaserScan) -> float:
    stamp = scan.header.stamp
    return float(stamp.sec + stamp.nanosec * 1e-9)


def lane_ahead(angles: Array, ranges: Array, half_width: float) -> float:
    """Give the free length of the lane that a robot sweeps driving ahead, in metres from the sensor; inf if all is.

    The lane is `half_width` metres wide to both sides; the returns are those that `returns` gives.
    """
    forward, aside = ranges * np.cos(angles), ranges * np.sin(angles)
    inside = (forward > 0.0) & (np.abs(aside) < half_width)
    return float(forward[inside].min(initial=math.inf))


def wrapped(angles: Array) -> Array:
    """Bring angles into [-pi, pi]."""
    turns: Array = np.rint(angles / math.tau)
    return angles - math.tau * turns
