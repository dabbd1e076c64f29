"""Size of the painted floor in pixels, and the limits that a check of a world has for it."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil, floor, sqrt
from typing import NamedTuple

from robolink.geometry.plane import Area
from robolink.sim.description import FloorSettings, Paint
from robolink.sim.scene.solids import placed_corners
from robolink.sim.scene.strokes import length_of

RESOLUTION = 0.005
"""Side of a pixel in metres where a world file has none."""

MOST_PIXELS = 16_000_000
"""Most pixels of a floor: 20 x 20 m at 5 mm."""

_TOLERANCE = 1e-6
"""Part of a pixel that something painted may reach into it without taking it."""


MOST_WORK = 10 * MOST_PIXELS
"""Most pixels that are looked at for all that is painted: what lies over each other counts several times."""

_SLANT = 100.0
"""Number of empty pixels that are looked at for each pixel of the way of a slanting line."""

MOST_PIECES = 50_000
"""Most pieces of all lines, which take 50 us each."""


class Extent(NamedTuple):
    """Part of the plane that has an image: x and y of its lower left corner in metres, and its pixels."""

    x: float
    y: float
    columns: int
    rows: int

    @property
    def pixels(self) -> int:
        """Number of pixels."""
        return self.columns * self.rows


def resolution_of(settings: FloorSettings) -> float:
    """Return the side of a pixel of the floor, in metres."""
    return settings.resolution or RESOLUTION


def extent(settings: FloorSettings, paint: Sequence[Paint], picture: tuple[int, int] = (0, 0)) -> Extent:
    """Return the part of the floor that has an image: whole pixels around all paint, and the picture.

    Args:
        settings: The floor.
        paint: All that is painted.
        picture: Columns and rows of the floor's picture.
    """
    side, (x0, y0) = resolution_of(settings), settings.origin
    boxes = [box_of(each) for each in paint]
    if picture[0]:
        boxes.append(Area(x0, y0, x0 + picture[0] * side, y0 + picture[1] * side))
    if not boxes:
        return Extent(x0, y0, 0, 0)
    # A little tolerant, so that an edge on the edge of a pixel takes no other pixel.
    left, low = (
        floor((min(each.x_min for each in boxes) - x0) / side + _TOLERANCE),
        floor((min(each.y_min for each in boxes) - y0) / side + _TOLERANCE),
    )
    right = ceil((max(each.x_max for each in boxes) - x0) / side - _TOLERANCE)
    high = ceil((max(each.y_max for each in boxes) - y0) / side - _TOLERANCE)
    return Extent(x0 + left * side, y0 + low * side, max(right - left, 1), max(high - low, 1))


def too_much(settings: FloorSettings, paint: Sequence[Paint], picture: tuple[int, int] = (0, 0)) -> str:
    """Return why this floor is too much for its resolution, or '' if it is not.

    Args:
        settings: The floor.
        paint: All that is painted.
        picture: Columns and rows of the floor's picture.
    """
    side, whole = resolution_of(settings), extent(settings, paint, picture)
    if whole.pixels > MOST_PIXELS:
        size = f"{whole.columns * side:.4g} x {whole.rows * side:.4g} m at {side:g} m"
        coarser = ceil(1010 * side * sqrt(whole.pixels / MOST_PIXELS)) / 1000
        most = f"at most {MOST_PIXELS // 10**6} million: take {coarser:g}, or paint less"
        return f"{size} are {whole.pixels / 1e6:.3g} million pixels, {most}"
    if sum(extent(settings, [each]).pixels + _work(each, side) for each in paint) > MOST_WORK:
        return f"too much is painted over each other, at {side:g} m: take a coarser resolution, or paint less"
    if sum(_pieces(each, side) for each in paint) > MOST_PIECES:
        return f"the lines have more than {MOST_PIECES:,} pieces at {side:g} m: fewer points, corners or dashes"
    return ""


def _pieces(paint: Paint, side: float) -> float:
    """Return about how many pieces a line is painted in."""
    dashes = 0.0 if paint.dashes is None else _length(paint) / sum(paint.dashes)
    return len(paint.line or ()) * (16 if paint.radius else 1) + _length(paint) / side / 100 + dashes


def _work(paint: Paint, side: float) -> float:
    """Return about how many pixels are looked at to paint a line: at each of its pieces a square, and the way."""
    width = paint.width / side
    return _pieces(paint, side) * (width + 2.0) ** 2 + _length(paint) / side * (width + _SLANT)


def _length(paint: Paint) -> float:
    """Return the length of a line in metres; 0 of what is none."""
    points = paint.line or ()
    return length_of([*points, points[0]] if points and paint.closed else points)


def box_of(paint: Paint) -> Area:
    """Return the box around something painted."""
    if paint.line is not None:
        points, reach = list(paint.line), paint.width / 2
    elif paint.circle is not None:
        points, reach = [(paint.pose.x, paint.pose.y)], paint.circle
    else:
        points, reach = placed_corners(paint, paint.pose.place), 0.0
    xs, ys = [x for x, _ in points], [y for _, y in points]
    return Area(min(xs) - reach, min(ys) - reach, max(xs) + reach, max(ys) + reach)
