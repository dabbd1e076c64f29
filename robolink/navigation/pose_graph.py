"""Pose graph: poses with measured relations between them, and the poses that agree best with all of these.

Each pose is tied to the one before it, and some to earlier ones (loops). With small motions written as twists about one
point of the plane, an edge's error depends on the difference of its two ends alone, so the linear problem is that of a
network of resistors: edges in series add their covariances. Chains between loops become single edges that way,
and what is solved is as large as the number of loops, not of poses. Wrong loops are found by graduated non-convexity
(Yang et al., Graduated non-convexity for robust spatial perception, RA-L 2020): all are believed at first, then less
and less those that contradict the others.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from robolink.geometry.plane import Pose, seen_from, wrapped
from robolink.navigation.grid import Floats

BELIEVED = 11.3
"""Squared error, by its covariance, above which a loop is doubted: 1 % of true ones have a larger one (chi², 3)."""
_ROUNDS = 12
_SMALL = 1e-9
_FAR = 1e6


class Loop(NamedTuple):
    """A relation between poses that do not follow each other.

    `relative` is the pose `target` as seen from the pose `source`, `covariance` that of its x, y (metres) and heading
    (radians), in the frame of `source`. `weight` is how much it is believed, from 0 to 1, by the last `optimize`.
    """

    source: int
    target: int
    relative: Pose
    covariance: Floats
    weight: float = 1.0


class PoseGraph:
    """Poses and the relations between them. The first pose stays where it is.

    `poses` are the present estimates as rows of x, y and heading; `loops` the relations of poses that do not follow
    each other.
    """

    def __init__(self) -> None:
        self.poses: Floats = np.empty((0, 3))
        self.loops: list[Loop] = []
        self._steps: Floats = np.empty((0, 3))
        self._covariances: Floats = np.empty((0, 3, 3))

    def __len__(self) -> int:
        return len(self.poses)

    def pose(self, number: int) -> Pose:
        """Return the estimate of a pose."""
        return Pose(*self.poses[number].tolist())

    @property
    def steps(self) -> tuple[Floats, Floats]:
        """Measured steps from each pose to the next, and their covariances in the frame of the earlier pose."""
        return self._steps, self._covariances

    def add(self, pose: Pose, covariance: Floats) -> int:
        """Add a pose after the last one, and return its number.

        Args:
            pose: Its estimate.
            covariance: That of the step from the last pose to this one, in the frame of the last; not used for the
                first pose.
        """
        if len(self.poses):
            step = seen_from(self.pose(-1), pose)
            self._steps = np.vstack((self._steps, [step]))
            self._covariances = np.concatenate((self._covariances, [np.asarray(covariance, np.float64)]))
        self.poses = np.vstack((self.poses, [pose]))
        return len(self.poses) - 1

    def restore(self, poses: Floats, steps: Floats, covariances: Floats, loops: Iterable[Loop]) -> None:
        """Take over what another graph had: its poses, its steps with their covariances, and its loops."""
        self.poses, self._steps, self._covariances = poses, steps, covariances
        self.loops = list(loops)

    def link(self, source: int, target: int, relative: Pose, covariance: Floats) -> None:
        """Add a loop: the pose `target` as it was seen from the pose `source`, with its covariance there."""
        self.loops.append(Loop(source, target, relative, np.asarray(covariance, np.float64)))

    def unlink(self) -> None:
        """Remove the last loop."""
        self.loops.pop()

    def relative_covariance(self, source: int, target: int) -> Floats:
        """Return how uncertain the pose `target` is as seen from the pose `source`, by all that is believed.

        It is the covariance of x, y (metres) and heading (radians), in the frame of `source`. Poses a million metres
        apart are more than numbers can hold: then it is that of not knowing.
        """
        try:
            return self._relative_covariance(source, target)
        except np.linalg.LinAlgError:
            return np.diag([_FAR**2, _FAR**2, math.pi**2])

    def _relative_covariance(self, source: int, target: int) -> Floats:
        system = _System(self, self.loops, [source, target])
        information = system.information([each.weight for each in self.loops])
        first, second = system.place(source), system.place(target)
        columns = np.zeros((len(information), 3))
        for place, sign in ((first, -1.0), (second, 1.0)):
            if place:
                columns[3 * place - 3 : 3 * place] += sign * np.eye(3)
        twist = columns.T @ np.linalg.solve(information, columns) if len(columns) else np.zeros((3, 3))
        jacobian = _jacobians(self.poses, system.centre, np.array([source]), np.array([target]))[0]
        return np.asarray(jacobian @ twist @ jacobian.T)

    def surprise(self, source: int, target: int, relative: Pose, covariance: Floats) -> float:
        """Return the squared error of a loop that is not added yet, by its covariance and that of the way between.

        It is chi² with three degrees of freedom where the loop and all covariances are true.
        """
        gap = _errors(self.poses, np.array([source]), np.array([target]), np.array([relative]))
        spread = self.relative_covariance(source, target) + covariance
        return float(_squares(gap, spread[None])[0])

    def optimize(self, believed: float = BELIEVED) -> float:
        """Move the poses to where they agree best with all steps and loops, and set the loops' weights.

        Args:
            believed: Squared error of a loop above which it is doubted.

        Returns:
            The largest way that a pose was moved, in metres.
        """
        before = self.poses
        try:
            weights = self._agreed(believed)
        except np.linalg.LinAlgError:  # poses a million metres apart are more than numbers can hold
            self.poses = before
            return 0.0
        self.loops = [each._replace(weight=weight) for each, weight in zip(self.loops, weights.tolist(), strict=True)]
        return float(np.hypot(*(self.poses - before)[:, :2].T).max()) if len(before) else 0.0

    def _agreed(self, believed: float) -> Floats:
        """Move the poses to where they agree best; return how much each loop is believed."""
        weights = np.ones(len(self.loops))
        if not self.loops:
            return weights
        self._settle(weights)
        largest = float(self.errors().max())
        doubt = max(1.0, 2.0 * largest / believed)
        while largest > believed:  # else all are believed, and there is nothing to find
            doubt = max(doubt / 1.6, 1.0)
            weights = np.square(doubt * believed / (doubt * believed + self.errors()))
            self._settle(weights, rounds=3)
            if doubt == 1.0:
                break
        return weights

    def _settle(self, weights: Floats, rounds: int = _ROUNDS) -> None:
        """Take Gauss-Newton steps until the poses stay where they are; a step that makes it worse is halved."""
        cost = self._cost(self.poses, weights)
        for _ in range(rounds):
            system = _System(self, self.loops)
            twists, share = system.twists(weights), 1.0
            while share > 0.01:
                moved = _moved(self.poses, system.centre, share * twists)
                found = self._cost(moved, weights)
                if found <= cost + _SMALL:
                    break
                share /= 2.0
            else:
                return
            gain, cost, self.poses = cost - found, found, moved
            if gain < 1e-6 * (1.0 + cost):
                return

    def _cost(self, poses: Floats, weights: Floats) -> float:
        numbers = np.arange(len(self._steps))
        chain = _errors(poses, numbers, numbers + 1, self._steps)
        return float(_squares(chain, self._covariances).sum() + (weights * self._loop_errors(poses)).sum())

    def _loop_errors(self, poses: Floats) -> Floats:
        source, target, relative, covariances = _columns(self.loops)
        return _squares(_errors(poses, source, target, relative), covariances)

    def errors(self) -> Floats:
        """Return the squared error of each loop by its covariance."""
        return self._loop_errors(self.poses)


class _System:
    """The linear problem at the present poses, with the chains between its key poses made single edges.

    Key poses are the ends of loops, the first and the last pose, and `extra` ones.
    """

    def __init__(self, graph: PoseGraph, loops: list[Loop], extra: Iterable[int] = ()) -> None:
        poses, (steps, covariances) = graph.poses, graph.steps
        self.centre = poses[:, :2].mean(axis=0)
        self._ends = _columns(loops)
        source, target, relative, loop_covariances = self._ends
        self.keys = np.unique(np.concatenate(([0, len(poses) - 1], source, target, np.array(list(extra), np.int64))))
        numbers = np.arange(len(steps))
        chain, spread = _twisted(poses, self.centre, numbers, numbers + 1, steps, covariances)
        self._ways = np.concatenate((np.zeros((1, 3)), np.cumsum(chain, axis=0)))
        self._spreads = np.concatenate((np.zeros((1, 3, 3)), np.cumsum(spread, axis=0)))
        loop_ways, loop_spreads = _twisted(poses, self.centre, source, target, relative, loop_covariances)
        self._loop_ways, self._loop_information = loop_ways, np.linalg.inv(loop_spreads)
        self._links = np.linalg.inv(self._spreads[self.keys[1:]] - self._spreads[self.keys[:-1]])

    def place(self, number: int) -> int:
        """Return the place of a pose among the key poses."""
        return int(np.searchsorted(self.keys, number))

    def _edges(self, weights: Floats | list[float]) -> tuple[np.ndarray, np.ndarray, Floats, Floats]:
        """Return the edges between key poses: their ends' places, errors as twists, and information."""
        source, target = self._ends[:2]
        first, second = np.arange(len(self.keys) - 1), np.arange(1, len(self.keys))
        ways = self._ways[self.keys[1:]] - self._ways[self.keys[:-1]]
        loops = self._loop_information * np.asarray(weights, np.float64).reshape(-1, 1, 1)
        return (
            np.concatenate((first, np.searchsorted(self.keys, source))),
            np.concatenate((second, np.searchsorted(self.keys, target))),
            np.concatenate((ways, self._loop_ways)),
            np.concatenate((self._links, loops)),
        )

    def information(self, weights: Floats | list[float]) -> Floats:
        """Return the information of the key poses but the first, which stays: a matrix of blocks of 3 by 3."""
        source, target, _, information = self._edges(weights)
        size = len(self.keys)
        blocks = np.zeros((size, size, 3, 3))
        for a, b, sign in ((source, source, 1), (target, target, 1), (source, target, -1), (target, source, -1)):
            np.add.at(blocks, (a, b), sign * information)
        return np.ascontiguousarray(blocks[1:, 1:].transpose(0, 2, 1, 3)).reshape(3 * size - 3, 3 * size - 3)

    def twists(self, weights: Floats) -> Floats:
        """Return the motion of every pose that solves the problem."""
        source, target, ways, information = self._edges(weights)
        pull = np.einsum("nij,nj->ni", information, ways)
        sums = np.zeros((len(self.keys), 3))
        np.add.at(sums, source, pull)
        np.add.at(sums, target, -pull)
        found = np.zeros((len(self.keys), 3))
        if len(self.keys) > 1:
            found[1:] = np.linalg.solve(self.information(weights), sums[1:].ravel()).reshape(-1, 3)
        return self._spread_out(found)

    def _spread_out(self, found: Floats) -> Floats:
        """Return the motion of all poses by those of the key poses: each edge of a chain takes its share."""
        if len(self.keys) == 1:
            return found
        keys = self.keys
        ways = self._ways[keys[1:]] - self._ways[keys[:-1]]
        strain = np.einsum("nij,nj->ni", self._links, np.diff(found, axis=0) + ways)
        part = np.clip(np.searchsorted(keys, np.arange(keys[-1] + 1), side="right") - 1, 0, len(keys) - 2)
        begin = keys[part]
        shares = np.einsum("nij,nj->ni", self._spreads - self._spreads[begin], strain[part])
        return np.asarray(found[part] - (self._ways - self._ways[begin]) + shares)


def _columns(loops: list[Loop]) -> tuple[np.ndarray, np.ndarray, Floats, Floats]:
    """Return the sources, targets, relative poses and covariances of loops."""
    if not loops:
        return np.empty(0, np.int64), np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3, 3))
    source, target, relative, covariance, _ = zip(*loops, strict=True)
    return np.array(source), np.array(target), np.array(relative), np.array(covariance)


def _errors(poses: Floats, source: np.ndarray, target: np.ndarray, relative: Floats) -> Floats:
    """Return by how much targets as seen from sources differ from what was measured."""
    before, after = poses[source], poses[target]
    cos, sin = np.cos(before[:, 2]), np.sin(before[:, 2])
    dx, dy = after[:, 0] - before[:, 0], after[:, 1] - before[:, 1]
    turn = after[:, 2] - before[:, 2] - relative[:, 2]
    turn -= math.tau * np.round(turn / math.tau)
    return np.column_stack((cos * dx + sin * dy - relative[:, 0], cos * dy - sin * dx - relative[:, 1], turn))


def _squares(errors: Floats, covariances: Floats) -> Floats:
    if not len(errors):
        return np.zeros(0)
    return np.asarray(np.einsum("ni,ni->n", errors, np.linalg.solve(covariances, errors[:, :, None])[:, :, 0]))


def _jacobians(poses: Floats, centre: Floats, source: np.ndarray, target: np.ndarray) -> Floats:
    """Return how errors change with the difference of the twists of their edges' ends."""
    cos, sin = np.cos(poses[source, 2]), np.sin(poses[source, 2])
    x, y = (poses[target, :2] - centre).T
    found = np.zeros((len(source), 3, 3))
    found[:, 0, 0], found[:, 0, 1], found[:, 0, 2] = cos, sin, sin * x - cos * y
    found[:, 1, 0], found[:, 1, 1], found[:, 1, 2] = -sin, cos, cos * x + sin * y
    found[:, 2, 2] = 1.0
    return found


def _twisted(
    poses: Floats, centre: Floats, source: np.ndarray, target: np.ndarray, relative: Floats, covariances: Floats
) -> tuple[Floats, Floats]:
    """Return errors and covariances of edges as twists about the centre."""
    inverse = np.linalg.inv(_jacobians(poses, centre, source, target))
    ways = np.einsum("nij,nj->ni", inverse, _errors(poses, source, target, relative))
    return np.asarray(ways), np.asarray(inverse @ covariances @ inverse.transpose(0, 2, 1))


def _moved(poses: Floats, centre: Floats, twists: Floats) -> Floats:
    """Return poses after twists about the centre: each turns about it and is shifted."""
    found: Floats = poses.copy()
    x, y = (poses[:, :2] - centre).T
    cos, sin = np.cos(twists[:, 2]), np.sin(twists[:, 2])
    found[:, 0] = centre[0] + cos * x - sin * y + twists[:, 0]
    found[:, 1] = centre[1] + sin * x + cos * y + twists[:, 1]
    found[:, 2] = [wrapped(each) for each in (poses[:, 2] + twists[:, 2]).tolist()]
    return found
