"""Surroundings of sensors at one moment: fixed segments and circles, and those that move."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from robolink.sim.arrays import Array, Indices, Place
from robolink.sim.sensing.tiles import Tiles

FIXED = -1
"""Owner number of fixed shapes; moving ones are numbered from 0."""

NOBODY = -2
"""Owner number of a sensor that is mounted on nothing and sees everything."""


class Circles(NamedTuple):
    """Circles as arrays, one for each of their properties."""

    x: Array
    y: Array
    radius: Array
    reflectance: Array
    owner: Indices

    def taken(self, which: Indices) -> Circles:
        """Return some of them."""
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
    """All that can be seen. A sensor does not see the shape that it is mounted on, which it names by its number."""

    walls: Tiles
    circles: Circles
    edges: Edges | None = None

    def segments_near(self, x: float, y: float, reach: float, own: int) -> Array:
        """Return the columns of the segments that a sensor at a place may see."""
        walls = self.walls.near(x, y, reach)
        if self.edges is None:
            return walls
        dx, dy, farthest = self.edges.x - x, self.edges.y - y, self.edges.radius + reach
        seen = (dx * dx + dy * dy <= farthest * farthest) & (self.edges.owner != own)
        return np.concatenate((walls, self.edges.columns.compress(seen, axis=1)), axis=1)

    def has_circles_but(self, own: Sequence[int]) -> bool:
        """True if there is any circle besides the only sensor's own."""
        owner = self.circles.owner
        return len(owner) > 1 or (len(owner) == 1 and (len(own) > 1 or own[0] != owner[0]))

    def circles_near(self, places: Sequence[Place], reach: float, own: Sequence[int]) -> tuple[Indices, Indices]:
        """Return all pairs (sensor, circle) of which the one may see the other; `own` is for each sensor."""
        x, y = np.array(places)[:, :2].T
        farthest = self.circles.radius + reach
        near = np.flatnonzero(
            (self.circles.x >= x.min() - farthest)
            & (self.circles.x <= x.max() + farthest)
            & (self.circles.y >= y.min() - farthest)
            & (self.circles.y <= y.max() + farthest)
        )
        dx, dy = self.circles.x.take(near) - x[:, None], self.circles.y.take(near) - y[:, None]
        farthest = farthest.take(near)
        others = self.circles.owner.take(near) != np.array(own)[:, None]
        sensors, found = np.nonzero((dx * dx + dy * dy <= farthest * farthest) & others)
        return sensors, near.take(found)


def circles_of(circles: Array, reflectance: Array, owner: Indices) -> Circles:
    """Return circles (rows x, y, radius) as arrays, one for each of their properties."""
    x, y, radius = np.ascontiguousarray(circles.T)
    return Circles(x, y, radius, reflectance, owner)


def standing(segments: Array, circles: Array) -> Surroundings:
    """Return surroundings in which nothing moves: rows x1, y1, x2, y2, and rows x, y, radius."""
    everything = circles_of(circles, np.ones(len(circles)), np.full(len(circles), FIXED, dtype=np.intp))
    return Surroundings(Tiles(segments, np.ones(len(segments))), everything)
