"""Grids of cells over a plane: which cell a point lies in, and how far each cell is from the occupied ones."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Whole = npt.NDArray[np.int64]

FAR = 2**31 - 1
"""Largest row and column that `Grid.world_to_cell` returns: cells farther off become it."""

_STRIP = 65_536
"""Cells that are transformed together: so many stay in a processor's cache."""


class Grid(NamedTuple):
    """Cells over a plane, as those of a map or a costmap.

    `cells` are by row from the bottom and by column from the left, `resolution` is the side of a cell in metres, and
    `origin` the pose (x and y in metres, theta in radians) of the lower left corner of the first cell.
    """

    cells: npt.NDArray[Any]
    resolution: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def world_to_cell(self, x: npt.ArrayLike, y: npt.ArrayLike) -> tuple[Whole, Whole]:
        """Return rows and columns of the cells that points lie in, which may be off the grid, as NaN does.

        Args:
            x: Coordinates in metres.
            y: Coordinates in metres, as many.
        """
        dx, dy = np.asarray(x, np.float64) - self.origin[0], np.asarray(y, np.float64) - self.origin[1]
        if self.origin[2]:
            cos, sin = math.cos(self.origin[2]), math.sin(self.origin[2])
            dx, dy = cos * dx + sin * dy, cos * dy - sin * dx
        return _floor(dy / self.resolution), _floor(dx / self.resolution)

    def cell_to_world(self, row: npt.ArrayLike, column: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Return x and y of the centres of cells, in metres."""
        dx = (np.asarray(column, np.float64) + 0.5) * self.resolution
        dy = (np.asarray(row, np.float64) + 0.5) * self.resolution
        if self.origin[2]:
            cos, sin = math.cos(self.origin[2]), math.sin(self.origin[2])
            dx, dy = cos * dx - sin * dy, sin * dx + cos * dy
        return dx + self.origin[0], dy + self.origin[1]

    def contains(self, row: npt.ArrayLike, column: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return which cells are on the grid."""
        row, column = np.asarray(row), np.asarray(column)
        height, width = self.cells.shape
        inside: npt.NDArray[np.bool_] = (row >= 0) & (row < height) & (column >= 0) & (column < width)
        return inside


def _floor(value: Floats) -> Whole:
    """Round down; what is beyond all grids becomes `FAR` or -`FAR`, and NaN -`FAR`."""
    found: Whole = np.fmin(np.fmax(np.floor(value), -FAR), FAR).astype(np.int64)  # fmax takes the other of NaN and it
    return found


def distances(occupied: npt.NDArray[np.bool_], most_cells: int | None = None) -> npt.NDArray[np.float32]:
    """Return how far each cell is from the nearest occupied one, in cells from centre to centre: exact and Euclidean.

    It is found by columns first and then along rows (Felzenszwalb and Huttenlocher 2012), here by whole arrays.

    Args:
        occupied: True for occupied cells; rows and columns.
        most_cells: Distance from which on all is alike: larger ones become it. The time grows with it. None finds
            every distance, and infinity everywhere if no cell is occupied.
    """
    if most_cells is None and not occupied.any():
        return np.full(occupied.shape, math.inf, np.float32)
    most = sum(occupied.shape) if most_cells is None else most_cells
    found: npt.NDArray[np.float32] = np.sqrt(squared_distances(occupied, most), dtype=np.float32)
    return found


def squared_distances(occupied: npt.NDArray[np.bool_], most_cells: int) -> npt.NDArray[np.integer[Any]]:
    """Return the squares of `distances`, which are whole numbers: a table may be indexed by them.

    Args:
        occupied: True for occupied cells; rows and columns.
        most_cells: Distance in cells from which on all is alike: larger ones become it.
    """
    height, width = occupied.shape
    # The sum of two squares must fit; half the bytes are twice the speed.
    kind = np.uint16 if most_cells <= 180 else np.int64 if most_cells > 30_000 else np.uint32
    if not occupied.any():
        return np.full(occupied.shape, most_cells * most_cells, kind)
    upright = _down_columns(occupied, most_cells, kind)
    upright *= upright
    squares = np.empty_like(upright)
    rows = max(_STRIP // max(width, 1), 1)
    for first in range(0, height, rows):
        _along_rows(upright[first : first + rows], squares[first : first + rows], min(most_cells, width) - 1)
    return squares


def _down_columns(occupied: npt.NDArray[np.bool_], most: int, kind: type[np.integer[Any]]) -> npt.NDArray[Any]:
    """Return how far up or down the nearest occupied cell of the same column is, at most `most`.

    A distance is the sum of some of 1, 2, 4 ...: one look as far as each of them in both directions finds it.
    """
    found: npt.NDArray[Any] = np.where(occupied, kind(0), kind(most))
    step = 1
    while step <= min(most, len(found) - 1):
        farther = found + kind(step)
        found = found.copy()
        np.minimum(found[step:], farther[:-step], out=found[step:])
        np.minimum(found[:-step], farther[step:], out=found[:-step])
        step *= 2
    return found


def _along_rows(upright: npt.NDArray[Any], squares: npt.NDArray[Any], reach: int) -> None:
    """Write the squared distances of rows whose squared distances along the columns are known."""
    squares[:] = upright
    farther = np.empty_like(upright)
    for shift in range(1, reach + 1):
        np.add(upright, upright.dtype.type(shift * shift), out=farther)
        np.minimum(squares[:, shift:], farther[:, :-shift], out=squares[:, shift:])
        np.minimum(squares[:, :-shift], farther[:, shift:], out=squares[:, :-shift])
