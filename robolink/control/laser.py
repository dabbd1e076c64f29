"""Laser scans as arrays of angles and ranges, with inf and NaN as in REP 117; and free lanes among them."""

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

_AHEAD = np.zeros(1)

LONGEST_GAP = 2.0
"""Longest time between two successive scans, in seconds."""


def returns(scan: LaserScan) -> tuple[Array, Array]:
    """Return the angles (radians, 0 ahead, in [-pi, pi]) and ranges (metres) of the beams of `scan` that met something.

    +inf, NaN and what lies outside of the scan's limits is not a return; -inf is one at `range_min`, since it
    means nearer than that. Any number of beams, any field of view and start angle will do, and both arrays are
    empty when nothing is in reach.
    """
    met, ranges = _met(scan)
    if not len(met):
        return np.empty(0), ranges
    return _directions(scan.angle_min, scan.angle_increment, len(scan.ranges))[met], ranges


def points(scan: LaserScan) -> tuple[Array, Array]:
    """Return the points that the beams of `scan` met, as `returns` does: metres ahead, and metres to the left."""
    met, ranges = _met(scan)
    if not len(met):
        return np.empty(0), ranges
    ahead, aside = _units(scan.angle_min, scan.angle_increment, len(scan.ranges))
    return ranges * ahead[met], ranges * aside[met]


def _met(scan: LaserScan) -> tuple[npt.NDArray[np.intp], Array]:
    """Return which beams of a scan met something, and their ranges."""
    ranges = np.array(scan.ranges if _has_angles(scan) else (), dtype=np.float64)
    ranges[ranges == -math.inf] = max(scan.range_min, 1e-3)
    nearest = max(scan.range_min, sys.float_info.min)
    farthest = min(scan.range_max, sys.float_info.max) if scan.range_max > 0.0 else sys.float_info.max
    (met,) = ((ranges >= nearest) & (ranges <= farthest)).nonzero()
    return met, ranges[met]


@functools.lru_cache(maxsize=16)
def _directions(start: float, increment: float, count: int) -> Array:
    """Return the angles of beams; a scanner's are the same in each of its scans."""
    return wrapped(start + increment * np.arange(count, dtype=np.float64))


@functools.lru_cache(maxsize=16)
def _units(start: float, increment: float, count: int) -> tuple[Array, Array]:
    """Return the cosines and sines of these angles."""
    angles = _directions(start, increment, count)
    return np.cos(angles), np.sin(angles)


def looks_ahead(scan: LaserScan) -> bool:
    """True if straight ahead lies in the field of view of `scan`, as for `in_view`."""
    return bool(in_view(scan, _AHEAD)[0])


def in_view(scan: LaserScan, angles: Array) -> npt.NDArray[np.bool_]:
    """Return for each of `angles` (radians) True if it lies in the field of view of `scan`.

    That is anywhere between its first and its last beam. A scan without beams sees nothing, and nor does one of
    which every beam is NaN: it has measured nothing.
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
    """True if the beams of `scan` go all round, so that nothing is out of its view."""
    return len(scan.ranges) * abs(scan.angle_increment) > math.tau - 1e-3


def _has_angles(scan: LaserScan) -> bool:
    return len(scan.ranges) > 0 and math.isfinite(scan.angle_min) and math.isfinite(scan.angle_increment)


def seconds_between(earlier: LaserScan | None, later: LaserScan) -> float:
    """Return the seconds from the scan `earlier` (None: there is none) to `later`.

    That is the difference of their stamps, or if that is 0 the field `scan_time` of `later`.

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
    """Return the free length of the lane that a robot sweeps driving ahead, in metres from the sensor; inf if all is.

    Args:
        angles: Directions of a scan's returns in radians, as from `returns`.
        ranges: Their distances in metres.
        half_width: Width of the lane to each side, in metres.
    """
    return lane_among(ranges * np.cos(angles), ranges * np.sin(angles), half_width)


def lane_among(forward: Array, aside: Array, half_width: float) -> float:
    """Return the free length of a lane as `lane_ahead`, from points.

    Args:
        forward: Metres of each point ahead of the sensor.
        aside: Metres of each point to its left.
        half_width: Width of the lane to each side, in metres.
    """
    inside = (forward > 0.0) & (np.abs(aside) < half_width)
    return float(forward[inside].min(initial=math.inf))


def wrapped(angles: Array) -> Array:
    """Return `angles` in radians brought into [-pi, pi]."""
    turns: Array = np.rint(angles / math.tau)
    return angles - math.tau * turns
