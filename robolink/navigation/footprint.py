"""Footprint of a robot: its outline on the floor, and the highest cost of a costmap's cells under it."""

from __future__ import annotations

import ast
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.exceptions import RobolinkError
from robolink.navigation.grid import Floats, Grid

UNKNOWN, LETHAL, INSCRIBED, FREE = 255, 254, 253, 0
"""Costs: no information, an obstacle, a centre from which every heading collides, and nothing near."""

CORNERS = 16
"""Corners of the polygon that stands for a circle, as in Nav2."""
_EDGES = 32
"""Edges of a polygon that points are compared with at once."""
MOST_CORNERS = 1000
MOST_ROWS = 500
"""Most rows of points that cover a footprint: a larger one is covered less densely."""
FARTHEST = 100.0
"""Largest distance of a corner from the origin, in metres."""


class FootprintError(RobolinkError, ValueError):
    """A footprint without the polygon of three or more points that it needs."""


class Radii(NamedTuple):
    """Radii of a footprint about its origin in metres: of the largest circle inside, and of the smallest around it."""

    inscribed: float
    circumscribed: float


def parse_footprint(text: str) -> Floats:
    """Return the polygon that a text such as ``[[0.2, 0.2], [0.2, -0.2], [-0.2, 0]]`` names.

    Args:
        text: Corners in metres in the robot's frame, in order round the outline.

    Returns:
        Array of shape (corners, 2).

    Raises:
        FootprintError: if the text is another one, or has fewer than three corners.
    """
    try:
        corners = np.array(ast.literal_eval(text.strip()), np.float64)
    except (ValueError, SyntaxError, TypeError, RecursionError, MemoryError):
        corners = np.empty(0)
    if corners.ndim != 2 or corners.shape[1] != 2 or not 3 <= len(corners) <= MOST_CORNERS:
        raise FootprintError(f"footprint: expected [[x, y], ...] of 3 or more points in metres, got {text!r:.80}")
    if not (np.abs(corners) <= FARTHEST).all():
        raise FootprintError(f"footprint: expected points within {FARTHEST:g} m, got {text!r:.80}")
    return corners


def circle(radius: float) -> Floats:
    """Return the polygon of `CORNERS` corners that stands for a circle of `radius` metres."""
    angles = [2 * math.pi * each / CORNERS for each in range(CORNERS)]
    return np.array([(radius * math.cos(each), radius * math.sin(each)) for each in angles])


def padded(polygon: Floats, padding: float) -> Floats:
    """Return a polygon whose corners are `padding` metres farther from both axes, as Nav2 pads; those on one stay."""
    return polygon + np.sign(polygon) * padding


def radii(polygon: Floats) -> Radii:
    """Return the radii of a polygon about its origin; 0.0 inside if the origin is outside of it."""
    ends = np.roll(polygon, -1, axis=0)
    ways = ends - polygon
    lengths = np.maximum((ways * ways).sum(axis=1), 1e-18)
    shares = np.clip(-(polygon * ways).sum(axis=1) / lengths, 0.0, 1.0)
    nearest = polygon + shares[:, None] * ways
    inscribed = math.sqrt(float((nearest * nearest).sum(axis=1).min()))
    around = math.sqrt(float((polygon * polygon).sum(axis=1).max()))
    return Radii(inscribed if contains(polygon, np.zeros((1, 2)))[0] else 0.0, around)


def contains(polygon: Floats, points: Floats) -> npt.NDArray[np.bool_]:
    """Return which points lie inside of a polygon, by counting its edges to their right.

    Args:
        polygon: Corners, of shape (corners, 2).
        points: Points, of shape (points, 2).
    """
    inside = np.zeros(len(points), bool)
    x, y = points[:, 0], points[:, 1]
    ends = np.roll(polygon, -1, axis=0)
    for first in range(0, len(polygon), _EDGES):  # some edges at once, which bounds the memory
        (x1, y1), (x2, y2) = (each[first : first + _EDGES].T[:, :, None] for each in (polygon, ends))
        rise = np.where(y1 == y2, 1.0, y2 - y1)  # a level edge is crossed by no level line
        crossed = ((y1 > y) != (y2 > y)) & (x < x1 + (y - y1) / rise * (x2 - x1))
        inside ^= np.logical_xor.reduce(crossed, axis=0)
    return inside


def cover(polygon: Floats, spacing: float) -> Floats:
    """Return points on a polygon's outline and inside of it, in rows `spacing` metres apart.

    With two thirds of a costmap's resolution no cell whose centre is under the footprint is missed.

    Args:
        polygon: Corners in metres, of shape (corners, 2).
        spacing: Greatest distance between neighbours in metres.

    Returns:
        Array of shape (points, 2).
    """
    low, high = polygon.min(axis=0), polygon.max(axis=0)
    spacing = max(spacing, float((high - low).max()) / MOST_ROWS)
    edges = []
    for start, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        steps = max(1, math.ceil(math.dist(start, end) / spacing))
        edges.append(start + (end - start) * (np.arange(steps) / steps)[:, None])
    xs, ys = (np.arange(low[axis], high[axis] + spacing, spacing) for axis in (0, 1))
    inner = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    return np.concatenate([*edges, inner[contains(polygon, inner)]])


def highest_costs(costs: Grid, points: Floats, poses: Floats, outside: int = LETHAL) -> npt.NDArray[np.uint8]:
    """Return the highest cost under a footprint at each of some poses. Unknown cells count as `LETHAL`.

    Args:
        costs: Costmap, with cells from 0 to 255.
        points: Points of the footprint from `cover`, in metres in the robot's frame.
        poses: Poses of the robot in the frame of the costmap, of shape (poses, 3): x and y in metres, theta in radians.
        outside: Cost of what is off the costmap.
    """
    cos, sin = np.cos(poses[:, 2])[:, None], np.sin(poses[:, 2])[:, None]
    x = poses[:, 0, None] + cos * points[:, 0] - sin * points[:, 1]
    y = poses[:, 1, None] + sin * points[:, 0] + cos * points[:, 1]
    row, column = costs.world_to_cell(x, y)
    there = costs.contains(row, column)
    height, width = costs.cells.shape
    found = costs.cells[row.clip(0, height - 1), column.clip(0, width - 1)]
    found = np.where(there, np.where(found == UNKNOWN, LETHAL, found), outside)
    highest: npt.NDArray[np.uint8] = found.max(axis=1).astype(np.uint8)
    return highest
