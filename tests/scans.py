"""Laser scans for tests."""

from __future__ import annotations

import math

from robolink.interfaces.sensor_msgs.msg import LaserScan


def ring(*ranges: float, start: float = -math.pi) -> LaserScan:
    """A scan of a full circle."""
    step = math.tau / max(1, len(ranges))
    return LaserScan(angle_min=start, angle_increment=step, range_min=0.1, range_max=10.0, ranges=list(ranges))


def sector(low: float, high: float, beams: int = 91, distance: float = math.inf) -> LaserScan:
    """A scan from one angle to another, in degrees; clockwise when the first is the greater one."""
    start, end = math.radians(low), math.radians(high)
    step = (end - start) / (beams - 1)
    return LaserScan(angle_min=start, angle_increment=step, range_min=0.1, range_max=10.0, ranges=[distance] * beams)
