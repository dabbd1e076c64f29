"""Laser scans as angles and ranges that one can trust: beams by angle, and inf and NaN as REP 117 means them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from robolink.interfaces.sensor_msgs.msg import LaserScan

Array: TypeAlias = npt.NDArray[np.float64]


def returns(scan: LaserScan) -> tuple[Array, Array]:
    """Give the angles (radians, 0 ahead, in [-pi, pi]) and ranges (metres) of the beams that met something.

    +inf, NaN and what lies outside of the scan's limits is no return; -inf is one at `range_min`, since it
    means nearer than that. Any number of beams, any field of view and start angle will do, and both arrays are
    empty when nothing is in reach.
    """
    ranges = np.array(scan.ranges, dtype=np.float64)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges), dtype=np.float64)
    ranges[np.isneginf(ranges)] = max(scan.range_min, 1e-3)
    farthest = scan.range_max if scan.range_max > 0.0 else math.inf
    met = (ranges >= scan.range_min) & (ranges <= farthest) & (ranges > 0.0) & np.isfinite(ranges)
    return wrapped(angles[met]), ranges[met]


def wrapped(angles: Array) -> Array:
    """Bring angles into [-pi, pi]."""
    turns: Array = np.rint(angles / math.tau)
    return angles - math.tau * turns
