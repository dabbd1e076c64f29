"""Canvas of turtlesim: the lines of the pens, the colour at a place, and the picture of all with the turtles."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from robolink.counterparts.turtlesim.turtle import METRE, SIDE, SIZE, Line, Point

Colour = tuple[int, int, int]
"""Red, green and blue from 0 to 255."""
Pixels = NDArray[np.uint8]

BACKGROUND: Colour = (69, 86, 255)
SHELLS: tuple[Colour, ...] = (
    (84, 152, 62),
    (196, 120, 44),
    (150, 84, 160),
    (60, 150, 150),
    (190, 70, 70),
    (120, 120, 60),
    (90, 90, 170),
    (170, 140, 60),
)
"""Colours of shells; each turtle has the next one."""

_SPRITE = 45
"""Width and height of a turtle, in pixels."""
_FINE = 3
"""Samples of each pixel of a turtle, along both axes."""
_ANGLES = 180
"""Headings in which turtles are drawn."""


class Drawn(NamedTuple):
    """A turtle to draw: pose in metres and radians, and the number of its colour."""

    x: float
    y: float
    theta: float
    shell: int


class Canvas:
    """Canvas with the lines of the pens, on a background."""

    def __init__(self, background: Colour = BACKGROUND) -> None:
        self._background = background
        self._pixels: Pixels = np.empty((SIDE, SIDE, 3), np.uint8)
        self._lines = np.zeros((SIDE, SIDE), np.bool_)
        self.clear()

    @property
    def background(self) -> Colour:
        """Colour where no pen has drawn."""
        return self._background

    @background.setter
    def background(self, colour: Colour) -> None:
        self._background = colour
        self._pixels[~self._lines] = colour

    def clear(self) -> None:
        """Take all lines away."""
        self._lines[:] = False
        self._pixels[:] = self._background

    def draw(self, lines: Iterable[Line]) -> None:
        """Draw lines, the later ones above the earlier."""
        for line in lines:
            rows, columns, near = _stroke(_pixel(line.start), _pixel(line.end), line.pen.width / 2)
            self._pixels[rows, columns][near] = line.pen[:3]
            self._lines[rows, columns] |= near

    def colour_at(self, x: float, y: float) -> Colour:
        """Return the colour at a place of the window, in metres."""
        column, row = (min(max(round(each), 0), SIDE - 1) for each in _pixel((x, y)))
        r, g, b = self._pixels[row, column].tolist()
        return r, g, b

    def picture(self, turtles: Iterable[Drawn]) -> Pixels:
        """Return the picture with the turtles: (rows, columns, 3) as red, green and blue."""
        picture: Pixels = self._pixels.copy()
        for each in turtles:
            _put(picture, each)
        return picture


def _pixel(place: Point) -> Point:
    """Return column and row of a place, with fractions."""
    return place[0] * METRE, (SIZE - place[1]) * METRE


def _stroke(start: Point, end: Point, half: float) -> tuple[slice, slice, NDArray[np.bool_]]:
    """Return the rows, columns and pixels of a line with round ends, from one place in pixels to another."""
    columns, rows = (_span(a, b, half) for a, b in zip(start, end, strict=True))
    x = np.arange(columns.start, columns.stop, dtype=float) - start[0]
    y = (np.arange(rows.start, rows.stop, dtype=float) - start[1])[:, None]
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = dx * dx + dy * dy
    along = np.clip((x * dx + y * dy) / length, 0.0, 1.0) if length else 0.0
    return rows, columns, (x - along * dx) ** 2 + (y - along * dy) ** 2 <= max(half, 0.5) ** 2


def _span(a: float, b: float, half: float) -> slice:
    """Return the pixels of the window that a line can touch, along one axis."""
    low, high = (min(max(each, 0.0), float(SIDE)) for each in (min(a, b) - half, max(a, b) + half + 1.0))
    return slice(math.floor(low), math.ceil(high))


def _put(picture: Pixels, turtle: Drawn) -> None:
    """Draw a turtle into a picture, as far as it lies in there."""
    sprite, cover = _sprite(round(turtle.theta / math.tau * _ANGLES) % _ANGLES, turtle.shell % len(SHELLS))
    column, row = (round(each) - _SPRITE // 2 for each in _pixel((turtle.x, turtle.y)))
    top, left = max(0, -row), max(0, -column)
    below = picture[max(0, row) : max(0, row + _SPRITE), max(0, column) : max(0, column + _SPRITE)]
    part = (slice(top, top + below.shape[0]), slice(left, left + below.shape[1]))
    below[:] = below * (1.0 - cover[part]) + sprite[part] * cover[part]


@functools.lru_cache(maxsize=4 * _ANGLES)
def _sprite(angle: int, shell: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return a turtle's colours and its cover from 0 to 1, for one of the headings."""
    count = _SPRITE * _FINE
    across = (np.arange(count) + 0.5) / count * 2.0 - 1.0
    theta = angle / _ANGLES * math.tau
    ahead = across * math.cos(theta) - across[:, None] * math.sin(theta)
    left = -across * math.sin(theta) - across[:, None] * math.cos(theta)
    colours = np.zeros((count, count, 3))
    cover = np.zeros((count, count), np.bool_)
    for part, colour in _parts(ahead, np.abs(left), SHELLS[shell]):
        colours[part] = colour
        cover |= part
    share = _coarse(cover[..., None].astype(float))
    return _coarse(colours * cover[..., None]) / np.maximum(share, 1e-9), share


def _parts(
    ahead: NDArray[np.float64], aside: NDArray[np.float64], shell: Colour
) -> Iterable[tuple[NDArray[np.bool_], Colour]]:
    """Yield the parts of a turtle that looks ahead, the lowest first, with their colours."""

    def ellipse(x: float, y: float, a: float, b: float) -> NDArray[np.bool_]:
        return ((ahead - x) / a) ** 2 + ((aside - y) / b) ** 2 <= 1.0

    skin, dark = (150, 190, 110), tuple(int(each * 0.6) for each in shell)
    light = tuple(min(255, int(each * 1.25)) for each in shell)
    yield (aside < (ahead + 0.95) * 0.5) & (ahead < -0.4) & (ahead > -0.95), skin  # tail
    yield ellipse(0.42, 0.55, 0.3, 0.18), skin  # fore legs
    yield ellipse(-0.42, 0.5, 0.24, 0.18), skin
    yield ellipse(0.72, 0.0, 0.24, 0.2), skin  # head
    yield ellipse(0.8, 0.11, 0.055, 0.05), (20, 20, 20)  # eyes
    yield ellipse(0.0, 0.0, 0.62, 0.55), (dark[0], dark[1], dark[2])
    yield ellipse(0.0, 0.0, 0.53, 0.46), shell
    for x, y, size in (
        (0.0, 0.0, 0.17),
        (0.33, 0.0, 0.12),
        (-0.33, 0.0, 0.12),
        (0.17, 0.27, 0.12),
        (-0.17, 0.27, 0.12),
    ):
        yield ellipse(x, y, size, size), (light[0], light[1], light[2])


def _coarse(fine: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the means of the samples of each pixel."""
    shape = (_SPRITE, _FINE, _SPRITE, _FINE, fine.shape[2])
    means: NDArray[np.float64] = fine.reshape(shape).mean(axis=(1, 3))
    return means
