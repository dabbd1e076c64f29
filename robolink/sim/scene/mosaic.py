"""Picture as few coloured rectangles, for viewers that fill shapes and load no images."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations, islice, pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.sim.colours import Colour
from robolink.sim.scene.solids import Picture

_NEAR = 40.0
"""Distance of two colours, in units of 255, below which the rarer one gives way to the other."""

_FEW, _LEAST = 8, 0.005
"""Number of colours that a picture may have anyway, and the share of it that each further one must have."""

_EDGES = 0.05
"""Share of a picture up to which a colour between two others is one of the smoothed edges between these."""

_SHARES = (1.0, 0.75, 0.6, 0.5, 0.4, 0.32, 0.25, 0.2, 0.16, 0.125, 0.1, 0.08, 0.06, 0.04, 0.02, 0.01)
"""Resolutions that are tried, the finest first, as shares of the picture's own."""

_MOST_CELLS = 250_000
"""Most cells that are looked at: a finer resolution is not tried."""


class Patch(NamedTuple):
    """Rectangle of cells of one colour: from the column `left` up to but without `right`, so too the rows."""

    left: int
    top: int
    right: int
    bottom: int
    colour: Colour


class Mosaic(NamedTuple):
    """Picture of `columns` by `rows` cells: a background, and patches that do not overlap; row 0 is at the top."""

    columns: int
    rows: int
    background: Colour
    patches: list[Patch]


def mosaic(picture: Picture, most: int, colours: int = 16) -> Mosaic:
    """Return a picture as rectangles, as finely as a number of them can show it.

    Args:
        picture: The picture.
        most: Most rectangles, 1 or more; a coarse picture takes at least those that its coarsest cells need.
        colours: Most colours.
    """
    palette = _palette(picture, colours)
    rows, columns = picture.shape[:2]
    for share in _SHARES:
        size = max(1, round(rows * share)), max(1, round(columns * share))
        last = share == _SHARES[-1]
        if size[0] * size[1] > _MOST_CELLS and not last:
            continue
        numbers = _nearest(_resized(picture, size), palette)
        back = int(np.bincount(numbers.ravel(), minlength=len(palette)).argmax())
        patches = list(islice(_merged(numbers, back, [_colour(each) for each in palette]), None if last else most + 1))
        if last or len(patches) <= most:
            break
    return Mosaic(size[1], size[0], _colour(palette[back]), patches)


def _palette(picture: Picture, colours: int) -> npt.NDArray[np.float32]:
    """Return the most frequent colours that differ from each other."""
    flat = picture.reshape(-1, 3)
    flat = flat[:: max(1, len(flat) // 200_000)]
    bins = (flat >> 4).astype(np.int32) @ np.array([256, 16, 1], np.int32)
    used, which, counts = np.unique(bins, return_inverse=True, return_counts=True)
    sums = np.stack([np.bincount(which, flat[:, channel], len(used)) for channel in range(3)], axis=1)
    means = sums / counts[:, None]
    found: list[npt.NDArray[np.float64]] = []
    for index in np.argsort(-counts, kind="stable"):
        colour, share = means[index], counts[index] / len(flat)
        if len(found) >= _FEW and share < _LEAST:
            break
        if all(np.abs(colour - each).sum() > _NEAR for each in found) and (
            share > _EDGES or not _is_mixed(colour, found)
        ):
            found.append(colour)
        if len(found) == colours:
            break
    return np.array(found, np.float32)


def _is_mixed(colour: npt.NDArray[np.float64], others: Sequence[npt.NDArray[np.float64]]) -> bool:
    """True if a colour lies between two others."""
    for first, second in combinations(others, 2):
        way = second - first
        share = float(np.clip((colour - first) @ way / (way @ way), 0.0, 1.0))
        if np.abs(first + share * way - colour).sum() < _NEAR:
            return True
    return False


def _resized(picture: Picture, size: tuple[int, int]) -> npt.NDArray[np.float32]:
    """Return a picture of this many rows and columns: each pixel is the mean of those that it is made of."""
    image = picture.astype(np.float32)
    for axis, count in enumerate(size):
        length = image.shape[axis]
        if count != length:
            edges = np.arange(count + 1) * length // count
            image = np.add.reduceat(image, edges[:-1], axis=axis)
            image /= np.diff(edges).reshape((-1, 1, 1) if axis == 0 else (1, -1, 1)).astype(np.float32)
    return image


def _nearest(image: npt.NDArray[np.float32], palette: npt.NDArray[np.float32]) -> npt.NDArray[np.intp]:
    """Return for each pixel the number of the colour that is most like it."""
    best = np.full(image.shape[:2], np.inf, np.float32)
    found = np.zeros(image.shape[:2], np.intp)
    for number, colour in enumerate(palette):
        off = np.square(image - colour).sum(axis=2)
        np.copyto(found, number, where=off < best)
        np.minimum(best, off, out=best)
    return found


def _merged(numbers: npt.NDArray[np.intp], back: int, colours: list[Colour]) -> Iterator[Patch]:
    """Yield the patches of a picture of numbers: runs of a row that are the same in the next rows are one."""
    rows, columns = numbers.shape
    changes = numbers[:, 1:] != numbers[:, :-1]
    growing: dict[tuple[int, int, int], int] = {}
    for row in range(rows + 1):
        runs: dict[tuple[int, int, int], int] = {}
        if row < rows:
            edges = [0, *(np.flatnonzero(changes[row]) + 1).tolist(), columns]
            shown = numbers[row, edges[:-1]].tolist()
            runs = {(*ends, each): row for ends, each in zip(pairwise(edges), shown, strict=True) if each != back}
        for run in [each for each in growing if each not in runs]:
            left, right, number = run
            yield Patch(left, growing.pop(run), right, row, colours[number])
        growing = {**runs, **growing}


def _colour(values: npt.NDArray[np.float32]) -> Colour:
    red, green, blue = (round(float(each)) for each in values)
    return red, green, blue
