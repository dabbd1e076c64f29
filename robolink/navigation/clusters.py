"""Clusters of poses: those that lie in neighbouring bins of a histogram belong together, as in AMCL.

Bins are half a metre wide and ten degrees, and neighbours touch, if only at a corner.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from robolink.navigation.grid import Floats, Whole

SIDE = 0.5
"""Side of a bin in metres."""
TURNS = 36
"""Bins of a full turn."""

_ROW = 1 << 20  # far more bins along y than any map has


def _bins(poses: Floats) -> Whole:
    """Return the number of the bin of each pose, given as rows x, y, heading."""
    column, row = (np.floor(poses[each] / SIDE).astype(np.int64) for each in (0, 1))
    turn = np.floor(poses[2] * (TURNS / math.tau)).astype(np.int64) % TURNS
    found: Whole = (column * _ROW + row + _ROW // 2) * TURNS + turn
    return found


def count_bins(poses: Floats) -> int:
    """Return how many bins have poses in them; poses are rows x, y, heading."""
    return len(np.unique(_bins(poses)))


def best_cluster(poses: Floats, weights: Floats) -> Whole:
    """Return the indices of the poses in the cluster that has the most weight; poses are rows x, y, heading."""
    bins, member = np.unique(_bins(poses), return_inverse=True)
    labels = _labels(bins.tolist())
    of_pose = labels[member.ravel()]
    heavy = np.bincount(of_pose, weights)
    members: Whole = np.flatnonzero(of_pose == heavy.argmax())
    return members


def _labels(bins: list[int]) -> Whole:
    """Return the number of the cluster of each bin."""
    index = {each: place for place, each in enumerate(bins)}
    labels = np.full(len(bins), -1, np.int64)
    count = 0
    for start in range(len(bins)):
        if labels[start] >= 0:
            continue
        labels[start], waiting = count, [bins[start]]
        while waiting:
            for near in _neighbours(waiting.pop()):
                place = index.get(near)
                if place is not None and labels[place] < 0:
                    labels[place] = count
                    waiting.append(near)
        count += 1
    return labels


def _neighbours(bin_: int) -> list[int]:
    """Return the bins that touch one; headings go round."""
    place, turn = divmod(bin_, TURNS)
    turns = ((turn - 1) % TURNS, turn, (turn + 1) % TURNS)
    return [(place + along * _ROW + across) * TURNS + each for along, across, each in _around(turns)]


def _around(turns: tuple[int, int, int]) -> list[tuple[int, int, int]]:
    return list(itertools.product((-1, 0, 1), (-1, 0, 1), turns))
