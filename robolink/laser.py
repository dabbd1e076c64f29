"""Laser scans as angles and ranges that one can trust: beams by angle, and inf and NaN as REP 117 means them."""

from __future__ import annotations

import functools
import math
import sys
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
    ranges[ranges == -math.inf] = max(scan.range_min, 1e-3)
    nearest = max(scan.range_min, sys.float_info.min)
    farthest = min(scan.range_max, sys.float_info.max) if scan.range_max > 0.0 else sys.float_info.max
    met = (ranges >= nearest) & (ranges <= farthest)
    return _directions(scan.angle_min, scan.angle_increment, len(ranges))[met], ranges[met]


@functools.lru_cache(maxsize=16)
def _directions(start: float, increment: float, count: int) -> Array:
    """Give the angles of beams; a scanner's are the same in each of its scans."""
    return wrapped(start + increment * np.arange(count, dtype=np.float64))


def in_view(scan: LaserScan, angles: Array) -> npt.NDArray[np.bool_]:
    """Tell of angles, in radians, whether the scan looks there: anywhere between its first and its last beam.

    A scan without beams looks nowhere, and nor does one of which every beam is NaN: it has measured nothing.
    """
    if not _has_angles(scan) or (math.isnan(scan.ranges[0]) and np.isnan(scan.ranges).all()):
        return np.zeros(len(angles), dtype=np.bool_)
    if looks_all_round(scan):
        return np.ones(len(angles), dtype=np.bool_)
    beams, step = len(scan.ranges), abs(scan.angle_increment)
    middle = scan.angle_min + scan.angle_increment * (beams - 1) / 2
    looks: npt.NDArray[np.bool_] = np.abs(wrapped(angles - middle)) <= step * (beams - 1) / 2 + 1e-6
    return looks


def looks_all_round(scan: LaserScan) -> bool:
    """Tell whether a scan's beams go all round, so that nothing is out of its view."""
    return len(scan.ranges) * abs(scan.angle_increment) > math.tau - 1e-3


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
    return lane_among(ranges * np.cos(angles), ranges * np.sin(angles), half_width)


def lane_among(forward: Array, aside: Array, half_width: float) -> float:
    """Give what `lane_ahead` gives of points: metres ahead of the sensor, and metres to its left."""
    inside = (forward > 0.0) & (np.abs(aside) < half_width)
    return float(forward[inside].min(initial=math.inf))


def wrapped(angles: Array) -> Array:
    """Bring angles into [-pi, pi]."""
    turns: Array = np.rint(angles / math.tau)
    return angles - math.tau * turns
