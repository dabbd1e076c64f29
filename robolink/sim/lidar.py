"""A planar laser scanner, exact and without rays: each shape covers one interval of beams.

Seen from the sensor a segment spans an interval of beam indices. All intervals are expanded once into (beam,
shape) pairs; the inverse range of a beam with direction u to a line is ``u . g``, linear in u, where ``g`` is the
line's foot point over its squared distance. The nearest shape is then the largest inverse range of each beam.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from robolink.sim.description import Lidar, Pose
from robolink.sim.geometry import Array

Indices: TypeAlias = npt.NDArray[np.intp]

_EDGE = 1e-6
"""How far, in beams, an interval reaches beyond its ends, so that rounding leaves no gap at a corner."""


class Scan(NamedTuple):
    """One scan: angles in radians, ranges in metres as float64; +inf no return, -inf nearer than `range_min`."""

    angle_min: float
    angle_max: float
    angle_increment: float
    range_min: float
    range_max: float
    ranges: Array


class Beams:
    """The fixed directions of a scanner's beams, in its own frame."""

    def __init__(self, lidar: Lidar) -> None:
        full = lidar.fov == 360.0
        fov = math.tau if full else math.radians(lidar.fov)
        self.count = lidar.beams
        self.increment = fov / (lidar.beams if full else lidar.beams - 1)
        self.start = -fov / 2 if lidar.start is None else math.radians(lidar.start)
        self.period = float(lidar.beams) if full else math.tau / self.increment
        angles = self.start + self.increment * np.arange(lidar.beams)
        self.cos, self.sin = np.cos(angles), np.sin(angles)


def distances(beams: Beams, sensor: Pose, segments: Array, circles: Array) -> Array:
    """Give what each beam of a sensor at a pose (in the world) hits first: metres, inf for nothing."""
    inverse = np.zeros(beams.count)
    if len(segments):
        _see_segments(inverse, beams, _segments_in_frame(sensor, segments))
    if len(circles):
        _see_circles(inverse, beams, sensor, circles)
    with np.errstate(divide="ignore"):
        return 1.0 / inverse


def limited(ranges: Array, range_min: float, range_max: float) -> Array:
    """Apply a scanner's limits as REP 117 has it: beyond the farthest +inf, nearer than the nearest -inf."""
    ranges = np.where(ranges > range_max, np.inf, ranges)
    return np.where(ranges < range_min, -np.inf, ranges)


def _segments_in_frame(sensor: Pose, segments: Array) -> tuple[Array, Array, Array, Array]:
    """Turn segments into the sensor's frame: x and y of both ends."""
    cos, sin = math.cos(sensor.theta), math.sin(sensor.theta)
    x1, y1 = segments[:, 0] - sensor.x, segments[:, 1] - sensor.y
    x2, y2 = segments[:, 2] - sensor.x, segments[:, 3] - sensor.y
    return cos * x1 + sin * y1, cos * y1 - sin * x1, cos * x2 + sin * y2, cos * y2 - sin * x2


def _see_segments(inverse: Array, beams: Beams, ends: tuple[Array, Array, Array, Array]) -> None:
    x1, y1, x2, y2 = ends
    first, second = np.arctan2(y1, x1), np.arctan2(y2, x2)
    turn = second - first
    turn -= math.tau * np.rint(turn / math.tau)
    beam, owner = _pairs(beams, np.where(turn >= 0.0, first, second), np.abs(turn))
    gx, gy, largest = _inverse_ranges(x1, y1, x2, y2)
    seen = beams.cos[beam] * gx[owner] + beams.sin[beam] * gy[owner]
    np.maximum.at(inverse, beam, np.minimum(seen, largest[owner]))


def _inverse_ranges(x1: Array, y1: Array, x2: Array, y2: Array) -> tuple[Array, Array, Array]:
    """Give the vector g of each segment's line, and the inverse of the segment's least distance.

    No beam can see a segment nearer than that: it bounds the beams that pass just beside an end, whose range to
    the line would mean nothing when the segment is seen edge-on.
    """
    dx, dy = x2 - x1, y2 - y1
    along = x1 * dx + y1 * dy
    share = np.minimum(np.maximum(-along / (dx * dx + dy * dy), 0.0), 1.0)
    near_x, near_y = x1 + share * dx, y1 + share * dy
    largest = 1.0 / np.maximum(np.hypot(near_x, near_y), 1e-12)
    cross = x1 * dy - y1 * dx
    edge_on = np.abs(cross) < 1e-12
    cross = np.where(edge_on, 1.0, cross)
    square = largest * largest
    return np.where(edge_on, near_x * square, dy / cross), np.where(edge_on, near_y * square, -dx / cross), largest


def _see_circles(inverse: Array, beams: Beams, sensor: Pose, circles: Array) -> None:
    """Merge circles in: with p the centre along the beam and k beside it, the range is p - sqrt(r² - k²)."""
    cos, sin = math.cos(sensor.theta), math.sin(sensor.theta)
    dx, dy, radius = circles[:, 0] - sensor.x, circles[:, 1] - sensor.y, circles[:, 2]
    x, y = cos * dx + sin * dy, cos * dy - sin * dx
    distance = np.hypot(x, y)
    outside = distance > radius
    half = np.where(outside, np.arcsin(np.minimum(radius / np.maximum(distance, 1e-12), 1.0)), math.pi)
    beam, owner = _pairs(beams, np.arctan2(y, x) - half, 2 * half)
    along = beams.cos[beam] * x[owner] + beams.sin[beam] * y[owner]
    beside = beams.cos[beam] * y[owner] - beams.sin[beam] * x[owner]
    seen = along - np.sqrt(np.maximum(radius[owner] ** 2 - beside**2, 0.0))
    np.maximum.at(inverse, beam, 1.0 / np.maximum(seen, 1e-12))


def _pairs(beams: Beams, start: Array, width: Array) -> tuple[Indices, Indices]:
    """Expand intervals of angles into all (beam, owner) pairs; `owner` is the interval's index."""
    low = (start - beams.start) / beams.increment
    low -= beams.period * np.floor(low / beams.period)
    high = low + width / beams.increment
    again = np.flatnonzero(high > beams.period - 1.0)  # these reach round to the first beams
    owner = np.concatenate((np.arange(len(low)), again))
    low = np.concatenate((low, low[again] - beams.period))
    high = np.concatenate((high, high[again] - beams.period))
    first = np.maximum(np.ceil(low - _EDGE), 0.0).astype(np.intp)
    last = np.minimum(np.floor(high + _EDGE), beams.count - 1.0).astype(np.intp)
    counts = np.maximum(last - first + 1, 0)
    ends = np.cumsum(counts)
    beam = np.arange(ends[-1]) + np.repeat(first - ends + counts, counts)
    return beam, np.repeat(owner, counts)
