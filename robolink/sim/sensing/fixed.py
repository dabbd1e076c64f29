"""Static geometry of a world as arrays: segments, circles, and the distance to the nearest of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeAlias

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.description import Obstacle, WorldDescription
from robolink.sim.quantities import Pose

Corners: TypeAlias = Sequence[tuple[float, float]]


def fixed_segments(description: WorldDescription) -> Array:
    """Return walls and the edges of fixed boxes and polygons as rows x1, y1, x2, y2."""
    rows = [[*start, *end] for wall in description.walls for start, end in wall.segments()]
    parts = [np.array(rows, dtype=np.float64).reshape(-1, 4)]
    for thing in _fixed(description):
        if thing.circle is None:
            parts.append(edges(thing.corners(), thing.start))
    return np.concatenate(parts)


def fixed_circles(description: WorldDescription) -> Array:
    """Return the fixed circles as rows x, y, radius."""
    rows = [[thing.start.x, thing.start.y, thing.circle] for thing in _fixed(description) if thing.circle is not None]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)


def fixed_reflectances(description: WorldDescription) -> tuple[Array, Array]:
    """Return the reflectances of the fixed segments and of the fixed circles, in their order."""
    of_walls = [wall.reflectance for wall in description.walls for _ in wall.segments()]
    fixed = _fixed(description)
    of_edges = [thing.reflectance for thing in fixed for _ in thing.corners()]
    of_circles = [thing.reflectance for thing in fixed if thing.circle is not None]
    return np.array(of_walls + of_edges, dtype=np.float64), np.array(of_circles, dtype=np.float64)


def edges(corners: Corners, pose: Pose) -> Array:
    """Return the edges of a polygon at a pose as rows x1, y1, x2, y2."""
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    local = np.asarray(corners, dtype=np.float64)
    moved = np.column_stack(
        (pose.x + cos * local[:, 0] - sin * local[:, 1], pose.y + sin * local[:, 0] + cos * local[:, 1])
    )
    return np.concatenate((moved, np.roll(moved, -1, axis=0)), axis=1)


def nearest_wall_distance(segments: Array, circles: Array, x: float, y: float) -> float:
    """Return the distance in metres from a point to the nearest segment or circle; inf in an empty world."""
    to_segments = float(np.min(segment_distances(segments, x, y), initial=math.inf))
    to_circles = np.hypot(circles[:, 0] - x, circles[:, 1] - y) - circles[:, 2]
    return min(to_segments, float(np.min(to_circles, initial=math.inf)))


def segment_distances(segments: Array, x: float, y: float) -> Array:
    """Return the distance from a point to each segment, in metres."""
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    to_point = np.array((x, y)) - start
    square = np.maximum((along * along).sum(axis=1), 1e-300)  # a segment without length is a point
    share = np.clip((to_point * along).sum(axis=1) / square, 0.0, 1.0)
    gap = to_point - share[:, None] * along
    distances: Array = np.hypot(gap[:, 0], gap[:, 1])
    return distances


def _fixed(description: WorldDescription) -> list[Obstacle]:
    return [thing for thing in description.obstacles if thing.mass is None and thing.path is None]
