"""Drawing of patches with textures: several samples of each pixel, whose mean is its colour, also at the edges."""

from __future__ import annotations

import numpy as np

from robolink.sim.rendering.arrays import Array, Flags, Floats, Packed, Places
from robolink.sim.rendering.canvas import Canvas
from robolink.sim.rendering.mipmaps import Level
from robolink.sim.rendering.patches import ELLIPSE, TRIANGLE
from robolink.sim.rendering.pinhole import Pinhole

_SAMPLES = ((4_000, 16), (40_000, 8), (100_000, 4))
"""Number of samples of each pixel of a patch of at most so many pixels; larger ones have one."""

_AT_ONCE = 1 << 16
"""Number of samples that are computed together, so that arrays stay in the processor's cache."""

_IN_PLANE = np.float32(1.0002)
"""Factor by which a sign may seem to be behind the wall that it lies in."""

_EVEN, _BYTE = np.uint32(0x00FF00FF), np.uint32(8)
_LEAST = np.float32(1e-12)


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
    rows = max(1, _AT_ONCE // max(1, samples * (box.right - box.left)))
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
    depth = np.float32(1.0) / np.maximum(of_depth, _LEAST)
    row, column = _places(of_t * depth, level.rows), _places(of_s * depth, level.columns)
    row *= level.stride
    row += column
    found: Packed = level.flat.take(row + (level.stride + 1))
    return found


def _places(share: Floats, count: int) -> Places:
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
