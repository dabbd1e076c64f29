"""Laser scans for tests."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Header


def ring(*ranges: float, start: float = -math.pi) -> LaserScan:
    """A scan of a full circle."""
    step = math.tau / max(1, len(ranges))
    return LaserScan(angle_min=start, angle_increment=step, range_min=0.1, range_max=10.0, ranges=list(ranges))


def sector(low: float, high: float, beams: int = 91, distance: float = math.inf) -> LaserScan:
    """A scan from one angle to another, in degrees; clockwise when the first is the greater one."""
    start, end = math.radians(low), math.radians(high)
    step = (end - start) / (beams - 1)
    return LaserScan(angle_min=start, angle_increment=step, range_min=0.1, range_max=10.0, ranges=[distance] * beams)


def at(scan: LaserScan, seconds: float) -> LaserScan:
    """The scan with a stamp."""
    scan.header = Header(stamp=Time(sec=int(seconds), nanosec=round(seconds % 1 * 1e9)))
    return scan


NOTHING = [ring(*[math.inf] * 360), ring(0.0, 0.05, 11.0, -1.0), ring(*[math.inf, math.nan] * 50)]
"""Scans that have met nothing."""

BLIND = [ring(), ring(*[math.nan] * 90), sector(30, 150), sector(-30, -150), ring(1.0, start=math.nan)]
"""Scans that do not look ahead, or have measured nothing."""


def any_scan() -> st.SearchStrategy[LaserScan]:
    """Scans of any lidar, good and bad."""
    return st.builds(
        LaserScan,
        angle_min=st.floats(-10, 10),
        angle_increment=st.floats(-1, 1),
        range_min=st.floats(0, 1),
        range_max=st.floats(0, 20),
        ranges=st.lists(st.floats(width=32), max_size=50),
    )
