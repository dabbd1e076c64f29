"""Particle filter: many poses that a robot may have, each with a weight (adaptive Monte Carlo localization, AMCL).

    filter = ParticleFilter(FilterOptions(max_particles=1000), numpy.random.default_rng(1))
    filter.scatter_about(Pose(1.0, 2.0, 0.5), covariance)
    for odometry, beams in measurements:
        filter.move(lambda poses, random: move_differential(poses, before, odometry, Alphas(), random))
        filter.weigh(likelihoods(field, filter.poses, beams))
        estimate = filter.estimate()
        filter.resample()

What is AMCL's: the number of particles follows their spread (Fox 2003, KLD sampling), and the estimate is the mean of
the best cluster.

What is different: AMCL weighs a particle by the sum of the cubes of its beams' likelihoods, which hardly tells good
poses from better ones. Here it is their product, as in the theory, to a power below one: a half, since neighbouring
beams see the same wall, and less while the particles are spread widely, so that most of them stay in effect
(tempering). Otherwise those that happen to lie near some right place would win over those near the right one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from robolink.geometry.plane import Pose, wrapped
from robolink.navigation.clusters import best_cluster, count_bins
from robolink.navigation.grid import Floats
from robolink.navigation.motion_models import wrap_headings

POWER = 0.5
"""Greatest power to which the likelihood of a scan is taken."""
APART, MANY = 1.0, 0.2
"""Particles are spread widely if more than this share of them is farther than so many metres from the middle."""
IN_EFFECT = 0.7
"""Least share of widely spread particles that must stay in effect after each scan."""


class FilterOptions(NamedTuple):
    """Options, as Nav2's parameters of the same names.

    `pf_err` is the largest error of the distribution that the particles stand for, `pf_z` the normal quantile of the
    probability that it is kept.
    """

    min_particles: int = 500
    max_particles: int = 2000
    pf_err: float = 0.05
    pf_z: float = 0.99


class Estimate(NamedTuple):
    """Estimated pose: `pose` is the mean of the best cluster, and `weight` the share that the cluster has, up to 1.

    `covariance` (3 x 3: x, y, heading) is that of all particles about `pose`, other clusters included.
    """

    pose: Pose
    covariance: Floats
    weight: float


class ParticleFilter:
    """Particles in the plane.

    Args:
        options: Their number, and when some are drawn anew.
        random: Generator of all that is drawn.
    """

    poses: Floats
    """Rows x, y (metres), heading (radians in [-pi, pi]); a column for each particle."""
    weights: Floats
    """Weights of the particles; their sum is 1."""

    def __init__(self, options: FilterOptions, random: np.random.Generator) -> None:
        self.options, self._random = options, random
        self._take(np.zeros((3, options.max_particles)))

    def _take(self, poses: Floats) -> None:
        self.poses = poses
        self.weights = np.full(poses.shape[1], 1.0 / poses.shape[1])

    # Beginnings

    def scatter_about(self, pose: Pose, covariance: Floats) -> None:
        """Draw all particles about a pose, from a normal distribution of a covariance (3 x 3: x, y, heading)."""
        drawn = self._random.standard_normal((3, self.options.max_particles))
        root = cholesky(covariance)
        rows = [sum(root[row][column] * drawn[column] for column in range(row + 1)) for row in range(3)]
        self._begin(np.array(rows) + np.array(pose)[:, None])

    def scatter_over(self, places: Floats, side: float) -> None:
        """Draw all particles from everywhere.

        Args:
            places: Rows x and y of the centres of free squares, in metres; at least one column.
            side: Side of the squares in metres.
        """
        self._begin(self._anywhere(self.options.max_particles, places, side))

    def scatter_some(self, share: float, places: Floats, side: float) -> None:
        """Resample, and draw a share of the particles from everywhere; see `scatter_over`."""
        most = self.options.max_particles
        poses = self._drawn(np.cumsum(self.weights), most)
        anywhere = self._random.random(most) < share
        poses[:, anywhere] = self._anywhere(int(anywhere.sum()), places, side)
        self._take(poses)

    def _begin(self, poses: Floats) -> None:
        wrap_headings(poses)
        self._take(poses)

    def _anywhere(self, count: int, places: Floats, side: float) -> Floats:
        chosen = self._random.integers(places.shape[1], size=count)
        offsets = self._random.uniform(-0.5, 0.5, (2, count)) * side
        headings = self._random.uniform(-math.pi, math.pi, count)
        return np.array([*(places[:, chosen] + offsets), headings])

    # A step

    def move(self, model: Callable[[Floats, np.random.Generator], None]) -> None:
        """Move the particles by a function that changes their poses, and draws from the generator."""
        model(self.poses, self._random)

    def weigh(self, logs: Floats, beams: int) -> None:
        """Weigh the particles by a scan.

        Args:
            logs: Logarithm of the scan's likelihood for each particle, in nats.
            beams: Number of beams that it is the sum of; without any, the weights stay.
        """
        if not beams:
            return
        weights = self.weights * tempered(logs - logs.max(), IN_EFFECT if self.is_spread() else 0.0)
        self.weights = weights / weights.sum()

    def is_spread(self) -> bool:
        """Return True if the particles are spread widely."""
        x, y = self.poses[0] - np.median(self.poses[0]), self.poses[1] - np.median(self.poses[1])
        return float((x * x + y * y > APART * APART).mean()) > MANY

    def resample(self) -> None:
        """Draw particles by their weights, as many as their spread asks for."""
        sums = np.cumsum(self.weights)
        poses = self._drawn(sums, self.options.max_particles)
        count = enough_particles(count_bins(poses), self.options)
        self._take(poses if count == poses.shape[1] else self._drawn(sums, count))

    def _drawn(self, sums: Floats, count: int) -> Floats:
        """Draw particles by their summed weights: low variance, table 4.4 of Probabilistic Robotics."""
        steps = (np.arange(count) + self._random.random()) * (sums[-1] / count)
        return self.poses[:, np.minimum(np.searchsorted(sums, steps), len(sums) - 1)]

    def estimate(self) -> Estimate:
        """Return where the robot is, by the weights that the last scan left."""
        members = best_cluster(self.poses, self.weights)
        weights = self.weights[members]
        weight = float(weights.sum())
        x, y = (float((self.poses[row][members] * weights).sum()) / weight for row in (0, 1))
        middle = float(self.poses[2][members[weights.argmax()]])
        turned = self.poses[2][members] - middle
        turned -= np.rint(turned / math.tau) * math.tau
        pose = Pose(x, y, wrapped(middle + float((turned * weights).sum()) / weight))
        return Estimate(pose, covariance_about(pose, self.poses, self.weights), weight)


def tempered(logs: Floats, floor: float) -> Floats:
    """Return likelihoods to the greatest power, at most `POWER`, that leaves enough particles in effect.

    Args:
        logs: Logarithms of the likelihoods, the greatest of them 0.
        floor: Share of the particles that must stay in effect: Kish's effective size (sum w)² / sum w².
    """
    least = floor * len(logs)
    weights = _exp(logs * POWER)
    if _in_effect(weights) >= least:
        return weights
    low, high = POWER / 2, POWER
    while _in_effect(_exp(logs * low)) < least:
        low, high = low / 2, low
    for _ in range(5):
        middle = (low + high) / 2
        low, high = (middle, high) if _in_effect(_exp(logs * middle)) >= least else (low, middle)
    return _exp(logs * low)


def _in_effect(weights: Floats) -> float:
    return float(weights.sum()) ** 2 / float((weights * weights).sum())


def enough_particles(bins: int, options: FilterOptions) -> int:
    """Return how many particles stand well enough for a distribution over `bins` bins: equation 16 of Fox 2003."""
    if bins <= 1:
        return options.max_particles
    part = 2.0 / (9.0 * (bins - 1))
    root = 1.0 - part + math.sqrt(part) * options.pf_z
    count = math.ceil((bins - 1) / (2.0 * max(options.pf_err, 1e-6)) * root * root * root)
    return min(max(count, options.min_particles), options.max_particles)


def covariance_about(pose: Pose, poses: Floats, weights: Floats) -> Floats:
    """Return the covariance of weighted poses about one of them (3 x 3: x, y, heading)."""
    turned = poses[2] - pose.theta
    gaps = (poses[0] - pose.x, poses[1] - pose.y, turned - np.rint(turned / math.tau) * math.tau)
    found = np.empty((3, 3))
    for row in range(3):
        weighted = gaps[row] * weights
        for column in range(row, 3):
            found[row, column] = found[column, row] = (weighted * gaps[column]).sum()
    return found


def cholesky(covariance: Floats) -> list[list[float]]:
    """Return the lower triangular root of a covariance of any size; what is not positive counts as certain."""
    size = len(covariance)
    root = [[0.0] * size for _ in range(size)]
    for row in range(size):
        for column in range(row + 1):
            rest = float(covariance[row][column]) - sum(root[row][k] * root[column][k] for k in range(column))
            if row == column:
                root[row][row] = math.sqrt(max(rest, 0.0))
            elif root[column][column] > 0.0:
                root[row][column] = rest / root[column][column]
    return root


_LOG2 = math.log(2.0)
_EXP = [1.0 / math.factorial(n) for n in range(12, -1, -1)]


def _exp(logs: Floats) -> Floats:
    """Return exponentials by plain arithmetic: the same bits everywhere, as `geometry/trigonometry.py`."""
    logs = np.maximum(logs, -700.0)
    twos = np.rint(logs / _LOG2)
    rest = logs - twos * _LOG2
    found = np.full(len(logs), _EXP[0])
    for coefficient in _EXP[1:]:
        found *= rest
        found += coefficient
    whole: Floats = np.ldexp(found, twos.astype(np.int32))
    return whole
