"""Smoothing of ways through a grid: straight lines where they are not dearer, and rounded corners."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from robolink.navigation.grid import Floats
from robolink.navigation.search import BLOCKED, DEAREST, Weights

SAMPLES = 4
"""Samples of a line for each cell that it crosses."""
ROUNDS = 60
"""Rounds of rounding corners."""
REACH = 24
"""Neighbours on either side that move a point by more than nothing."""
TO_LINE, TO_NEIGHBOURS = 0.05, 0.45
"""Shares by which a round moves a point towards its old place, and between its neighbours."""


def shortened(points: Floats, weights: Weights, slope: float) -> Floats:
    """Return the corners of a way after straight lines have replaced its parts wherever they cost no more.

    Args:
        points: Points one behind the other, as columns and rows of cells and parts of them: shape (points, 2).
        weights: Cells, as in `search`; none of the points is in a blocked one.
        slope: What a cell of weight 252 costs more than one of weight 0, as a multiple of that.
    """
    costs = np.where(np.arange(256) <= DEAREST, 1.0 + slope * np.arange(256) / 252, math.inf)
    ways = np.diff(points, axis=0)
    lengths = np.sqrt((ways * ways).sum(axis=1))
    entered = costs[_weights_at(points, weights)]
    spent = np.concatenate(([0.0], np.cumsum(lengths * (entered[1:] + entered[:-1]) / 2)))
    corners = [0]
    while corners[-1] < len(points) - 1:
        corners.append(_farthest(points, weights, costs, spent, corners[-1]))
    return points[corners]


def _farthest(points: Floats, weights: Weights, costs: Floats, spent: Floats, first: int) -> int:
    """Return the last point that a straight line from the `first` leads to at no greater cost, by halving."""

    def is_good(last: int) -> bool:
        most = float(spent[last] - spent[first]) * (1 + 1e-9)
        return _line_cost(points[first], points[last], weights, costs) <= most

    good, step = first + 1, 2
    while good < len(points) - 1 and is_good(min(first + step, len(points) - 1)):
        good, step = min(first + step, len(points) - 1), 2 * step
    bad = min(first + step, len(points))
    while bad - good > 1:
        middle = (good + bad) // 2
        if is_good(middle):
            good = middle
        else:
            bad = middle
    return good


def _line_cost(start: Floats, end: Floats, weights: Weights, costs: Floats) -> float:
    """Return the cost of a straight line; infinity if it crosses a blocked cell."""
    (x, y), (to_x, to_y) = map(float, start), map(float, end)
    length = math.hypot(to_x - x, to_y - y)
    count = math.ceil(length * SAMPLES) + 1
    shares = np.arange(count + 1) / count
    # Both ends are on the grid, and so all of the line is.
    rows, columns = (y + (to_y - y) * shares).astype(np.intp), (x + (to_x - x) * shares).astype(np.intp)
    return length * float(costs[weights[rows, columns]].sum()) / (count + 1)


def _weights_at(points: Floats, weights: Weights) -> npt.NDArray[np.uint8]:
    """Return the weights of the cells in which points lie; off the grid they are blocked."""
    cells = np.floor(points).astype(np.int64)
    columns, rows = cells[:, 0], cells[:, 1]
    there = (rows >= 0) & (rows < weights.shape[0]) & (columns >= 0) & (columns < weights.shape[1])
    found: Weights = weights[rows.clip(0, weights.shape[0] - 1), columns.clip(0, weights.shape[1] - 1)]
    found[~there] = BLOCKED
    return found


def spaced(points: Floats, spacing: float) -> Floats:
    """Return points at equal distances, at most `spacing`, on the lines between some; both ends are included."""
    ways = np.diff(points, axis=0)
    places = np.concatenate(([0.0], np.cumsum(np.sqrt((ways * ways).sum(axis=1)))))
    along = np.linspace(0.0, places[-1], max(math.ceil(places[-1] / spacing), 1) + 1)
    return np.column_stack([np.interp(along, places, points[:, axis]) for axis in (0, 1)])


def rounded(points: Floats, weights: Weights) -> Floats:
    """Return points on rounded corners: each is moved between its neighbours, but into no blocked cell.

    It is the smoothing of Thrun's lecture, which Nav2's smoother has, too. The ends stay.

    Args:
        points: Points at equal distances, as columns and rows of cells: shape (points, 2).
        weights: Cells.
    """
    if len(points) < 3:
        return np.array(points)
    settled = _settled(points)
    if _free(settled, weights).all():
        return settled
    line, found = points[1:-1], np.array(points)
    inner = found[1:-1]
    for _ in range(ROUNDS):
        pull = TO_LINE * (line - inner) + TO_NEIGHBOURS * (found[:-2] + found[2:] - 2.0 * inner)
        moved = inner + pull
        free = _free(np.concatenate((found[:1], moved, found[-1:])), weights)
        inner[free] = moved[free]
    return found


def _settled(points: Floats) -> Floats:
    """Return where the points are after many rounds without obstacles, as sums of neighbours with falling shares."""
    padded = np.pad(points, ((REACH, REACH), (0, 0)), mode="reflect", reflect_type="odd")  # which keeps the ends
    found: Floats = _SHARES[0] * points
    for shift, share in enumerate(_SHARES[1:], 1):
        found += share * (padded[REACH - shift : -REACH - shift] + padded[REACH + shift : len(padded) - REACH + shift])
    found[0], found[-1] = points[0], points[-1]
    return found


def _shares() -> list[float]:
    """Return the shares of a point and of its neighbours, near and far, at which a round moves nothing any more."""
    stays = TO_LINE + 2.0 * TO_NEIGHBOURS
    falls = (stays - math.sqrt(stays * stays - 4.0 * TO_NEIGHBOURS * TO_NEIGHBOURS)) / (2.0 * TO_NEIGHBOURS)
    powers = [falls**each for each in range(REACH + 1)]
    total = powers[0] + 2.0 * math.fsum(powers[1:])
    return [each / total for each in powers]


_SHARES = _shares()


def _free(points: Floats, weights: Weights) -> npt.NDArray[np.bool_]:
    """Return which of the inner points lie in no blocked cell, nor do the middles of the lines to their neighbours."""
    found: npt.NDArray[np.bool_] = _weights_at(points[1:-1], weights) != BLOCKED
    middle = _weights_at((points[1:] + points[:-1]) / 2, weights) != BLOCKED
    found &= middle[1:] & middle[:-1]
    return found
