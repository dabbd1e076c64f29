"""Rooms of straight walls, and what a lidar in them measures, for tests of mapping without a simulator."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose

Floats = npt.NDArray[np.float64]
Walls = Sequence[tuple[float, float, float, float]]

ROOM: Walls = (
    *((0.0, 0.0, 10.0, 0.0), (10.0, 0.0, 10.0, 8.0), (10.0, 8.0, 0.0, 8.0), (0.0, 8.0, 0.0, 0.0)),
    *((6.0, 0.0, 6.0, 3.0), (6.0, 4.2, 6.0, 8.0), (3.0, 3.0, 3.4, 3.1), (3.4, 3.1, 3.3, 3.6), (1.0, 7.0, 2.0, 6.6)),
)
"""A room of 10 by 8 metres, with a wall that has a door, and a few things in it."""
CORRIDOR: Walls = ((-100.0, -1.0, 100.0, -1.0), (-100.0, 1.0, 100.0, 1.0))
"""Two parallel walls that look alike everywhere."""


def ranges(walls: Walls, pose: Pose, beams: int = 360, noise: float = 0.01, seed: int = 0) -> Floats:
    """Return the distances in metres that a lidar measures all around; infinity where there is no wall."""
    angles = pose.theta + np.arange(beams) * math.tau / beams
    cos, sin = np.cos(angles), np.sin(angles)
    found = np.full(beams, math.inf)
    for x0, y0, x1, y1 in walls:
        dx, dy, px, py = x1 - x0, y1 - y0, x0 - pose.x, y0 - pose.y
        with np.errstate(divide="ignore", invalid="ignore"):
            across = cos * dy - sin * dx
            far, along = (px * dy - py * dx) / across, (px * sin - py * cos) / across
        np.minimum(found, far, out=found, where=(far > 0.0) & (along >= 0.0) & (along <= 1.0))
    found += np.random.default_rng(seed).normal(0.0, noise, beams) if noise else 0.0
    return found


def points(
    walls: Walls, pose: Pose, beams: int = 360, noise: float = 0.01, seed: int = 0, most: float = 12.0
) -> Floats:
    """Return the points that a lidar measures, in its own frame, as rows; those beyond `most` metres are left out."""
    found = ranges(walls, pose, beams, noise, seed)
    angles = np.arange(beams) * math.tau / beams
    near = found < most
    return np.column_stack((found[near] * np.cos(angles[near]), found[near] * np.sin(angles[near])))


def placed(pose: Pose, local: Floats) -> Floats:
    """Return points of a frame at `pose` in the frame that the pose is in."""
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    turned = np.column_stack((cos * local[:, 0] - sin * local[:, 1], sin * local[:, 0] + cos * local[:, 1]))
    turned += np.array([pose.x, pose.y])
    return turned
