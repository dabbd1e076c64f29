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
    left, label = set(bins), dict[int, int]()
    for start in bins:
        if start not in left:
            continue
        left.remove(start)
        waiting, count = [start], len(label)
        while waiting:
            bin_ = waiting.pop()
            label[bin_] = count
            near = [each for each in _neighbours(bin_) if each in left]
            left.difference_update(near)
            waiting += near
    return np.array([label[each] for each in bins], np.int64)


def _neighbours(bin_: int) -> list[int]:
    """Return the bins that touch one, and itself; headings go round."""
    turn = bin_ % TURNS
    steps = _STEPS[0] if turn == 0 else _STEPS[2] if turn == TURNS - 1 else _STEPS[1]
    return [bin_ + each for each in steps]


def _steps(turns: tuple[int, int, int]) -> list[int]:
    return [
        (along * _ROW + across) * TURNS + each for along, across, each in itertools.product(_BESIDE, _BESIDE, turns)
    ]


_BESIDE = (-1, 0, 1)
_STEPS = tuple(map(_steps, ((TURNS - 1, 0, 1), _BESIDE, (-1, 0, 1 - TURNS))))
