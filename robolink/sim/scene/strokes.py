"""Strokes of paint on the floor, and the size of the picture that they need."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import ceil, floor, sqrt
from typing import NamedTuple

from robolink.geometry.plane import Area
from robolink.sim.description import FloorSettings, Paint
from robolink.sim.quantities import Point
from robolink.sim.scene.solids import placed_corners

# Lines painted on the floor as strokes: corners rounded by arcs, lengths cut into dashes.
#
# Only + - * / and square roots: the same bits on every machine.


_DEEPEST = 6
"""Most times that an arc is halved."""


class Stroke(NamedTuple):
    """A part of a line: its points, and whether it is a ring, whose last point is its first.

    The ends of one that is not a ring are square.
    """

    points: list[Point]
    ring: bool


def strokes(paint: Paint, tolerance: float) -> list[Stroke]:
    """Return the strokes of a painted line.

    Args:
        paint: The line.
        tolerance: Most that an arc is off the true one, in metres.
    """
    points = [*(paint.line or ())]
    if paint.radius > 0.0:
        points = list(_rounded(points, paint.closed, paint.radius, tolerance))
    if paint.closed:
        points.append(points[0])
    if paint.dashes is None:
        return [Stroke(points, paint.closed)]
    return [Stroke(each, False) for each in _dashed(points, *paint.dashes)]


def length_of(points: Sequence[Point]) -> float:
    """Return the length of the way from point to point, in metres."""
    return sum(_apart(p, q) for p, q in pairwise(points))


def tangents(points: Sequence[Point], closed: bool, radius: float) -> list[float]:
    """Return for each point how far before and behind it an arc of this radius begins and ends, in metres.

    That is 0 at the ends of an open line, and infinite where the line goes straight back.
    """
    count = len(points)
    found = []
    for index in range(count):
        if not closed and index in (0, count - 1):
            found.append(0.0)
            continue
        (ax, ay), (bx, by) = _way(points[index - 1], points[index]), _way(points[index], points[(index + 1) % count])
        whole = sqrt((ax * ax + ay * ay) * (bx * bx + by * by))
        cross, rest = abs(ax * by - ay * bx), whole + ax * bx + ay * by
        found.append(radius * cross / rest if rest > 1e-9 * whole else float("inf"))
    return found


def _rounded(points: Sequence[Point], closed: bool, radius: float, tolerance: float) -> Iterator[Point]:
    """Yield the points of a line whose corners are arcs; an arc that does not fit is as large as it can be."""
    lengths = tangents(points, closed, radius)
    count = len(points)
    for index, corner in enumerate(points):
        if lengths[index] <= 0.0:
            yield corner
            continue
        before, after = points[index - 1], points[(index + 1) % count]
        room = min(_apart(before, corner), _apart(corner, after)) / 2
        reach = min(lengths[index], room)
        start, end = _towards(corner, before, reach), _towards(corner, after, reach)
        yield start
        yield from _arc(start, end, corner, tolerance, _DEEPEST)
        yield end


def _arc(start: Point, end: Point, corner: Point, tolerance: float, depth: int) -> Iterator[Point]:
    """Yield the points between the ends of an arc whose tangents meet in `corner`, halving it until it is fine."""
    x, y = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    out_x, out_y = corner[0] - x, corner[1] - y
    out, half = sqrt(out_x * out_x + out_y * out_y), _apart(start, end) / 2
    side = sqrt(out * out + half * half)
    if depth == 0 or out <= 0.0 or side <= half:
        return
    rise = half * (side - half) / out  # from the chord's middle to the arc's
    if rise < tolerance:
        return
    middle = (x + out_x * (rise / out), y + out_y * (rise / out))
    share = half / (side + half)  # of the way to the corner, to where the halves' own tangents meet
    first, last = _between(start, corner, share), _between(end, corner, share)
    yield from _arc(start, middle, first, tolerance, depth - 1)
    yield middle
    yield from _arc(middle, end, last, tolerance, depth - 1)


def _dashed(points: Sequence[Point], dash: float, gap: float) -> Iterator[list[Point]]:
    """Yield the dashes along a line, each as its points."""
    drawn, left, current = True, dash, [points[0]]
    for start, end in pairwise(points):
        whole = _apart(start, end)
        gone = 0.0
        while whole - gone > left:
            gone += left
            at = _between(start, end, gone / whole)
            if drawn:
                yield [*current, at]
            drawn, current = not drawn, [at]
            left = dash if drawn else gap
        left -= whole - gone
        current.append(end)
    if drawn and length_of(current) > 0.0:
        yield current


def _way(start: Point, end: Point) -> tuple[float, float]:
    return end[0] - start[0], end[1] - start[1]


def _apart(start: Point, end: Point) -> float:
    dx, dy = _way(start, end)
    return sqrt(dx * dx + dy * dy)


def _between(start: Point, end: Point, share: float) -> Point:
    return start[0] + (end[0] - start[0]) * share, start[1] + (end[1] - start[1]) * share


def _towards(start: Point, end: Point, distance: float) -> Point:
    return _between(start, end, distance / _apart(start, end))


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
