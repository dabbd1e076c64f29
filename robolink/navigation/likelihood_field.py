"""Likelihood field: how well the end of a laser beam at each place of a map fits to the walls that are nearby.

The field is a table, made once for a map, of the logarithm of Thrun's `likelihood_field_range_finder_model`
(Probabilistic Robotics, table 6.3): `z_hit` times a bell curve over the distance to the nearest wall, plus
`z_rand / range_max`. Distances are finer than the map's cells. They are taken to the surface that a laser sees: to the
edge of a wall that is thicker than a cell, to the middle of one that is a single cell wide, since its surface may be
anywhere in that cell. What lies inside of thick walls is as far from their surface as what lies before it.
"""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.trigonometry import cos_and_sin
from robolink.navigation.grid import Floats, Grid, distances

Bools = npt.NDArray[np.bool_]

OCCUPIED = 65
"""Value of a map's cell, of 100, from which it counts as a wall."""

UNITS = 1024
"""Units of the table's logarithms per nat. Sums of whole numbers are the same in any order, on any machine."""
LOWEST = -30
"""Smallest logarithm in the table: less likely is not told apart."""

WIDE = 4.0
"""Distance, in `sigma_hit`, from which on walls are as good as infinitely far."""
FINEST = 3_000_000
"""Most entries of a table that is finer than the map."""

_SIDES = ((0, 1), (0, -1), (1, 0), (-1, 0))


class SensorModel(NamedTuple):
    """Model of what a beam may measure, with Nav2's parameters of the same names.

    `z_hit` and `z_rand` are the shares of beams that hit what the map has, and of those that end anywhere; `sigma_hit`
    the standard deviation of the former and `max_distance` the distance from which walls are not seen, in metres.
    """

    z_hit: float = 0.5
    z_rand: float = 0.5
    sigma_hit: float = 0.2
    max_distance: float = 2.0


class LikelihoodField:
    """Table of a map that rates the ends of beams.

    Args:
        grid: Map with cells from 0 (free) to 100 (occupied), -1 for unknown.
        model: Model of what a beam may measure.
        range_max: Longest range of the scanner in metres.
    """

    def __init__(self, grid: Grid, model: SensorModel, range_max: float) -> None:
        occupied, free = grid.cells >= OCCUPIED, grid.cells == 0
        self._origin = grid.origin
        size = occupied.size
        self._per_cell = 4 if 16 * size <= FINEST else 2 if 4 * size <= FINEST else 1
        lattice = surfaces(occupied, free) if self._per_cell > 1 else occupied
        self._step = grid.resolution / self._per_cell
        reach = min(model.max_distance, WIDE * model.sigma_hit)
        most = min(max(math.ceil(reach * min(self._per_cell, 2) / grid.resolution), 1), sum(lattice.shape))
        found = distances(lattice, most)
        if self._per_cell == 4:
            found, most = _doubled(found), 2 * most
        logs = _logs(most, self._step, model, range_max)
        self._height, self._width = found.shape[0] + 2, found.shape[1] + 2
        table = np.full((self._height, self._width), logs[-1], np.int16)
        table[1:-1, 1:-1] = logs[np.rint(found * 8).astype(np.int32)]
        self._table, self._model, self._range_max = table.ravel(), model, range_max

    def ratings(self, poses: Floats, ahead: Floats, aside: Floats) -> npt.NDArray[np.int16]:
        """Return the log-likelihood of each beam for each pose, in 1/`UNITS` nats: of shape (poses, beams).

        Args:
            poses: Rows x, y (metres) and heading (radians) of poses in the frame of the map.
            ahead: Ends of beams, in metres ahead of the robot.
            aside: The same, in metres to its left.
        """
        x, y, turned = self._on_map(poses)
        cos, sin = (each.astype(np.float32)[:, None] for each in cos_and_sin(turned))
        scale = 1.0 / self._step
        along, across = (ahead * scale).astype(np.float32), (aside * scale).astype(np.float32)
        column = cos * along
        column -= sin * across
        column += x.astype(np.float32)[:, None]
        row = sin * along
        row += cos * across
        row += y.astype(np.float32)[:, None]
        np.clip(column, 0, self._width - 1, out=column)
        np.clip(row, 0, self._height - 1, out=row)
        place = row.astype(np.int32)
        place *= self._width
        place += column.astype(np.int32)
        return self._table.take(place)

    def rating(self, distance: float) -> int:
        """Return the log-likelihood of a beam that ends at a distance from a wall (metres), as `ratings` has it."""
        return _log(distance, self._model, self._range_max)

    def _on_map(self, poses: Floats) -> tuple[Floats, Floats, Floats]:
        """Return columns and rows of the table, and headings, of poses."""
        x, y, theta = self._origin
        dx, dy, turned = poses[0] - x, poses[1] - y, poses[2]
        if theta:
            cos, sin = math.cos(theta), math.sin(theta)
            dx, dy, turned = cos * dx + sin * dy, cos * dy - sin * dx, turned - theta
        # The table has a border of 1. Finer than the map, its entries are points, the first on the map's corner.
        shift = 1.5 if self._per_cell > 1 else 1.0
        return dx / self._step + shift, dy / self._step + shift, turned


def surfaces(occupied: Bools, free: Bools) -> Bools:
    """Return the points that lasers see of walls: True on a lattice of two points per cell, the first on a corner.

    A cell's corner in row i, column j is the point 2i, 2j of the lattice, its centre 2i + 1, 2j + 1. Cells that no free
    cell is beside are inside of a wall or behind it, unless they stand alone.

    Args:
        occupied: Cells of walls.
        free: Cells in which nothing stands; the others are unknown.
    """
    height, width = occupied.shape
    lattice = np.zeros((2 * height + 1, 2 * width + 1), np.bool_)
    walls, open_ = np.pad(occupied, 1), np.pad(free, 1)
    centre = occupied & ~_touched(walls)
    for up, right in _SIDES:
        seen = occupied & _shifted(open_, up, right)
        thick = seen & _shifted(walls, -up, -right)
        centre |= seen & ~thick
        row, column = thick.nonzero()
        for along in (-1, 0, 1):  # an edge: its middle and both ends
            lattice[2 * row + 1 + (up or along), 2 * column + 1 + (right or along)] = True
    if not free.any():
        centre = occupied
    lattice[1::2, 1::2] |= centre
    lattice[2:-1:2, 1::2] |= centre[1:] & centre[:-1]  # thin walls are lines, not rows of points
    lattice[1::2, 2:-1:2] |= centre[:, 1:] & centre[:, :-1]
    return lattice


def _shifted(padded: Bools, up: int, right: int) -> Bools:
    """Return the cells above and to the right of each: `up` rows and `right` columns off."""
    return padded[1 + up : padded.shape[0] - 1 + up, 1 + right : padded.shape[1] - 1 + right]


def _touched(walls: Bools) -> Bools:
    """Return which cells touch a wall, if only at a corner; `walls` has a border."""
    touched = np.zeros((walls.shape[0] - 2, walls.shape[1] - 2), np.bool_)
    for up, right in itertools.product((-1, 0, 1), repeat=2):
        if up or right:
            touched |= _shifted(walls, up, right)
    return touched


def _doubled(found: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Return distances at twice as many points, in their new unit: linear in between."""
    height, width = found.shape
    finer = np.empty((2 * height - 1, 2 * width - 1), np.float32)
    finer[::2, ::2] = found + found
    finer[1::2, ::2] = found[1:] + found[:-1]
    finer[:, 1::2] = (finer[:, :-1:2] + finer[:, 2::2]) / 2
    return finer


def _logs(most: int, step: float, model: SensorModel, range_max: float) -> npt.NDArray[np.int16]:
    """Return the log-likelihoods of distances in eighths of a step; the last is that of all that is far."""
    found = [_log(each * step / 8, model, range_max) for each in range(8 * most)]
    return np.array([*found, _log(max(model.max_distance, most * step), model, range_max)], np.int16)


def _log(distance: float, model: SensorModel, range_max: float) -> int:
    sigma = max(model.sigma_hit, 1e-6)
    hit = model.z_hit * math.exp(-min(distance * distance / (2 * sigma * sigma), 700.0))
    chance = hit + model.z_rand / max(range_max, 1e-6)
    return round(UNITS * max(math.log(chance), LOWEST)) if chance > 0.0 else UNITS * LOWEST
