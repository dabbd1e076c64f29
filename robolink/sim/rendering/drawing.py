"""Drawing of plain patches on a canvas: large ones one by one, small ones all at once."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from robolink.sim.rendering.arrays import Array, Columns, Flags, Floats, Indices, Packed
from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.hidden import Blocks
from robolink.sim.rendering.patches import ELLIPSE, Patches
from robolink.sim.rendering.pinhole import Pinhole
from robolink.sim.rendering.projection import Seen, Spans, spans

_LARGE = 400
"""Number of pixels from which on a patch is drawn by itself: its calls cost as much as so many single pixels."""

_TURN = 32
"""Number of large patches that are drawn before hidden ones are looked for again."""

_ROWS = 100_000
"""Number of rows of patches whose spans are computed together, so that memory has a bound."""

_FEW = 12
"""Number of patches below which it does not pay to look for hidden ones."""


class _Boxes(NamedTuple):
    """Bounding boxes of patches: columns from `left` up to `right`, and if every row reaches from end to end."""

    left: Indices
    right: Indices
    top: Indices
    bottom: Indices
    pixels: Indices
    whole: Flags


def draw_patches(canvas: Canvas, patches: Patches, seen: Seen, pinhole: Pinhole) -> None:
    """Draw patches without textures; `seen` are they, near ones first."""
    seen = seen.taken(np.flatnonzero(seen.rows))
    ends, first = np.cumsum(seen.rows), 0
    while first < len(seen.which):
        limit = ends[first] - seen.rows[first] + _ROWS
        last = max(first + 1, int(np.searchsorted(ends, limit, side="right")))
        _draw_at_once(canvas, patches, seen.taken(np.arange(first, last)), pinhole)
        first = last


def _draw_at_once(canvas: Canvas, patches: Patches, seen: Seen, pinhole: Pinhole) -> None:
    found = spans(seen, patches, pinhole)
    boxes = _boxes(seen, found)
    alone = (boxes.pixels >= _LARGE) | ((patches.outline.take(seen.which) == ELLIPSE) & (boxes.pixels > 0))
    drawer = _Drawer(canvas, patches, seen, found, boxes, pinhole)
    large = np.flatnonzero(alone)
    while len(large):
        for patch in large[:_TURN].tolist():
            drawer.draw(patch)
        large = _visible(canvas, seen, boxes, large[_TURN:])
    small = _visible(canvas, seen, boxes, np.flatnonzero(~alone & (boxes.pixels > 0)))
    if len(small):
        drawer.draw_small(small)


def _visible(canvas: Canvas, seen: Seen, boxes: _Boxes, which: Indices) -> Indices:
    """Leave out patches that lie behind all that is drawn in their boxes."""
    if len(which) < _FEW:
        return which
    farthest = Blocks(canvas.inverse).farthest(*(each.take(which) for each in boxes[:4]))
    return which[seen.nearest.take(which) > farthest]


def _boxes(seen: Seen, found: Spans) -> _Boxes:
    begin, low, high = found.starts[:-1], found.low, found.high
    pixels = np.add.reduceat(high.astype(np.intp) - low + 1, begin)
    left, right = np.minimum.reduceat(low, begin), np.maximum.reduceat(high, begin)
    whole = (np.maximum.reduceat(low, begin) == left) & (np.minimum.reduceat(high, begin) == right)
    return _Boxes(left.astype(np.intp), right.astype(np.intp) + 1, seen.first, seen.first + seen.rows, pixels, whole)


class _Drawer:
    def __init__(
        self, canvas: Canvas, patches: Patches, seen: Seen, found: Spans, boxes: _Boxes, pinhole: Pinhole
    ) -> None:
        self._canvas, self._seen, self._spans, self._pinhole = canvas, seen, found, pinhole
        self._shades: Packed = patches.shades.take(seen.which)
        self._round: list[bool] = (patches.outline.take(seen.which) == ELLIPSE).tolist()
        self._lists = [each.tolist() for each in (*boxes, found.starts, seen.nearest)]
        self._columns: Columns = np.arange(pinhole.width, dtype=np.int16)

    def draw(self, patch: int) -> None:
        """Draw one patch by its bounding box."""
        left, right, top, bottom, _, whole, start, nearest = (each[patch] for each in self._lists)
        inverse = self._canvas.inverse[top:bottom, left:right]
        if inverse.min() >= nearest:
            return
        depth, of_s, of_t = self._seen.gradients[:, :, patch]
        own = self._affine(depth, left, right, top, bottom)
        mask = own > inverse
        if not whole:
            columns, here = self._columns[left:right], slice(start, start + bottom - top)
            mask &= columns >= self._spans.low[here, None]
            mask &= columns <= self._spans.high[here, None]
        if self._round[patch]:
            s, t = (self._affine(each - depth / 2, left, right, top, bottom) for each in (of_s, of_t))
            mask &= s * s + t * t <= own * own * np.float32(0.25)
        np.copyto(inverse, own, where=mask)
        np.copyto(self._canvas.colours[top:bottom, left:right], self._shades[patch], where=mask)

    def _affine(self, gradient: Array, left: int, right: int, top: int, bottom: int) -> Floats:
        """Return an affine image over a box of pixels."""
        along, down, at = gradient.tolist()
        of_columns = (self._pinhole.columns[left:right] * along).astype(np.float32)
        of_rows = (self._pinhole.rows[top:bottom] * down + at).astype(np.float32)
        image: Floats = of_columns + of_rows[:, None]
        return image

    def draw_small(self, which: Indices) -> None:
        """Draw patches at once, pixel by pixel: the nearest of each pixel is found as a maximum."""
        inverse, colours = self._canvas.inverse.reshape(-1), self._canvas.colours.reshape(-1)
        along, down, at = self._seen.gradients[0]
        for chosen in self._chosen(which):
            patch, row = self._spans.patch.take(chosen), self._spans.row.take(chosen)
            low = self._spans.low.take(chosen).astype(np.intp)
            counts = self._spans.high.take(chosen) - low + 1
            of_rows = (self._pinhole.rows.take(row) * down.take(patch) + at.take(patch)).astype(np.float32)
            shift = low - (np.cumsum(counts) - counts)
            column = np.arange(int(counts.sum())) + np.repeat(shift, counts)
            pixel = column + np.repeat(row * self._pinhole.width, counts)
            of_columns = self._pinhole.columns.take(column) * np.repeat(along.take(patch), counts)
            own = of_columns.astype(np.float32) + np.repeat(of_rows, counts)
            np.maximum.at(inverse, pixel, own)
            nearest = np.flatnonzero(own == inverse.take(pixel))
            colours[pixel.take(nearest)] = np.repeat(self._shades.take(patch), counts).take(nearest)

    def _chosen(self, which: Indices) -> Iterator[Indices]:
        """Yield the spans of patches that are not empty."""
        chosen = np.zeros(len(self._seen.which), dtype=np.bool_)
        chosen[which] = True
        yield np.flatnonzero(chosen.take(self._spans.patch) & (self._spans.high >= self._spans.low))
