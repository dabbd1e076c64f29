"""Ends of a scan's beams in the robot's own frame, wherever and however its scanner is mounted."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from robolink.geometry.trigonometry import cos_and_sin
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.navigation.localization import Beams
from robolink.tf2.geometry import rotation_of

MOST_ANGLE = 100.0
"""Largest angle of a beam in radians: a larger one is a mistake."""


class Limits(NamedTuple):
    """Limits of the beams that are used: their number, and their ranges in metres; -1 stands for the scanner's own."""

    max_beams: int = 60
    min_range: float = -1.0
    max_range: float = 100.0


def fault(scan: LaserScan) -> str:
    """Return the mistake of a scan; '' if it can be used."""
    last = scan.angle_min + scan.angle_increment * max(len(scan.ranges) - 1, 0)
    if not all(abs(each) <= MOST_ANGLE for each in (scan.angle_min, last)):
        return f"expected angles within {MOST_ANGLE:g} rad, got {scan.angle_min:g} to {last:g}"
    if not scan.header.frame_id:
        return "its frame_id is empty"
    return ""


def beams_of(scan: LaserScan, mount: TransformStamped, limits: Limits) -> Beams:
    """Return the ends of the beams of a scan that are used: evenly spaced ones, of those that met something.

    Args:
        scan: Scan without a `fault`.
        mount: Transform from the scanner's frame to the robot's.
        limits: Beams that are used.
    """
    longest = scan.range_max if 0.0 < scan.range_max < math.inf else math.inf
    if limits.max_range > 0.0:
        longest = min(longest, limits.max_range)
    nearest = max(scan.range_min, limits.min_range) if limits.min_range > 0.0 else scan.range_min
    count = len(scan.ranges)
    step = max((count - 1) // (limits.max_beams - 1), 1) if limits.max_beams > 1 else max(count, 1)
    ranges = np.array(scan.ranges[::step], np.float64)
    angles = scan.angle_min + scan.angle_increment * np.arange(0, count, step, dtype=np.float64)
    met = (ranges > nearest) & (ranges < longest)  # NaN is neither
    ranges = ranges[met]
    cos, sin = cos_and_sin(angles[met])
    turned, place = rotation_of(mount.transform), mount.transform.translation
    ahead = ranges * (turned[0, 0] * cos + turned[0, 1] * sin) + place.x
    aside = ranges * (turned[1, 0] * cos + turned[1, 1] * sin) + place.y
    known = longest if math.isfinite(longest) else float(ranges.max(initial=1.0))
    return Beams(ahead, aside, known, scan.header.frame_id)
