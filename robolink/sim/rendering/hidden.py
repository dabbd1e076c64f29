"""Search for what is hidden: the farthest thing drawn in a box of pixels, at once for many boxes."""

from __future__ import annotations

import numpy as np

from robolink.sim.rendering.arrays import Array, Floats, Indices

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
