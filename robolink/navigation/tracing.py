"""Cells along lines of sight, by Bresenham's algorithm for many lines at once."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.navigation.grid import Floats, Whole

_LINES = 2048
"""Lines that are traced together, which bounds the memory."""
_ROUNDING = 1e-6
"""Part of a cell by which a distance may be off."""


class Span(NamedTuple):
    """Distances from `least` to `most`, in metres or cells."""

    least: float
    most: float


def trace(
    shape: tuple[int, ...], start: tuple[int, int], rows: Whole, columns: Whole, span: Span
) -> npt.NDArray[np.int64]:
    """Return the flat indices of the cells on lines from one cell to others, both ends included; some come repeatedly.

    Lines end at the edge of the grid.

    Args:
        shape: Rows and columns of the grid.
        start: Row and column of the first cell, which is on the grid.
        rows: Rows of the last cells, which may be off the grid.
        columns: Their columns.
        span: Distances from the first cell, in cells, from which and up to which the cells are returned.
    """
    parts = [
        _trace(shape, start, rows[first : first + _LINES], columns[first : first + _LINES], span)
        for first in range(0, len(rows), _LINES)
    ]
    return np.concatenate(parts) if parts else np.empty(0, np.int64)


def _trace(shape: tuple[int, ...], start: tuple[int, int], rows: Whole, columns: Whole, span: Span) -> Whole:
    height, width = shape
    up, right = (rows - start[0]).astype(np.float64), (columns - start[1]).astype(np.float64)
    up_step, right_step = np.where(up < 0, -1, 1), np.where(right < 0, -1, 1)
    up_room = np.where(up < 0, start[0], height - 1 - start[0])
    right_room = np.where(right < 0, start[1], width - 1 - start[1])
    lengths = np.sqrt(up * up + right * right)
    up, right = np.abs(up), np.abs(right)
    steep = up > right
    major, minor = np.maximum(up, right), np.minimum(up, right)
    first, last = _ends(major, minor, lengths, span)
    last = np.minimum(last, np.where(steep, up_room, right_room))
    last = np.minimum(last, _steps_within(major, minor, np.where(steep, right_room, up_room)))
    most = int(last.max(initial=0.0)) + 1
    # Quotients of whole numbers that a float holds exactly: rounded down they are those of whole numbers.
    small = most * float(major.max(initial=1.0)) < 2**23 and height * width < 2**31
    kind, index = (np.float32, np.int32) if small else (np.float64, np.int64)
    steps = np.arange(most, dtype=index)
    aside = steps.astype(kind) * minor.astype(kind)[:, None]
    aside += _half(major).astype(kind)[:, None]
    aside /= np.maximum(major, 1).astype(kind)[:, None]
    cells = np.where(steep, up_step * width, right_step).astype(index)[:, None] * steps
    cells += np.where(steep, right_step, up_step * width).astype(index)[:, None] * aside.astype(index)
    cells += index(start[0] * width + start[1])
    chosen = steps <= last[:, None]
    if span.least > 0:
        chosen &= steps >= first[:, None]
    return cells[chosen].astype(np.int64)


def _half(major: Floats) -> Floats:
    """Return the half of a line's steps by which it begins in the middle of a cell."""
    return np.floor(major / 2)


def _ends(major: Floats, minor: Floats, lengths: Floats, span: Span) -> tuple[Floats, Floats]:
    """Return the numbers of the first and the last step of lines whose distances are bounded."""
    whole = np.maximum(lengths, 1.0)
    first = np.where(lengths < span.least, math.inf, np.ceil(major * (span.least / whole) - _ROUNDING))
    return first, np.floor(major * np.minimum(1.0, span.most / whole) + _ROUNDING)


def _steps_within(major: Floats, minor: Floats, room: npt.NDArray[Any]) -> Floats:
    """Return after how many steps a line has gone as far aside as there is `room`."""
    steps: Floats = np.ceil(((room + 1) * major - _half(major)) / np.maximum(minor, 1.0)) - 1
    return np.where(minor > 0, steps, math.inf)
