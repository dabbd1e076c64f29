"""Projection of solids onto the canvas, and the order in which they hide each other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from robolink.sim.rendering.patches import TRIANGLE, Patches
from robolink.sim.rendering.pinhole import Array, Columns, Floats, Indices, Pinhole, View, cross, dot

_EDGE_ON = 1e-9
"""Distance in metres of a camera from a patch's plane below which it sees nothing of it."""

_MARGIN = 1e-4
"""Margin of a patch beyond its edges, in pixels, so that rounding leaves no gap between neighbours."""

_IN_FRONT = 1e-6
"""Depth in metres from which on a corner has a place in the image."""

_BEYOND = 1e9
"""A column beyond any image."""


class Seen(NamedTuple):
    """Patches that may be in the image, in an order.

    Args:
        which: Number of each patch.
        gradients: Array (3, 3, n): of 1/depth, s/depth and t/depth along columns and rows, and at the principal point.
        nearest: Largest 1/depth of each; infinite for one that reaches behind the camera.
        first: First row of each.
        rows: Number of rows of each.
    """

    which: Indices
    gradients: Array
    nearest: Array
    first: Indices
    rows: Indices

    def taken(self, order: Indices) -> Seen:
        """Return some of them."""
        return Seen(
            self.which.take(order),
            self.gradients.take(order, axis=2),
            self.nearest.take(order),
            self.first.take(order),
            self.rows.take(order),
        )


def seen_patches(patches: Patches, view: View, pinhole: Pinhole) -> Seen:
    """Return the patches that may be in the image, those with the nearest corners first."""
    sides = view.seen(np.concatenate((patches.a, patches.b), axis=1))
    corner, a, b = view.seen_points(patches.corner), *np.split(sides, 2, axis=1)
    normal = cross(a, b)
    distance = dot(corner, normal)
    length = np.sqrt(dot(normal, normal))
    x, y, z = (_corners(corner[axis], a[axis], b[axis]) for axis in range(3))
    aside, above = (size / 2 / pinhole.focal for size in (pinhole.width, pinhole.height))
    towards = np.where(patches.textured >= 0, distance, np.abs(distance))  # a textured one has a back, which is unseen
    outside = np.all(z <= 0.0, axis=0) | (towards <= _EDGE_ON * length)
    for side, reach in ((x, aside), (y, above)):
        outside |= np.all(side > reach * z, axis=0) | np.all(side < -reach * z, axis=0)
    which = np.flatnonzero(~outside)
    y, z = y.take(which, axis=1), z.take(which, axis=1)
    corner, a, b, normal = (each.take(which, axis=1) for each in (corner, a, b, normal))
    gradients = np.stack((normal, cross(b, corner), cross(corner, a))) / distance.take(which)
    gradients[:, :2] /= pinhole.focal
    first, rows = _rows(y, z, pinhole)
    depth = z.min(axis=0)
    nearest = np.where(depth > _IN_FRONT, 1.0 / np.maximum(depth, _IN_FRONT), np.inf)
    seen = Seen(which, gradients, nearest, first, rows)
    return seen.taken(np.argsort(-nearest - 1e-3 / np.maximum(z.max(axis=0), _IN_FRONT), kind="stable"))


def _corners(corner: Array, a: Array, b: Array) -> Array:
    """Return a coordinate of the four corners, (4, n)."""
    far = corner + a
    return np.stack((corner, far, far + b, corner + b))


def _rows(y: Array, z: Array, pinhole: Pinhole) -> tuple[Indices, Indices]:
    """Return the first row of each patch, and the number of its rows: all if it reaches behind the camera."""
    middle, height = pinhole.centre[1], pinhole.height
    v = y * (pinhole.focal / np.maximum(z, _IN_FRONT)) + middle
    behind = z.min(axis=0) <= _IN_FRONT
    first = np.where(behind, 0.0, np.ceil(v.min(axis=0) - _MARGIN))
    last = np.where(behind, height - 1.0, np.floor(v.max(axis=0) + _MARGIN))
    begin = np.clip(first, 0, height).astype(np.intp)
    end = np.clip(last, -1, height - 1).astype(np.intp) + 1
    return begin, np.maximum(end - begin, 0)


class Spans(NamedTuple):
    """Spans of columns that patches cover in their rows, patch by patch.

    Args:
        patch: Place of each span's patch in `Seen`.
        row: Row of each span.
        low: First column of each.
        high: Last column of each; one less than the first where it is empty.
        starts: Where the spans of each patch begin; and the end.
    """

    patch: Indices
    row: Indices
    low: Columns
    high: Columns
    starts: Indices


def spans(seen: Seen, patches: Patches, pinhole: Pinhole) -> Spans:
    """Return which pixels patches cover: each patch is the intersection of four half planes in the image."""
    of_depth, of_s, of_t = seen.gradients
    triangle = patches.outline.take(seen.which) == TRIANGLE
    beyond = of_depth - of_s
    edges = np.stack((of_s, np.where(triangle, beyond - of_t, beyond), of_t, np.where(triangle, of_t, of_depth - of_t)))
    along, down, at = edges[:, 0], edges[:, 1], edges[:, 2]
    at = at + _MARGIN * (np.abs(along) + np.abs(down))
    along = np.where(np.abs(along) < 1e-30, 1e-30, along)
    slope, offset, rising = -down / along, -at / along, along > 0.0

    starts = np.concatenate(([0], np.cumsum(seen.rows)))
    who = np.repeat(np.arange(len(seen.rows)), seen.rows)
    row = np.arange(len(who)) - starts.take(who) + seen.first.take(who)
    crossing = slope.take(who, axis=1) * pinhole.rows.take(row) + offset.take(who, axis=1)
    rising = rising.take(who, axis=1)
    low = np.where(rising, crossing, -_BEYOND).max(axis=0) + pinhole.centre[0]
    high = np.where(rising, _BEYOND, crossing).min(axis=0) + pinhole.centre[0]
    first = np.ceil(np.clip(low, 0.0, pinhole.width)).astype(np.int16)
    last = np.floor(np.clip(high, -1.0, pinhole.width - 1.0)).astype(np.int16)
    return Spans(who, row, first, np.maximum(last, first - np.int16(1)), starts)


_SIDE = 8
"""Side of a block of pixels."""


class Blocks:
    """Least inverse depths of blocks of pixels; those of boxes are found in tables of 1, 2, 4 ... blocks.

    A box of any size is covered by four overlapping ones whose sides are powers of two.
    """

    def __init__(self, inverse: Floats) -> None:
        height, width = inverse.shape
        rows = np.minimum.reduceat(inverse, np.arange(0, height, _SIDE), axis=0)
        self._tables = {(0, 0): np.minimum.reduceat(rows, np.arange(0, width, _SIDE), axis=1)}

    def farthest(self, left: Indices, right: Indices, top: Indices, bottom: Indices) -> Array:
        """Return the least inverse depth, or one that is less, of boxes: columns up to `right`, rows to `bottom`."""
        x1, x2, y1, y2 = left // _SIDE, (right - 1) // _SIDE, top // _SIDE, (bottom - 1) // _SIDE
        wide, high = _exponents(x2 - x1 + 1), _exponents(y2 - y1 + 1)
        found = np.empty(len(left), dtype=np.float64)
        for exponents in sorted(set(zip(wide.tolist(), high.tolist(), strict=True))):
            here = np.flatnonzero((wide == exponents[0]) & (high == exponents[1]))
            table, (across, along) = self._table(*exponents), exponents
            a1, b1 = x1.take(here), y1.take(here)
            a2, b2 = x2.take(here) + 1 - (1 << across), y2.take(here) + 1 - (1 << along)
            found[here] = np.minimum(np.minimum(table[b1, a1], table[b1, a2]), np.minimum(table[b2, a1], table[b2, a2]))
        return found

    def _table(self, wide: int, high: int) -> Floats:
        """Return the table of boxes of 2**wide by 2**high blocks."""
        if (wide, high) not in self._tables:
            if wide:
                half, step = self._table(wide - 1, high), 1 << (wide - 1)
                self._tables[wide, high] = np.minimum(half[:, :-step], half[:, step:])
            else:
                half, step = self._table(wide, high - 1), 1 << (high - 1)
                self._tables[wide, high] = np.minimum(half[:-step], half[step:])
        return self._tables[wide, high]


def _exponents(sizes: Indices) -> Indices:
    """Return the largest exponents of two that do not exceed sizes."""
    return np.searchsorted(1 << np.arange(1, 32), sizes, side="right")
