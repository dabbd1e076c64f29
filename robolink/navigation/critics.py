"""Critics of rollouts: each finds one fault with many ways to drive on, as costs whose sum decides.

They are those of Nav2's MPPI controller, and so are their fields, the parameters of each, with their defaults.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose
from robolink.navigation.footprint import FREE, INSCRIBED, LETHAL, UNKNOWN, highest_costs
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.local_path import LocalPath
from robolink.navigation.movers import Mover
from robolink.navigation.singles import F, Singles, summed

TURN = F(2 * math.pi)
_NEARER = 0.01
"""Metres by which a robot that is too near to an obstacle may get nearer yet, on its way out."""


class Surroundings(NamedTuple):
    """Surroundings of the robot: a costmap, and the obstacles that move."""

    costs: Grid
    outline: Floats = np.empty((0, 2))
    """Points of the footprint, as from `footprint.cover`; none if its centre decides."""
    possible: float = INSCRIBED
    """Cost of a centre from which on the footprint may touch an obstacle."""
    movers: Sequence[Mover] = ()
    """Obstacles that move, with the robot's radius added to theirs."""


class Batch(NamedTuple):
    """Many ways to drive on, each a column: where the robot is after each step, by rows, and how fast it is then."""

    x: Singles
    y: Singles
    theta: Singles
    v: Singles
    w: Singles
    dt: float
    """Seconds of a step."""
    start: Pose
    path: LocalPath
    is_clear: npt.NDArray[np.bool_]
    """Which points of the path lie on cells where the robot can stand."""
    furthest: int
    """Index of the furthest point of the path that a rollout reaches."""
    goal: Pose
    around: Surroundings

    def is_near_goal(self, distance: float) -> bool:
        """Return whether the robot is nearer to the goal than `distance` metres."""
        return math.hypot(self.start.x - self.goal.x, self.start.y - self.goal.y) < distance


class Judgement(NamedTuple):
    """Judgement of a critic about a batch: a cost for each rollout, and which of them collide."""

    costs: Singles
    collides: npt.NDArray[np.bool_] | None = None


@dataclass(frozen=True)
class Critic:
    """One critic: its costs are multiplied by `cost_weight`, then raised to `cost_power`."""

    enabled: bool = True
    cost_power: int = 1
    cost_weight: float = 1.0

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the costs of a batch; None if there is nothing to say of it now."""
        raise NotImplementedError

    def _weighted(self, costs: Singles, collides: npt.NDArray[np.bool_] | None = None) -> Judgement:
        costs = costs * F(self.cost_weight)
        return Judgement(costs if self.cost_power == 1 else costs**self.cost_power, collides)


@dataclass(frozen=True)
class CostCritic(Critic):
    """Costs of the cells on the way: an obstacle ends it, nearness costs."""

    cost_weight: float = 3.81
    critical_cost: float = 300.0
    near_collision_cost: int = 253
    collision_cost: float = 1_000_000.0
    near_goal_distance: float = 0.5
    trajectory_point_step: int = 2
    consider_footprint: bool = False

    def judge(self, batch: Batch) -> Judgement:
        """Return the costs; a rollout that starts where nothing may stand collides only if it gets deeper in."""
        step = max(1, self.trajectory_point_step)
        found = costs_at(batch.around.costs, batch.x[::step], batch.y[::step])
        hits = obstructed(batch.around.costs, batch.start, batch.x[::step], batch.y[::step], found)
        if self.consider_footprint and len(batch.around.outline):
            hits |= self._touches(batch, found, step)
        collides = np.asarray(hits.any(axis=0))
        costs = found.astype(F)
        if batch.is_near_goal(self.near_goal_distance):
            costs[found < self.near_collision_cost] = 0.0
        costs[found >= self.near_collision_cost] = self.critical_cost
        total = costs.sum(axis=0, dtype=F) / F(254.0 * len(found))
        total[collides] += F(self.collision_cost / (254.0 * len(found)))
        return self._weighted(total, collides)

    def _touches(self, batch: Batch, found: npt.NDArray[np.uint8], step: int) -> npt.NDArray[np.bool_]:
        """Return where the outline touches an obstacle: it is looked at where the centre's cost makes it possible."""
        touches = np.zeros(found.shape, bool)
        near = (found >= batch.around.possible) & (found < INSCRIBED)
        near[1::2] = False  # each second sample is enough for an outline, which is long
        poses = np.stack([each[::step][near] for each in (batch.x, batch.y, batch.theta)], axis=1)
        touches[near] = (
            highest_costs(batch.around.costs, batch.around.outline, poses.astype(np.float64), FREE) >= LETHAL
        )
        return touches


@dataclass(frozen=True)
class GoalCritic(Critic):
    """Distance to the goal, once the robot is near it."""

    cost_weight: float = 5.0
    threshold_to_consider: float = 1.4

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the mean distance in metres times the weight."""
        if not batch.is_near_goal(self.threshold_to_consider):
            return None
        dx, dy = batch.x[::2] - F(batch.goal.x), batch.y[::2] - F(batch.goal.y)
        return self._weighted(np.sqrt(dx * dx + dy * dy).mean(axis=0, dtype=F))


@dataclass(frozen=True)
class GoalAngleCritic(Critic):
    """Difference to the heading of the goal, once the robot is at it."""

    cost_weight: float = 3.0
    threshold_to_consider: float = 0.5

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the mean difference in radians times the weight."""
        if not batch.is_near_goal(self.threshold_to_consider):
            return None
        return self._weighted(turned(batch.theta[::2], batch.goal.theta).mean(axis=0, dtype=F))


@dataclass(frozen=True)
class PathAlignCritic(Critic):
    """Distance from the path, point for point at the same length of way."""

    cost_weight: float = 10.0
    max_path_occupancy_ratio: float = 0.07
    offset_from_furthest: int = 20
    trajectory_point_step: int = 4
    threshold_to_consider: float = 0.5
    use_path_orientations: bool = False

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the mean distance in metres times the weight; None where much of the path is obstructed."""
        if batch.is_near_goal(self.threshold_to_consider) or batch.furthest < self.offset_from_furthest:
            return None
        blocked = int((~batch.is_clear[: batch.furthest]).sum())
        if blocked > 2 and blocked > self.max_path_occupancy_ratio * batch.furthest:
            return None
        step = max(1, self.trajectory_point_step)
        ways = summed(np.abs(batch.v[: len(batch.v) // step * step]) * F(batch.dt))[step - 1 :: step]
        index = np.minimum((ways * F(1 / batch.path.spacing) + F(0.5)).astype(np.intp), batch.furthest)
        dx = batch.x[step - 1 :: step] - batch.path.x.astype(F).take(index)
        dy = batch.y[step - 1 :: step] - batch.path.y.astype(F).take(index)
        squares = dx * dx + dy * dy
        if self.use_path_orientations:
            angles = turned(batch.theta[step - 1 :: step], batch.path.theta.astype(F).take(index))
            squares += angles * angles
        return self._weighted(np.sqrt(squares).mean(axis=0, dtype=F))


@dataclass(frozen=True)
class PathFollowCritic(Critic):
    """Metres of the path from where a rollout ends to a point a little beyond what can be reached: it leads on.

    They count along the path, and not straight as in Nav2, which leads into the corner before a gap; what the end is
    off the path is added.
    """

    cost_weight: float = 5.0
    offset_from_furthest: int = 6
    threshold_to_consider: float = 1.4

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the metres times the weight."""
        path = batch.path
        if len(path.x) < 2 or path.length < self.threshold_to_consider:
            return None
        last = len(path.x) - 1
        index = min(batch.furthest + self.offset_from_furthest, last)
        clear = np.flatnonzero(batch.is_clear[index:])
        index = index + int(clear[0]) if len(clear) else last
        x, y = path.x[index::-2].astype(F), path.y[index::-2].astype(F)
        dx, dy = batch.x[-1] - x[:, None], batch.y[-1] - y[:, None]
        squares = dx * dx + dy * dy
        nearest = squares.argmin(axis=0)
        off = np.sqrt(squares.min(axis=0))
        return self._weighted(off + nearest.astype(F) * F(2 * path.spacing))


@dataclass(frozen=True)
class PathAngleCritic(Critic):
    """Heading away from the path at a rollout's end, while the robot looks away from it."""

    cost_weight: float = 2.2
    offset_from_furthest: int = 4
    threshold_to_consider: float = 0.5
    max_angle_to_furthest: float = 0.785398

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the angle in radians between the heading and the way to the path, times the weight."""
        if batch.path.length < self.threshold_to_consider:
            return None
        index = min(batch.furthest + self.offset_from_furthest, len(batch.path.x) - 1)
        x, y = float(batch.path.x[index]), float(batch.path.y[index])
        bearing = math.atan2(y - batch.start.y, x - batch.start.x)
        if abs(math.remainder(bearing - batch.start.theta, 2 * math.pi)) < self.max_angle_to_furthest:
            return None
        ways = np.arctan2(F(y) - batch.y[-1], F(x) - batch.x[-1])
        return self._weighted(turned(batch.theta[-1], ways))


@dataclass(frozen=True)
class PreferForwardCritic(Critic):
    """Metres driven backwards."""

    cost_weight: float = 5.0
    threshold_to_consider: float = 0.5

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the metres times the weight."""
        if batch.path.length < self.threshold_to_consider:
            return None
        return self._weighted(np.maximum(-batch.v, F(0)).sum(axis=0, dtype=F) * F(batch.dt))


@dataclass(frozen=True)
class MoversCritic(Critic):
    """Nearness to where moving obstacles will be, if they go on as they do. Nav2 has none of this kind."""

    cost_weight: float = 50.0
    margin: float = 0.1
    """Metres of distance from a mover that are free of cost."""
    spread: float = 0.05
    """Metres by which the margin grows in a second, since nobody knows what a person will do."""

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the cost: the greatest depth in a margin, as a share of it and 1 at contact, plus what is deeper."""
        if not batch.around.movers:
            return None
        x, y = batch.x[1::2], batch.y[1::2]
        times = (np.arange(len(x), dtype=F) * F(2) + F(2)) * F(batch.dt)
        margin = (F(self.margin) + times * F(self.spread))[:, None]
        worst = np.zeros(x.shape[1], F)
        for each in batch.around.movers:
            dx, dy = x - (F(each.x) + times * F(each.vx))[:, None], y - (F(each.y) + times * F(each.vy))[:, None]
            gap = np.sqrt(dx * dx + dy * dy) - F(each.radius)
            depth = np.maximum(F(1) - gap / margin, F(0)) * (F(1) / (F(1) + times))[:, None]
            worst += depth.max(axis=0) + depth.mean(axis=0)
        return self._weighted(worst)


@dataclass(frozen=True)
class TwirlingCritic(Critic):
    """Turning as such."""

    cost_weight: float = 10.0

    def judge(self, batch: Batch) -> Judgement | None:
        """Return the mean turning speed in rad/s times the weight."""
        return self._weighted(np.abs(batch.w).mean(axis=0, dtype=F))


def turned(angles: Singles, to: Any) -> Singles:
    """Return how far angles are from others, in radians from 0 to pi."""
    off = angles - np.asarray(to, F)
    distance: Singles = np.abs(off - TURN * np.rint(off * F(1 / TURN)))
    return distance


def costs_at(costs: Grid, x: Singles, y: Singles) -> npt.NDArray[np.uint8]:
    """Return the costs of the cells in which points lie; `UNKNOWN` off the costmap, whose origin is not turned."""
    height, width = costs.cells.shape
    scale = F(1 / costs.resolution)
    row = (y - F(costs.origin[1])) * scale
    column = (x - F(costs.origin[0])) * scale
    # A margin of unknown cells on all sides takes what lies off the costmap.
    framed = np.full((height + 2, width + 2), UNKNOWN, np.uint8)
    framed[1:-1, 1:-1] = costs.cells
    np.clip(row, F(-1), F(height), out=row)
    np.clip(column, F(-1), F(width), out=column)
    row += F(1)
    column += F(1)
    index = row.astype(np.int32)
    index *= width + 2
    index += column.astype(np.int32)
    found: npt.NDArray[np.uint8] = framed.ravel().take(index)
    return found


def obstructed(costs: Grid, start: Pose, x: Singles, y: Singles, found: npt.NDArray[np.uint8]) -> npt.NDArray[np.bool_]:
    """Return where the robot would be in an obstacle, or nearer to one than its radius allows.

    A robot that starts too near to an obstacle, since that came to it, may go wherever it gets no nearer: otherwise it
    would never get free.

    Args:
        costs: Costmap.
        start: Where the robot is now.
        x: Places in metres.
        y: Places in metres.
        found: Costs of these places, from `costs_at`.
    """
    limit = F(INSCRIBED)
    at_start = int(costs_at(costs, np.array([start.x], F), np.array([start.y], F))[0])
    row, column = np.nonzero(costs.cells == LETHAL)
    nearer = np.zeros(found.shape, bool)
    if at_start == INSCRIBED and len(row):
        limit = F(LETHAL)
        px, py = costs.cell_to_world(row, column)
        off = np.hypot(px - start.x, py - start.y)
        near = int(off.argmin())
        dx, dy = x - F(px[near]), y - F(py[near])
        nearer = np.asarray(dx * dx + dy * dy < F(max(off[near] - _NEARER, 0.0) ** 2))
    return np.asarray(((found >= limit) & (found != UNKNOWN)) | nearer)


USUAL: tuple[Critic, ...] = (
    CostCritic(),
    GoalCritic(),
    GoalAngleCritic(),
    PathAlignCritic(),
    PathFollowCritic(),
    PathAngleCritic(),
    PreferForwardCritic(),
    MoversCritic(),
)
"""The critics that Nav2 uses unless it is given others; limits are met by all rollouts, so none is needed for them."""
