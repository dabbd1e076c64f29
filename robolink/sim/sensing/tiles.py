"""Spatial index of fixed segments, a cache by tiles: a sensor checks only those within its reach."""

from __future__ import annotations

import math

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.sensing.fixed import segment_distances

X, Y, NORMAL, REFLECTANCE = slice(0, 2), slice(2, 4), slice(4, 7), 7
"""Rows of `columns`: x of both ends, y of both ends, the unit normal (x, y, and -x to turn it by), the reflectance."""

_FEW = 64
"""Number of segments up to which checking all is faster than choosing."""

_TILES_ACROSS = 6
"""Number of tiles in the length of the reach: more of them fit closer and are left sooner."""

_KEPT = 1_000_000
"""Most columns that are kept in all tiles together: 64 MB."""


def columns(segments: Array, reflectances: Array) -> Array:
    """Return segments (rows x1, y1, x2, y2) as columns with all that a scanner needs of each."""
    x1, y1, x2, y2 = segments.T
    dx, dy = x2 - x1, y2 - y1
    length = np.sqrt(dx * dx + dy * dy)
    point = length == 0.0  # as good as a short piece of a line that goes up
    length[point], dy = 1.0, np.where(point, 1.0, dy)
    return np.stack((x1, x2, y1, y2, dy / length, -dx / length, -dy / length, reflectances))


class Tiles:
    """Fixed segments with `reflectances`; those near a tile of the plane are searched once."""

    def __init__(self, segments: Array, reflectances: Array) -> None:
        self._segments, self._columns = segments, columns(segments, reflectances)
        x1, y1, x2, y2 = segments.T
        self._middle_x, self._middle_y = (x1 + x2) / 2, (y1 + y2) / 2
        self._half = np.sqrt((x2 - x1) ** 2 + (y2 - y1) ** 2) / 2
        self._near: dict[tuple[int, int, float], Array] = {}
        self._count = 0

    def near(self, x: float, y: float, reach: float) -> Array:
        """Return the columns of all segments within `reach` metres of a place, in order, and some farther ones."""
        if len(self._half) <= _FEW:
            return self._columns
        side = reach / _TILES_ACROSS
        tile = (math.floor(x / side), math.floor(y / side), reach)
        found = self._near.get(tile)
        return self._remember(tile, side) if found is None else found

    def _remember(self, tile: tuple[int, int, float], side: float) -> Array:
        column, row, reach = tile
        found = self._within((column + 0.5) * side, (row + 0.5) * side, reach + 0.75 * side)  # 0.71: to its corners
        while self._near and self._count + found.shape[1] > _KEPT:
            self._count -= self._near.pop(next(iter(self._near))).shape[1]
        self._count += found.shape[1]
        self._near[tile] = found
        return found

    def _within(self, x: float, y: float, reach: float) -> Array:
        dx, dy, farthest = self._middle_x - x, self._middle_y - y, self._half + reach
        perhaps = np.flatnonzero(dx * dx + dy * dy <= farthest * farthest)
        which = perhaps[segment_distances(self._segments[perhaps], x, y) <= reach]
        found: Array = self._columns.take(which, axis=1)
        return found
