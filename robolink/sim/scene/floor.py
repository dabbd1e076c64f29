"""Painted floor of a world as an image: a picture, and over it lines and outlines, anti-aliased."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robolink.sim.colours import Colour, colour_of
from robolink.sim.description import FloorSettings, Paint
from robolink.sim.physics.convex import convex_parts
from robolink.sim.quantities import Point
from robolink.sim.scene.floor_size import Extent, extent, resolution_of
from robolink.sim.scene.raster import Layer
from robolink.sim.scene.solids import placed_corners
from robolink.sim.scene.strokes import strokes
from robolink.sim.scene.surfaces import Floor, Picture

FLOOR: Colour = (150, 145, 140)
"""Colour of a floor that has none."""

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
