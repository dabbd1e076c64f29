"""Picture of the floor: strokes of paint, drawn into a raster, and where it is in the world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil, floor, sqrt
from typing import Any

import numpy as np
import numpy.typing as npt

from robolink.sim.colours import Colour, colour_of
from robolink.sim.description import FloorSettings, Paint
from robolink.sim.looks import FLOOR
from robolink.sim.physics.convex import convex_parts
from robolink.sim.quantities import Point
from robolink.sim.scene.solids import Floor, Picture, placed_corners
from robolink.sim.scene.strokes import Extent, Stroke, extent, resolution_of, strokes

# Anti-aliased painting of lines, polygons and discs into an image, each pixel by the share of it that is covered.
#
# Coordinates are in pixels: the first pixel of the first row reaches from 0 to 1 both ways. Only + - * / and square
# roots: the same bits on every machine.


_PIECE = 100.0
"""Side of the largest box around a slanting piece of a line, in pixels: most of a larger one would be empty."""


class Layer:
    """A layer of one colour over an image: how much of each pixel is covered, 0 to 1.

    Args:
        image: The image that it will be blended into; row 0 has the lowest y.
    """

    def __init__(self, image: Picture) -> None:
        self._image = image
        self._cover: npt.NDArray[np.float32] = np.zeros(image.shape[:2], np.float32)

    def add_stroke(self, stroke: Stroke, width: float) -> None:
        """Cover a stroke that is `width` pixels wide; its corners are round."""
        last = len(stroke.points) - 2
        for index, (start, end) in enumerate(pairwise(stroke.points)):
            square = (index == 0 and not stroke.ring, index == last and not stroke.ring)
            self._add_segment(start, end, width / 2, square)

    def _add_segment(self, start: Point, end: Point, half: float, square: tuple[bool, bool]) -> None:
        dx, dy = end[0] - start[0], end[1] - start[1]
        length = sqrt(dx * dx + dy * dy)
        if length <= 0.0:
            return
        ux, uy = dx / length, dy / length
        ends = (-np.inf if square[0] else 0.0, np.inf if square[1] else length)
        for piece in _pieces(start, end, half):
            if (box := self._box(*piece)) is None:
                continue
            cover, x, y = box
            x, y = x - np.float32(start[0]), y - np.float32(start[1])
            along, across = x * np.float32(ux) + y * np.float32(uy), x * np.float32(uy) - y * np.float32(ux)
            beyond = along - np.clip(along, *map(np.float32, ends))
            share = np.minimum(_edge(half - np.sqrt(beyond * beyond + across * across)), np.float32(2 * half))
            if square[0]:
                share *= _edge(along)
            if square[1]:
                share *= _edge(length - along)
            np.maximum(cover, share, out=cover)

    def add_polygon(self, corners: Sequence[Point]) -> None:
        """Cover a convex polygon, its corners counter-clockwise; several that share edges leave no seam."""
        xs, ys = [x for x, _ in corners], [y for _, y in corners]
        if (box := self._box(min(xs), min(ys), max(xs), max(ys))) is None:
            return
        cover, x, y = box
        share: Any = np.float32(1.0)
        for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]], strict=True):
            dx, dy = x2 - x1, y2 - y1
            length = sqrt(dx * dx + dy * dy)
            if length > 0.0:
                inside = (y - np.float32(y1)) * np.float32(dx / length) - (x - np.float32(x1)) * np.float32(dy / length)
                share = np.minimum(share, _edge(inside))
        cover += share

    def add_disc(self, x: float, y: float, radius: float) -> None:
        """Cover a disc."""
        if (box := self._box(x - radius, y - radius, x + radius, y + radius)) is None:
            return
        cover, xs, ys = box
        xs, ys = xs - np.float32(x), ys - np.float32(y)
        np.maximum(cover, _edge(radius - np.sqrt(xs * xs + ys * ys)), out=cover)

    def blend(self, colour: Colour) -> None:
        """Mix a colour into the image wherever something is covered."""
        whole = self._cover >= 1.0
        partly = np.nonzero((self._cover > 0.0) & ~whole)
        share = self._cover[partly]
        for channel, value in enumerate(colour):  # one by one: numpy takes ten times as long for triples
            plane = self._image[..., channel]
            below = plane[partly].astype(np.float32)
            plane[partly] = np.rint(below + share * (np.float32(value) - below)).astype(np.uint8)
            np.copyto(plane, np.uint8(value), where=whole)

    def _box(self, x0: float, y0: float, x1: float, y1: float) -> tuple[npt.NDArray[np.float32], Any, Any] | None:
        """Return the cover within a box, one pixel wider, and the middles of its pixels: a row and a column."""
        rows, columns = self._cover.shape
        left, right = max(0, floor(x0) - 1), min(columns, ceil(x1) + 1)
        low, high = max(0, floor(y0) - 1), min(rows, ceil(y1) + 1)
        if left >= right or low >= high:
            return None
        x = np.arange(left, right, dtype=np.float32) + np.float32(0.5)
        y = np.arange(low, high, dtype=np.float32)[:, None] + np.float32(0.5)
        return self._cover[low:high, left:right], x, y


def _edge(inside: Any) -> Any:
    """Return the share of a pixel that is covered, by how far its middle lies inside of an edge."""
    return np.clip(inside + np.float32(0.5), np.float32(0.0), np.float32(1.0))


def _pieces(start: Point, end: Point, half: float) -> Iterator[tuple[float, float, float, float]]:
    """Yield boxes that together hold a segment with its width."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    count = ceil(min(abs(dx), abs(dy)) / max(_PIECE, 4 * half)) or 1
    reach = half + 1.0
    for index in range(count):
        x1, y1 = start[0] + dx * index / count, start[1] + dy * index / count
        x2, y2 = start[0] + dx * (index + 1) / count, start[1] + dy * (index + 1) / count
        yield min(x1, x2) - reach, min(y1, y2) - reach, max(x1, x2) + reach, max(y1, y2) + reach


_SMOOTH = 20.0
"""Part of a pixel that an arc may be off."""


def painted_floor(settings: FloorSettings, paint: Sequence[Paint], picture: Picture | None = None) -> Floor:
    """Return the floor with its image.

    Args:
        settings: The floor, whose colour is one.
        paint: All that is painted on it; later things lie over earlier ones.
        picture: The picture that `settings` names, its first row at the top.
    """
    colour = FLOOR if settings.colour is None else colour_of(settings.colour)
    size = (0, 0) if picture is None else (picture.shape[1], picture.shape[0])
    there = extent(settings, paint, size)
    if not there.pixels:
        return Floor(colour)
    side = resolution_of(settings)
    image = np.empty((there.rows, there.columns, 3), np.uint8)
    for channel, value in enumerate(colour):
        image[..., channel] = value
    if picture is not None:
        column, row = round((settings.origin[0] - there.x) / side), round((settings.origin[1] - there.y) / side)
        image[row : row + size[1], column : column + size[0]] = picture[::-1]
    for each in paint:
        here = extent(settings, [each])
        column, row = round((here.x - there.x) / side), round((here.y - there.y) / side)
        _paint(image[row : row + here.rows, column : column + here.columns], each, here, side)
    image.flags.writeable = False
    return Floor(colour, image, side, (there.x, there.y))


def _paint(image: Picture, paint: Paint, here: Extent, side: float) -> None:
    """Paint something into the part of the image around it."""
    layer = Layer(image)

    def pixels(points: Sequence[Point]) -> list[Point]:
        return [((x - here.x) / side, (y - here.y) / side) for x, y in points]

    if paint.line is not None:
        for stroke in strokes(paint, side / _SMOOTH):
            layer.add_stroke(stroke._replace(points=pixels(stroke.points)), paint.width / side)
    elif paint.circle is not None:
        ((x, y),) = pixels([(paint.pose.x, paint.pose.y)])
        layer.add_disc(x, y, paint.circle / side)
    else:
        for part in convex_parts(placed_corners(paint, paint.pose.place)):
            layer.add_polygon(pixels(part))
    layer.blend(colour_of(paint.colour))
