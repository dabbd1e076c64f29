"""Sonar and infrared sensors: the exact distance to the nearest point within a cone."""

from __future__ import annotations

import math

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.quantities import Pose


def nearest_in_cone(sensor: Pose, fov: float, segments: Array, circles: Array) -> float:
    """Return the distance in metres from a sensor to the nearest point of anything within `fov` degrees about ahead.

    `segments` are columns x1, x2, y1, y2 and `circles` columns x, y, radius, in the world. inf if there is nothing.
    """
    half = math.radians(fov) / 2
    return min(_nearest_of_segments(sensor, half, segments), _nearest_of_circles(sensor, half, circles))


def _in_frame(sensor: Pose, x: Array, y: Array) -> tuple[Array, Array]:
    cos, sin = math.cos(sensor.theta), math.sin(sensor.theta)
    dx, dy = x - sensor.x, y - sensor.y
    return cos * dx + sin * dy, cos * dy - sin * dx


def _nearest_of_segments(sensor: Pose, half: float, segments: Array) -> float:
    """Return the distance of the nearest point of the segments, clipped to the cone."""
    x1, y1 = _in_frame(sensor, segments[0], segments[2])
    x2, y2 = _in_frame(sensor, segments[1], segments[3])
    dx, dy = x2 - x1, y2 - y1
    low, high = _part_in_cone(half, x1, y1, x2, y2)
    square = np.maximum(dx * dx + dy * dy, 1e-300)
    share = np.minimum(np.maximum(-(x1 * dx + y1 * dy) / square, low), high)
    x, y = x1 + share * dx, y1 + share * dy
    distances = np.where(low <= high, np.sqrt(x * x + y * y), np.inf)
    return float(np.min(distances, initial=math.inf))


def _part_in_cone(half: float, x1: Array, y1: Array, x2: Array, y2: Array) -> tuple[Array, Array]:
    """Return the first and last share of each segment that lies in the cone, the intersection of two half-planes."""
    cos, sin = math.cos(half), math.sin(half)
    low, high = np.zeros(len(x1)), np.ones(len(x1))
    for side in (cos, -cos):
        first, second = sin * x1 + side * y1, sin * x2 + side * y2  # not negative: in this half-plane
        parallel = first == second
        crossing = first / np.where(parallel, 1.0, first - second)
        crossing = np.where(parallel, np.where(first >= 0.0, 1.0, -1.0), crossing)
        leaving = first >= second
        high = np.where(leaving, np.minimum(high, crossing), high)
        low = np.where(leaving, low, np.maximum(low, crossing))
    return low, high


def _nearest_of_circles(sensor: Pose, half: float, circles: Array) -> float:
    """Return the distance of the nearest circle: to its nearest point, or to where the cone's nearer edge meets it."""
    (x, y), radius = _in_frame(sensor, circles[0], circles[1]), circles[2]
    straight = np.sqrt(x * x + y * y) - radius
    y = np.abs(y)
    cos, sin = math.cos(half), math.sin(half)
    ahead, aside = cos * x + sin * y, cos * y - sin * x  # along that edge, and beside it: positive outside
    root = radius * radius - aside * aside
    at_edge = np.where((root >= 0.0) & (ahead > 0.0), ahead - np.sqrt(np.maximum(root, 0.0)), np.inf)
    distances = np.where((aside <= 0.0) | (straight <= 0.0), straight, at_edge)
    return max(0.0, float(np.min(distances, initial=math.inf)))
