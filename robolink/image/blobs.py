"""Blobs: connected areas of one hue in an image, by numpy alone."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

HUES = ("red", "yellow", "green", "cyan", "blue", "magenta")
"""Names of the hues that are told apart, each 60 degrees of the circle of colours wide."""

LEAST_SATURATION, LEAST_VALUE = 0.4, 40
"""Least share of a colour that is not gray, and least of its largest channel (of 255)."""

LEAST_SHARE = 0.0005
"""Least share of an image that a blob has; what is smaller is noise."""

Pixels = npt.NDArray[np.uint8]


class Blob(NamedTuple):
    """Connected area of one hue in an image.

    Args:
        hue: Name of the hue, of `HUES`.
        left: First column.
        top: First row.
        width: Columns.
        height: Rows.
        area: Number of pixels.
        colour: Mean of red, green and blue, 0 to 255.
    """

    hue: str
    left: int
    top: int
    width: int
    height: int
    area: int
    colour: tuple[float, float, float]

    @property
    def centre(self) -> tuple[int, int]:
        """The column and row of the middle of its box."""
        return self.left + self.width // 2, self.top + self.height // 2


class _Runs(NamedTuple):
    """Pixels of one hue side by side in a row: from `first` to before `end`; in the order of rows, then columns."""

    row: npt.NDArray[np.intp]
    first: npt.NDArray[np.intp]
    end: npt.NDArray[np.intp]
    hue: npt.NDArray[np.intp]


def find_blobs(image: Pixels) -> list[Blob]:
    """Return the blobs of an image, the largest first.

    Args:
        image: Array of (rows, columns, 3) in the order red, green, blue.
    """
    hues = _hues(image)
    runs = _runs(hues)
    labels = _labels(runs)
    areas = np.bincount(labels, weights=runs.end - runs.first)
    large = np.flatnonzero(areas > LEAST_SHARE * hues.size).tolist()
    found = [_blob(image, runs, np.flatnonzero(labels == label)) for label in large]
    return sorted(found, key=lambda blob: (-blob.area, blob.top, blob.left))


def _hues(image: Pixels) -> npt.NDArray[np.intp]:
    """Return the number of each pixel's hue, 1 for the first of `HUES`; 0 for a gray or dark one."""
    red, green, blue = (image[..., channel].astype(np.float32) for channel in range(3))
    most = np.maximum(np.maximum(red, green), blue)
    spread = most - np.minimum(np.minimum(red, green), blue)
    safe = np.maximum(spread, 1.0)
    sixth = np.where(
        most == red,
        (green - blue) / safe,
        np.where(most == green, 2.0 + (blue - red) / safe, 4.0 + (red - green) / safe),
    )
    number = np.floor(sixth + 0.5).astype(np.intp) % len(HUES) + 1
    return np.where((spread >= LEAST_SATURATION * most) & (most >= LEAST_VALUE), number, 0)


def _runs(hues: npt.NDArray[np.intp]) -> _Runs:
    """Return the runs of an image of hues."""
    rows, columns = hues.shape
    edged = np.zeros((rows, columns + 1), np.intp)  # a gray column ends each row
    edged[:, :columns] = hues
    flat = edged.ravel()
    changes = np.flatnonzero(np.diff(flat, prepend=0, append=0))
    coloured = flat[changes[:-1]] > 0
    first, end = changes[:-1][coloured], changes[1:][coloured]
    row = first // (columns + 1)
    return _Runs(row, first - row * (columns + 1), end - row * (columns + 1), flat[first])


def _labels(runs: _Runs) -> npt.NDArray[np.intp]:
    """Return the number of the blob that each run belongs to: runs of a hue that touch in adjacent rows are one."""
    parents = list(range(len(runs.row)))

    def root(of: int) -> int:
        while parents[of] != of:
            parents[of] = parents[parents[of]]
            of = parents[of]
        return of

    row, first, end, hue = (each.tolist() for each in runs)
    above = 0
    for here in range(len(row)):
        while row[above] < row[here] - 1 or (row[above] == row[here] - 1 and end[above] <= first[here]):
            above += 1
        other = above
        while row[other] == row[here] - 1 and first[other] < end[here]:
            if hue[other] == hue[here]:
                parents[root(other)] = root(here)
            other += 1
    return np.array([root(each) for each in range(len(row))], dtype=np.intp)


def _blob(image: Pixels, runs: _Runs, which: npt.NDArray[np.intp]) -> Blob:
    """Return the blob of some runs."""
    row, first, end = runs.row[which], runs.first[which], runs.end[which]
    left, top, right, bottom = int(first.min()), int(row.min()), int(end.max()), int(row.max()) + 1
    pieces = [image[y, a:b] for y, a, b in zip(row.tolist(), first.tolist(), end.tolist(), strict=True)]
    red, green, blue = np.concatenate(pieces).mean(axis=0, dtype=np.float64).tolist()
    area = int((end - first).sum())
    return Blob(HUES[int(runs.hue[which[0]]) - 1], left, top, right - left, bottom - top, area, (red, green, blue))
