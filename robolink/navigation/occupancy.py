"""Occupancy grids from lidar scans: in how many beams a cell was passed, and in how many it was hit.

A cell that enough beams came to is occupied if a tenth of them ended in it, else free, as Karto has it. Scans can be
taken out again, so that one that moved is drawn anew without all the others.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose
from robolink.navigation.grid import Floats, Grid

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""Values of cells, as a nav_msgs/msg/OccupancyGrid has them."""
_GROWTH = 64
"""Cells by which the arrays grow beyond what is needed, so that not each scan makes them grow."""


class Beams(NamedTuple):
    """Beams of one scan in the frame of the robot.

    `ends` are where the beams ended, in metres, as rows; the first `hits` of them ended at something, the others passed
    that place. `origin` is where they began: the place of the lidar.
    """

    ends: Floats
    hits: int
    origin: tuple[float, float] = (0.0, 0.0)

    @property
    def points(self) -> Floats:
        """The places where beams ended at something."""
        return self.ends[: self.hits]


class Lidar(NamedTuple):
    """Mount of a lidar on the robot: its place in metres, and the upper left part of its rotation matrix."""

    place: tuple[float, float] = (0.0, 0.0)
    turn: Floats = np.eye(2)


def beams_of(
    ranges: npt.ArrayLike, angles: npt.ArrayLike, limits: tuple[float, float], used: float, lidar: Lidar
) -> Beams:
    """Return the beams of a scan; those that came back from nowhere, from too near or as NaN are left out.

    Args:
        ranges: Distances in metres.
        angles: Directions of the beams in the frame of the lidar, in radians, as many.
        limits: Least and largest distance that the lidar measures; at these and beyond nothing was measured.
        used: Distance in metres from which on a beam only says that the way up to there is free.
        lidar: Its mount on the robot.
    """
    far, angle = np.asarray(ranges, np.float64), np.asarray(angles, np.float64)
    measured = (far > limits[0]) & (far < limits[1])  # NaN is neither
    far, angle = far[measured], angle[measured]
    order = np.argsort(far >= used, kind="stable")
    hits = int((far < used).sum())
    far, angle = np.minimum(far, used)[order], angle[order]
    x, y = far * np.cos(angle), far * np.sin(angle)
    turn, place = lidar.turn, lidar.place
    ends = np.column_stack((turn[0, 0] * x + turn[0, 1] * y + place[0], turn[1, 0] * x + turn[1, 1] * y + place[1]))
    return Beams(ends, hits, place)


class Occupancy:
    """Counts of beams in cells, which grow with what is seen.

    Args:
        resolution: Side of a cell in metres.
        min_pass_through: Beams through a cell that are too few to say anything of it.
        occupancy_threshold: Share of a cell's beams above which it is occupied if they ended in it.
        most_cells: Cells of width times height that the map may have; a scan that would need more is refused.
    """

    def __init__(
        self,
        resolution: float = 0.05,
        *,
        min_pass_through: int = 2,
        occupancy_threshold: float = 0.1,
        most_cells: int = 25_000_000,
    ) -> None:
        self.resolution, self.min_pass_through = resolution, min_pass_through
        self.occupancy_threshold, self.most_cells = occupancy_threshold, most_cells
        self._corner: tuple[int, int] | None = None
        self._passes = self._hits = np.zeros((0, 0), np.int32)

    def add(self, pose: Pose, beams: Beams, times: int = 1) -> bool:
        """Draw a scan; return False if it is too far from the others for one map, and was left out.

        Args:
            pose: Where the robot was.
            beams: What its lidar measured.
            times: 1, or -1 to take the same scan from the same pose out again.
        """
        if not len(beams.ends):
            return True
        begin, ends = self._cells(pose, beams)
        low, high = np.minimum(ends.min(axis=0), begin), np.maximum(ends.max(axis=0), begin)
        if not self._reaches(np.floor(low).astype(np.int64), np.floor(high).astype(np.int64)):
            return False
        assert self._corner is not None
        corner = np.array(self._corner)
        passed = _traced(begin - corner, ends - corner, self._passes.shape[1])
        hit = np.floor(ends[: beams.hits] - corner).astype(np.int64)
        hit_cells = hit[:, 1] * self._passes.shape[1] + hit[:, 0]
        _count(self._passes, np.concatenate((passed, hit_cells)), times)
        _count(self._hits, hit_cells, times)
        return True

    def remove(self, pose: Pose, beams: Beams) -> None:
        """Take out a scan that was drawn from this very pose."""
        self.add(pose, beams, -1)

    def _cells(self, pose: Pose, beams: Beams) -> tuple[Floats, Floats]:
        """Return where beams begin and end, in cells from the origin of the map."""
        cos, sin = math.cos(pose.theta), math.sin(pose.theta)
        local = np.vstack(([beams.origin], beams.ends))
        x = pose.x + cos * local[:, 0] - sin * local[:, 1]
        y = pose.y + sin * local[:, 0] + cos * local[:, 1]
        places = np.column_stack((x, y)) / self.resolution
        return places[0], places[1:]

    def _reaches(self, low: npt.NDArray[np.int64], high: npt.NDArray[np.int64]) -> bool:
        """Make the arrays hold the cells from `low` to `high` (column, row); return False if that is too much."""
        height, width = self._passes.shape
        before = low if self._corner is None else np.array(self._corner)
        after = before + np.array([width, height])
        if self._corner is not None and (low >= before).all() and (high < after).all():
            return True
        corner = np.where(low < before, low - _GROWTH, before) if self._corner is not None else low - _GROWTH
        end = np.where(high >= after, high + _GROWTH, after) if self._corner is not None else high + _GROWTH
        columns, rows = (end - corner).tolist()
        if columns * rows > self.most_cells:
            return False
        left, below = (before - corner).tolist()
        for name in ("_passes", "_hits"):
            grown = np.zeros((rows, columns), np.int32)
            grown[below : below + height, left : left + width] = getattr(self, name)
            setattr(self, name, grown)
        self._corner = (int(corner[0]), int(corner[1]))
        return True

    def grid(self) -> Grid:
        """Return the map of what was seen, without the margins where nothing was: int8 cells of the values above."""
        rows, columns = (np.flatnonzero(self._passes.any(axis=axis)) for axis in (1, 0))
        if not len(rows) or self._corner is None:
            return Grid(np.full((0, 0), UNKNOWN, np.int8), self.resolution)
        part = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
        passes, hits = self._passes[part], self._hits[part]
        cells = np.where(hits > self.occupancy_threshold * passes, np.int8(OCCUPIED), np.int8(FREE))
        cells[passes <= self.min_pass_through] = UNKNOWN
        x, y = (self._corner[0] + int(columns[0])) * self.resolution, (self._corner[1] + int(rows[0])) * self.resolution
        return Grid(cells, self.resolution, (x, y, 0.0))


def _traced(begin: Floats, ends: Floats, width: int) -> npt.NDArray[np.int64]:
    """Return the numbers of the cells that beams pass before those in which they end, one for each step and beam."""
    way = ends - begin
    steps = np.maximum(np.abs(way).max(axis=1), 1e-9)
    counts = (1.01 * steps).astype(np.int64) + 1  # less than a cell apart, whatever the rounding
    beam = np.repeat(np.arange(len(ends)), counts)
    number = np.arange(len(beam)) - np.repeat(np.cumsum(counts) - counts, counts)
    share = (number / counts[beam]).astype(np.float32)
    column = (begin[0] + share * way[beam, 0].astype(np.float32)).astype(np.int64)
    row = (begin[1] + share * way[beam, 1].astype(np.float32)).astype(np.int64)
    cells = row * width + column
    last = np.floor(ends).astype(np.int64)
    fits = cells != (last[:, 1] * width + last[:, 0])[beam]
    fits[1:] &= (cells[1:] != cells[:-1]) | (number[1:] == 0)  # a beam counts once
    found: npt.NDArray[np.int64] = cells[fits]
    return found


def _count(counts: npt.NDArray[np.int32], cells: npt.NDArray[np.int64], times: int) -> None:
    """Add `times` to the count of each cell, as often as it is named."""
    if not len(cells):
        return
    low, high = int(cells.min()), int(cells.max()) + 1
    counts.reshape(-1)[low:high] += times * np.bincount(cells - low, minlength=high - low).astype(np.int32)
