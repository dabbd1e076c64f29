"""Planning: a path for a robot through a costmap, from where it is to a goal, or the reason why there is none."""

from __future__ import annotations

import math
from enum import Enum
from typing import NamedTuple

import numpy as np

from robolink.exceptions import RobolinkError
from robolink.geometry.plane import Pose
from robolink.navigation.costmap import Costs
from robolink.navigation.footprint import INSCRIBED, LETHAL, UNKNOWN
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.search import BLOCKED, DEAREST, Cell, Weights, cheapest_way, reachable
from robolink.navigation.smoothing import rounded, shortened, spaced
from robolink.navigation.tracing import Span, trace

ESCAPE = 1.0
"""Metres within which a robot that stands too near to an obstacle is led to a free cell."""


class Failure(Enum):
    """Reason why there is no path, by the names that Nav2's actions have for their error codes."""

    START_OUTSIDE_MAP = 1
    GOAL_OUTSIDE_MAP = 2
    START_OCCUPIED = 3
    GOAL_OCCUPIED = 4
    NO_VALID_PATH = 5


class PlanError(RobolinkError, ValueError):
    """There is no path. `failure` is the reason."""

    def __init__(self, failure: Failure, text: str) -> None:
        super().__init__(text)
        self.failure = failure


class PlanOptions(NamedTuple):
    """Options of a plan.

    Attributes:
        tolerance: Distance in metres from the goal within which the path may end, if the goal is out of reach.
        allow_unknown: True leads through unknown cells, too, which are as dear as the dearest.
        slope: What a cell of the cost 252 costs more than a free one, as a multiple of that. NavFn has 4.032.
        final_approach: True ends with the heading of the path instead of the goal's.
    """

    tolerance: float = 0.5
    allow_unknown: bool = True
    slope: float = 0.8 * 252 / 50
    final_approach: bool = False


def plan(costs: Grid, start: Pose, goal: Pose, options: PlanOptions | None = None) -> Floats:
    """Return a path as rows of x, y and theta: poses at most a cell apart, from the start to the goal.

    No pose but the first ones of a robot that starts too near to an obstacle lies in a cell of the cost 253 or more.

    Args:
        costs: Costmap, with cells from 0 to 255.
        start: Pose of the robot in the frame of the costmap.
        goal: Pose to go to.
        options: How.

    Raises:
        PlanError: if there is no path.
    """
    options = options or PlanOptions()
    first, last = _cell(costs, start), _cell(costs, goal)
    for cell, pose, failure in ((first, start, Failure.START_OUTSIDE_MAP), (last, goal, Failure.GOAL_OUTSIDE_MAP)):
        if cell is None:
            height, width = costs.cells.shape
            raise PlanError(failure, f"({pose.x:.2f}, {pose.y:.2f}) is outside of the map of {width} x {height} cells")
    assert first is not None
    assert last is not None
    weights = weights_of(costs.cells, allow_unknown=options.allow_unknown)
    begin = _passable_start(costs, weights, first, start)
    within = reachable(weights != BLOCKED, begin)
    end = _reachable_end(costs, within, last, goal, options.tolerance)
    way = cheapest_way(np.where(within, weights, np.uint8(BLOCKED)), begin, end, options.slope)
    if way is None:  # what is within reach has a way
        raise PlanError(Failure.NO_VALID_PATH, f"no way from {begin} to {end}")
    points = np.array(way, np.float64)[:, ::-1] + 0.5
    if begin == first:
        points[0] = _in_cells(costs, start)
    if end == last:
        points[-1] = _in_cells(costs, goal)
    points = rounded(spaced(shortened(points, weights, options.slope), 1.0), weights)
    if begin != first:
        points = np.concatenate((spaced(np.array([_in_cells(costs, start), points[0]]), 1.0)[:-1], points))
    return _poses(costs, points, start, goal, options)


def weights_of(costs: Costs, *, allow_unknown: bool) -> Weights:
    """Return the weights of a costmap's cells: obstacles and cells too near to them are blocked."""
    table = np.arange(256, dtype=np.uint8)
    table[INSCRIBED:] = BLOCKED
    table[UNKNOWN] = DEAREST if allow_unknown else BLOCKED
    found: Weights = table[costs]
    return found


def _cell(costs: Grid, pose: Pose) -> Cell | None:
    """Return the cell in which a pose lies, None off the map."""
    row, column = map(int, costs.world_to_cell(pose.x, pose.y))
    return (row, column) if costs.contains(row, column) else None


def _passable_start(costs: Grid, weights: Weights, cell: Cell, start: Pose) -> Cell:
    """Return the cell from which the path is searched: the start's, or a free one near by in a straight line."""
    if weights[cell] != BLOCKED:
        return cell
    where = f"the start ({start.x:.2f}, {start.y:.2f})"
    if costs.cells[cell] == LETHAL:
        raise PlanError(Failure.START_OCCUPIED, f"{where} is in an obstacle")
    for row, column in _nearest(weights != BLOCKED, cell, ESCAPE / costs.resolution):
        line = trace(weights.shape, cell, np.array([row]), np.array([column]), Span(0, math.inf))
        if not (costs.cells.ravel()[line] == LETHAL).any():
            return row, column
    raise PlanError(Failure.START_OCCUPIED, f"{where} is too near to an obstacle, and no free cell within {ESCAPE:g} m")


def _nearest(chosen: Weights | np.ndarray, cell: Cell, distance: float) -> list[Cell]:
    """Return the chosen cells within a distance in cells of a cell, the nearest first."""
    reach = math.ceil(min(distance, sum(chosen.shape)))
    bottom, left = max(cell[0] - reach, 0), max(cell[1] - reach, 0)
    rows, columns = np.nonzero(chosen[bottom : cell[0] + reach + 1, left : cell[1] + reach + 1])
    rows, columns = rows + bottom, columns + left
    squares = (rows - cell[0]) ** 2 + (columns - cell[1]) ** 2
    order = np.argsort(squares, kind="stable")
    order = order[squares[order] <= distance * distance]
    return list(zip(rows[order].tolist(), columns[order].tolist(), strict=True))


def _reachable_end(costs: Grid, within: np.ndarray, cell: Cell, goal: Pose, tolerance: float) -> Cell:
    """Return the goal's cell if it is within reach, or the nearest one that is."""
    if within[cell]:
        return cell
    if near := _nearest(within, cell, tolerance / costs.resolution):
        return near[0]
    where = f"the goal ({goal.x:.2f}, {goal.y:.2f})"
    aside = f"and no cell within the tolerance of {tolerance:g} m is within reach"
    cost = costs.cells[cell]
    if cost in (LETHAL, INSCRIBED):
        reason = "is in an obstacle" if cost == LETHAL else "is too near to an obstacle"
        raise PlanError(Failure.GOAL_OCCUPIED, f"{where} {reason}, {aside}")
    raise PlanError(Failure.NO_VALID_PATH, f"no way leads to {where}, {aside}")


def _in_cells(costs: Grid, pose: Pose) -> tuple[float, float]:
    """Return the place of a pose as column and row and parts of them."""
    dx, dy = pose.x - costs.origin[0], pose.y - costs.origin[1]
    cos, sin = math.cos(costs.origin[2]), math.sin(costs.origin[2])
    return (cos * dx + sin * dy) / costs.resolution, (cos * dy - sin * dx) / costs.resolution


def _poses(costs: Grid, points: Floats, start: Pose, goal: Pose, options: PlanOptions) -> Floats:
    """Return points in cells as poses, with headings along the path."""
    x, y = costs.cell_to_world(points[:, 1] - 0.5, points[:, 0] - 0.5)
    up, right = np.diff(y), np.diff(x)
    # Not numpy's arctan2, whose last bits are those of the processor.
    headings = [math.atan2(*each) for each in zip(up.tolist(), right.tolist(), strict=True)]
    if not (up.any() or right.any()):
        return np.array([(goal.x, goal.y, start.theta if options.final_approach else goal.theta)])
    last = headings[-1] if options.final_approach else goal.theta
    return np.column_stack((x, y, np.append(headings, last)))
