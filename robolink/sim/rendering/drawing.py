"""Drawing of solids, round columns, the ground and signs onto a canvas."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.patches import ELLIPSE, TRIANGLE, Cylinders, Level, Patches, mipmaps
from robolink.sim.rendering.pinhole import Array, Columns, Flags, Floats, Indices, Packed, Pinhole, Places, View, packed
from robolink.sim.rendering.projection import Blocks, Seen, Spans, spans
from robolink.sim.scene.solids import Floor

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


# Drawing of upright cylinders, with exact silhouettes.
#
# With the axis at (dx, dy) from the camera, r its radius and D its distance, a ray of depth 1 goes (ex, ey) over
# the floor. Let e = dx ex + dy ey and c = dx ey - dy ex, both affine in the pixel. The ray enters the cylinder at
# the inverse depth p + sqrt((p r / D)² - c² / (D² - r²) / D²), with p = e / (D² - r²). The difference of squares is
# a product, which does not lose digits at the silhouette.


_TONES = 16
_DARKEST, _BRIGHTEST = 0.65, 0.95
"""Brightness of a cylinder at its silhouette and in its middle."""

_IN_FRONT = 1e-6
_LEAST_OF_COLUMN = np.float32(1e-12)


def draw_cylinders(canvas: Canvas, cylinders: Cylinders, view: View, pinhole: Pinhole) -> None:
    """Draw the sides of cylinders, near ones first; one that the camera is in is not seen."""
    x, y = cylinders.x - view.position[0], cylinders.y - view.position[1]
    square, radius = x * x + y * y, cylinders.radius
    boxes, nearest = _column_boxes(cylinders, view, pinhole)
    left, right, top, bottom = boxes
    drawn = np.flatnonzero(
        (square > radius * radius * (1.0 + 1e-9)) & (left < right) & (top < bottom) & (nearest > 0.0)
    )
    for each in drawn[np.argsort(-nearest.take(drawn), kind="stable")].tolist():
        box = tuple(int(side[each]) for side in boxes)
        if canvas.inverse[box[2] : box[3], box[0] : box[1]].min() < nearest[each]:
            _draw(canvas, cylinders, each, (float(x[each]), float(y[each])), box, view, pinhole)


def _column_boxes(cylinders: Cylinders, view: View, pinhole: Pinhole) -> tuple[tuple[Indices, ...], Array]:
    """Return boxes of pixels that cylinders may cover: left, right, top, bottom; and their largest inverse depths."""
    x, y, r = cylinders.x, cylinders.y, cylinders.radius
    x, y = np.concatenate((x - r, x - r, x + r, x + r)), np.concatenate((y - r, y + r, y - r, y + r))
    low, high = np.tile(cylinders.low, 4), np.tile(cylinders.high, 4)
    corners = np.stack((np.concatenate((x, x)), np.concatenate((y, y)), np.concatenate((low, high))))
    seen = view.seen_points(corners).reshape(3, 8, -1)
    depth = seen[2]
    behind, unseen = depth.min(axis=0) <= _IN_FRONT, depth.max(axis=0) <= _IN_FRONT
    scale = pinhole.focal / np.maximum(depth, _IN_FRONT)
    sides: list[Indices] = []
    for axis, size in ((0, pinhole.width), (1, pinhole.height)):
        place = seen[axis] * scale + pinhole.centre[axis]
        first = np.where(behind, 0.0, np.clip(np.floor(place.min(axis=0)), 0, size)).astype(np.intp)
        last = np.where(behind, size, np.clip(np.ceil(place.max(axis=0)) + 1.0, 0, size)).astype(np.intp)
        sides += [first, last]
    nearest = np.where(behind, np.inf, 1.0 / np.maximum(depth.min(axis=0), _IN_FRONT))
    return tuple(sides), np.where(unseen, 0.0, nearest)


def _draw(
    canvas: Canvas,
    cylinders: Cylinders,
    which: int,
    centre: tuple[float, float],
    box: tuple[int, ...],
    view: View,
    pinhole: Pinhole,
) -> None:
    rays, (dx, dy), radius = view.axes.T.tolist(), centre, float(cylinders.radius[which])
    distance = float(np.sqrt(dx * dx + dy * dy))
    power = (distance - radius) * (distance + radius)
    ahead = [(dx * a + dy * b) / power for a, b in zip(rays[0], rays[1], strict=True)]
    aside = [(dx * b - dy * a) / distance / power**0.5 for a, b in zip(rays[0], rays[1], strict=True)]
    p, c, rise = (_affine(each, box, pinhole) for each in (ahead, aside, rays[2]))
    half = p * np.float32(radius / distance)
    product = (half - c) * (half + c)
    root = np.sqrt(np.maximum(product, np.float32(0.0)))
    own = p + root
    inverse = canvas.inverse[box[2] : box[3], box[0] : box[1]]
    mask = (product >= 0) & (own > inverse)
    height = view.position[2]
    mask &= rise >= own * np.float32(float(cylinders.low[which]) - height)
    mask &= rise <= own * np.float32(float(cylinders.high[which]) - height)
    share = root / np.maximum(half, _LEAST_OF_COLUMN)
    tone = np.minimum(share * np.float32(_TONES), np.float32(_TONES - 1)).astype(np.int16)
    np.copyto(inverse, own, where=mask)
    tones = _tones(cylinders.colours[which].tolist())
    np.copyto(canvas.colours[box[2] : box[3], box[0] : box[1]], tones.take(tone), where=mask)


def _affine(along: list[float], box: tuple[int, ...], pinhole: Pinhole) -> Floats:
    """Return over a box of pixels how far rays of depth 1 go in a direction, given along the camera's axes."""
    right, down, ahead = along
    columns = (pinhole.columns[box[0] : box[1]] * (right / pinhole.focal)).astype(np.float32)
    rows = (pinhole.rows[box[2] : box[3]] * (down / pinhole.focal) + ahead).astype(np.float32)
    return columns + rows[:, None]


def _tones(colour: list[int]) -> Packed:
    """Return the packed colours of a cylinder from its silhouette to its middle."""
    share = _DARKEST + (_BRIGHTEST - _DARKEST) * np.arange(_TONES)[:, None] / (_TONES - 1)
    return packed((share * np.array(colour) + 0.5).astype(np.uint8))


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


_SAMPLES = ((4_000, 16), (40_000, 8), (100_000, 4))
"""Number of samples of each pixel of a patch of at most so many pixels; larger ones have one."""

_SAMPLES_AT_ONCE = 1 << 16
"""Number of samples that are computed together, so that arrays stay in the processor's cache."""

_IN_PLANE = np.float32(1.0002)
"""Factor by which a sign may seem to be behind the wall that it lies in."""

_EVEN, _BYTE = np.uint32(0x00FF00FF), np.uint32(8)
_LEAST_OF_SIGN = np.float32(1e-12)


class Box:
    """Box of pixels, columns `left` up to `right`, rows `top` up to `bottom`."""

    def __init__(self, left: int, right: int, top: int, bottom: int) -> None:
        self.left, self.right, self.top, self.bottom = left, right, top, bottom
        self.pixels = (right - left) * (bottom - top)


def draw_sign(
    canvas: Canvas, gradient: Array, levels: list[Level], box: Box, pinhole: Pinhole, *, outline: int
) -> None:
    """Draw a patch with a texture.

    Args:
        canvas: The canvas, on which all that lies behind is drawn already.
        gradient: Array (3, 3): of 1/depth, s/depth and t/depth along columns, rows and at the principal point.
        levels: The texture.
        box: Pixels that it may cover.
        pinhole: The camera.
        outline: Kind of outline, of `patches`.
    """
    samples = next((count for most, count in _SAMPLES if box.pixels <= most), 1)
    level = _level(levels, box.pixels * samples)
    rows = max(1, _SAMPLES_AT_ONCE // max(1, samples * (box.right - box.left)))
    for top in range(box.top, box.bottom, rows):
        part = Box(box.left, box.right, top, min(top + rows, box.bottom))
        _draw_part(canvas, gradient, level, part, pinhole, _pattern(samples), outline)


def _level(levels: list[Level], samples: int) -> Level:
    """Return the finest level with no more pixels than there are samples, or the coarsest."""
    return next((each for each in levels if each.rows * each.columns <= samples), levels[-1])


def _pattern(samples: int) -> Array:
    """Return places of samples in a pixel, from its centre, as an array (2, samples): no row or column has two.

    Along one side they are equally spaced, and along the other they follow the reversed bits of their numbers
    (Hammersley's points).
    """
    bits = samples.bit_length() - 1
    number = np.arange(samples)
    reverse = sum(((number >> bit) & 1) << (bits - 1 - bit) for bit in range(bits)) + 0 * number
    return (np.stack((number, reverse)) + 0.5) / samples - 0.5


def _draw_part(
    canvas: Canvas, gradient: Array, level: Level, box: Box, pinhole: Pinhole, pattern: Array, outline: int
) -> None:
    rows, columns = slice(box.top, box.bottom), slice(box.left, box.right)
    inverse, colours = canvas.inverse[rows, columns], canvas.colours[rows, columns]
    fields = _fields(gradient, pinhole.columns[columns], pinhole.rows[rows])
    shift = (gradient[:, :1] * pattern[0] + gradient[:, 1:2] * pattern[1]).astype(np.float32)
    of_depth, of_s, of_t = (field + offset[:, None, None] for field, offset in zip(fields, shift, strict=True))
    inside = _inside(of_depth, of_s, of_t, outline)
    number = len(pattern[0])
    cover = inside.sum(axis=0, dtype=np.uint32)
    seen = (fields[0] * _IN_PLANE > inverse) & (cover > 0)
    if not seen.any():
        return
    texels = _texels(level, of_depth, of_s, of_t)
    texels[~inside] = 0
    mixed = _mean(texels, colours, cover, number)
    np.copyto(colours, mixed, where=seen)
    np.copyto(inverse, fields[0], where=seen & (cover * 2 >= number) & (fields[0] > inverse))


def _fields(gradient: Array, columns: Array, rows: Array) -> list[Floats]:
    """Return the affine images of 1/depth, s/depth and t/depth at pixel centres."""
    return [
        (columns * along).astype(np.float32) + (rows * down + at).astype(np.float32)[:, None]
        for along, down, at in gradient.tolist()
    ]


def _inside(of_depth: Floats, of_s: Floats, of_t: Floats, outline: int) -> Flags:
    if outline == ELLIPSE:
        half = of_depth * np.float32(0.5)
        s, t = of_s - half, of_t - half
        inside: Flags = (s * s + t * t <= half * half) & (of_depth > 0)
        return inside
    inside = (of_s >= 0) & (of_t >= 0)
    if outline == TRIANGLE:
        inside &= of_s + of_t <= of_depth
    else:
        inside &= (of_s <= of_depth) & (of_t <= of_depth)
    return inside


def _texels(level: Level, of_depth: Floats, of_s: Floats, of_t: Floats) -> Packed:
    """Return the texture's colour at each sample; beyond its edges it is the nearest one."""
    depth = np.float32(1.0) / np.maximum(of_depth, _LEAST_OF_SIGN)
    row, column = _sign_places(of_t * depth, level.rows), _sign_places(of_s * depth, level.columns)
    row *= level.stride
    row += column
    found: Packed = level.flat.take(row + (level.stride + 1))
    return found


def _sign_places(share: Floats, count: int) -> Places:
    share *= np.float32(count)
    found: Places = np.minimum(np.maximum(share, np.float32(0.0)), np.float32(count - 1)).astype(np.int32)
    return found


def _mean(texels: Packed, behind: Packed, cover: Packed, number: int) -> Packed:
    """Return the means of samples, along the first axis; those that miss the patch show what is behind.

    Two bytes of a pixel are added at once, with eight bits of room for each.
    """
    shift, half = np.uint32(number.bit_length() - 1), np.uint32(number // 2 * 0x00010001)
    missed = np.uint32(number) - cover
    parts = []
    for part, back in ((texels & _EVEN, behind & _EVEN), ((texels >> _BYTE) & _EVEN, (behind >> _BYTE) & _EVEN)):
        total = part.sum(axis=0, dtype=np.uint32) + back * missed + half
        parts.append((total >> shift) & _EVEN)
    mixed: Packed = parts[0] | (parts[1] << _BYTE)
    return mixed
