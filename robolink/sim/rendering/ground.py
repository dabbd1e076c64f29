"""Drawing of the floor: its depth is that of its row, and its picture is looked up at a fitting resolution."""

from __future__ import annotations

import itertools
import math

import numpy as np

from robolink.sim.rendering.arrays import Array, Floats, Indices, Packed, Places, packed
from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.mipmaps import Level, mipmaps
from robolink.sim.rendering.pinhole import Pinhole, View
from robolink.sim.scene.surfaces import Floor

_FARTHEST = 10_000.0
"""Depth in metres from which on the floor is sky."""

_AT_ONCE = 1 << 14
"""Number of pixels that are computed together, so that arrays stay in the processor's cache."""


class Ground:
    """A floor that is ready to be drawn."""

    def __init__(self, floor: Floor) -> None:
        self._colour = int(packed(np.array(floor.colour, dtype=np.uint8)))
        self._levels = [] if floor.image is None else mipmaps(floor.image, self._colour)
        self._resolution, self._origin = floor.resolution, floor.origin

    def draw(self, canvas: Canvas, view: View, pinhole: Pinhole) -> None:
        """Draw the floor, first of all; the camera is above it and does not roll."""
        height = view.position[2]
        _, down, ahead = view.axes[:, 2].tolist()
        inverse = (pinhole.rows * (down / pinhole.focal) + ahead) / -height
        rows = np.flatnonzero(inverse > 1.0 / _FARTHEST)
        if not len(rows):
            return
        first, last = int(rows[0]), int(rows[-1]) + 1  # one run: it is affine in the row
        inverse = inverse[first:last]
        canvas.inverse[first:last] = inverse.astype(np.float32)[:, None]
        if not self._levels:
            canvas.colours[first:last] = self._colour
            return
        self._paint(canvas, view, pinhole, first, 1.0 / inverse)

    def _paint(self, canvas: Canvas, view: View, pinhole: Pinhole, first: int, depth: Array) -> None:
        """Look up the colours of rows from the `first` one on, of these depths."""
        rows, position = pinhole.rows[first : first + len(depth)], view.position
        right, down, ahead = view.axes.tolist()
        starts, slopes = [], []
        for axis in (0, 1):  # of x and y: at the principal column, and from column to column, in pixels of the picture
            at = position[axis] + depth * (rows * (down[axis] / pinhole.focal) + ahead[axis])
            starts.append((at - self._origin[axis]) / self._resolution)
            slopes.append(depth * (right[axis] / pinhole.focal / self._resolution))
        across = depth / pinhole.focal / self._resolution
        level = self._fitting(across * np.sqrt(depth / position[2]))
        cuts = (np.flatnonzero(level[1:] != level[:-1]) + 1).tolist()
        turn = max(1, _AT_ONCE // pinhole.width)
        for begin, end in itertools.pairwise((0, *cuts, len(depth))):
            found = self._levels[int(level[begin])]
            for top in range(begin, end, turn):
                part = slice(top, min(top + turn, end))
                _look_up(
                    found,
                    [each[part] for each in starts],
                    [each[part] for each in slopes],
                    pinhole.columns,
                    canvas.colours[first + top : first + part.stop],
                )

    def _fitting(self, footprint: Array) -> Indices:
        """Return for each row the level whose pixels are about as large as the row's, given in those of the finest."""
        limits = [math.sqrt(2.0) * 2**level for level in range(len(self._levels) - 1)]
        return np.searchsorted(np.array(limits), footprint)


def _look_up(level: Level, starts: list[Array], slopes: list[Array], columns: Array, colours: Packed) -> None:
    """Write the colours of some rows: x and y of the picture are affine in the column."""
    x, y = (
        _places((slope * level.scale), (start * level.scale), columns, count)
        for slope, start, count in zip(slopes, starts, (level.columns, level.rows), strict=True)
    )
    y *= level.stride
    y += x
    level.flat.take(y, out=colours, mode="clip")  # another mode would need a copy


def _places(slope: Array, start: Array, columns: Array, count: int) -> Places:
    """Return which pixels of a picture's row or column are met, counted with its border of one."""
    place: Floats = slope.astype(np.float32)[:, None] * columns.astype(np.float32)
    place += (start + 1.0).astype(np.float32)[:, None]
    np.maximum(place, np.float32(0.0), out=place)
    np.minimum(place, np.float32(count + 1), out=place)
    return place.astype(np.int32)
