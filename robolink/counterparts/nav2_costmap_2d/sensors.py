"""Points that sensors see, from laser scans and point clouds."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np

from robolink.geometry.trigonometry import cos_and_sin
from robolink.interfaces.geometry_msgs.msg import Transform
from robolink.interfaces.sensor_msgs.msg import LaserScan, PointCloud2
from robolink.navigation.grid import Floats
from robolink.sensor_msgs_py.point_cloud2 import read_points

MOST_BEAMS = 100_000
"""Most beams of a scan: one with more is refused, since its angles would be computed for nothing."""
MOST_ANGLE = 1000.0
"""Largest angle of a beam in radians."""
WITHIN = 0.0001
"""Metres by which a beam that met nothing ends before the sensor's range, as in Nav2."""


def points_of(message: LaserScan | PointCloud2, *, inf_is_valid: bool) -> tuple[Floats, Floats, Floats]:
    """Return the points of a message in the frame of its header, as x, y and z in metres.

    Beams that are not numbers or out of the sensor's range are left out.

    Args:
        message: The scan or cloud.
        inf_is_valid: True has beams of a scan that met nothing end at its range.

    Raises:
        ValueError: if the message contradicts itself.
    """
    if isinstance(message, LaserScan):
        x, y = _points_of_scan(message, inf_is_valid)
        return x, y, np.zeros_like(x)
    points: Any = read_points(message, ["x", "y", "z"], skip_nans=True)
    x, y, z = (points[axis].astype(np.float64).ravel() for axis in "xyz")
    finite = np.isfinite(x) & np.isfinite(y) & np.isfinite(z)
    return x[finite], y[finite], z[finite]


def _points_of_scan(scan: LaserScan, inf_is_valid: bool) -> tuple[Floats, Floats]:
    count = len(scan.ranges)
    bounds = scan.angle_min, scan.angle_increment, scan.range_min, scan.range_max
    widest = max(abs(scan.angle_min), abs(scan.angle_min + count * scan.angle_increment))
    if count > MOST_BEAMS or not all(map(math.isfinite, bounds)) or widest > MOST_ANGLE:
        raise ValueError(f"{count} beams, and angle_min, angle_increment, range_min and range_max are {bounds}")
    ranges = np.asarray(scan.ranges, np.float64)
    if inf_is_valid:
        ranges = np.where(ranges == math.inf, scan.range_max - WITHIN, ranges)
    seen = (ranges >= scan.range_min) & (ranges < scan.range_max)  # false for what is not a number
    cos, sin = _directions(scan.angle_min, scan.angle_increment, count)
    ranges = ranges[seen]
    return ranges * cos[seen], ranges * sin[seen]


@lru_cache(maxsize=16)
def _directions(first: float, increment: float, count: int) -> tuple[Floats, Floats]:
    return cos_and_sin(first + increment * np.arange(count, dtype=np.float64))  # the same bits on every machine


def moved(transform: Transform, x: Floats, y: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
    """Return points in the frame that a transform leads to."""
    q, place = transform.rotation, transform.translation
    xx, yy, zz, ww = q.x * q.x, q.y * q.y, q.z * q.z, q.w * q.w
    xy, xz, yz, wx, wy, wz = q.x * q.y, q.x * q.z, q.y * q.z, q.w * q.x, q.w * q.y, q.w * q.z
    return (
        (ww + xx - yy - zz) * x + 2.0 * (xy - wz) * y + 2.0 * (xz + wy) * z + place.x,
        2.0 * (xy + wz) * x + (ww - xx + yy - zz) * y + 2.0 * (yz - wx) * z + place.y,
        2.0 * (xz - wy) * x + 2.0 * (yz + wx) * y + (ww - xx - yy + zz) * z + place.z,
    )
