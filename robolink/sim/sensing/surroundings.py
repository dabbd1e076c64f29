"""What sensors see at one moment: fixed segments and circles, and those of what moves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from robolink.sim.arrays import Array, Indices, Place
from robolink.sim.sensing.tiles import Tiles

FIXED = -1
"""The owner of what never moves; what moves is numbered from 0."""

NOBODY = -2
"""What a sensor is mounted on that sees everything."""


class Circles(NamedTuple):
    """Circles, as an array for each of their facts."""

    x: Array
    y: Array
    radius: Array
    reflectance: Array
    owner: Indices

    def taken(self, which: Indices) -> Circles:
        """Give some of them."""
        x, y, radius, reflectance = (each.take(which) for each in self[:4])
        return Circles(x, y, radius, reflectance, self.owner.take(which))


class Edges(NamedTuple):
    """Segments that move, as `tiles.columns`, and the circle about the whole shape that each belongs to."""

    columns: Array
    x: Array
    y: Array
    radius: Array
    owner: Indices


class Surroundings(NamedTuple):
    """All that can be seen. A sensor doesn't see the shape that it is mounted on, which is told by its number."""

    walls: Tiles
    circles: Circles
    edges: Edges | None = None

    def segments_near(self, x: float, y: float, reach: float, own: int) -> Array:
        """Give the columns of the segments that a sensor at a place may see."""
        walls = self.walls.near(x, y, reach)
        if self.edges is None:
            return walls
        dx, dy, farthest = self.edges.x - x, self.edges.y - y, self.edges.radius + reach
        seen = (dx * dx + dy * dy <= farthest * farthest) & (self.edges.owner != own)
        return np.concatenate((walls, self.edges.columns.compress(seen, axis=1)), axis=1)

    def has_circles_but(self, own: Sequence[int]) -> bool:
        """Say whether there is any circle but the only sensor's own."""
        owner = self.circles.owner
        return len(owner) > 1 or (len(owner) == 1 and (len(own) > 1 or own[0] != owner[0]))

    def circles_near(self, places: Sequence[Place], reach: float, own: Sequence[int]) -> tuple[Indices, Indices]:
        """Give all pairs (sensor, circle) of which the one may see the other; `own` is for each sensor."""
        column = np.array(places)[:, :2, None]
        dx, dy = self.circles.x - column[:, 0], self.circles.y - column[:, 1]
        farthest = self.circles.radius + reach
        others = self.circles.owner != np.array(own)[:, None]
        sensors, circles = np.nonzero((dx * dx + dy * dy <= farthest * farthest) & others)
        return sensors, circles


def circles_of(circles: Array, reflectance: Array, owner: Indices) -> Circles:
    """Give circles (rows x, y, radius) as an array for each of their facts."""
    x, y, radius = np.ascontiguousarray(circles.T)
    return Circles(x, y, radius, reflectance, owner)


def standing(segments: Array, circles: Array) -> Surroundings:
    """Give surroundings in which nothing moves: rows x1, y1, x2, y2, and rows x, y, radius."""
    everything = circles_of(circles, np.ones(len(circles)), np.full(len(circles), FIXED, dtype=np.intp))
    return Surroundings(Tiles(segments, np.ones(len(segments))), everything)
