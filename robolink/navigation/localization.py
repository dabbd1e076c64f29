"""Localization on a map: a particle filter that is fed with odometry and scans, as Nav2's AMCL is.

localization = Localization(LocalizationOptions(), numpy.random.default_rng(1))
localization.set_map(grid)
localization.start_at(Pose(1.0, 2.0, 0.5), covariance)
if localization.update(odometry, beams):
    print(localization.estimate)
"""

from __future__ import annotations

import math
from functools import partial
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose, placed_on, seen_from, wrapped
from robolink.geometry.trigonometry import cos_and_sin
from robolink.navigation.fit_watch import FitWatch
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.likelihood_field import UNITS, LikelihoodField, SensorModel
from robolink.navigation.motion_models import Alphas, MotionModel, move_differential, roughen, wrap_headings
from robolink.navigation.particle_filter import Estimate, FilterOptions, ParticleFilter

MOST_FIELDS = 4
"""Most likelihood fields that are held, one for each `range_max` of the scanners."""
FASTEST = 10.0
"""Speed in m/s, and in rad/s, above which odometry has jumped."""
NEAR = 2.0
"""Distance from a wall, in cells of the map, within which a beam's end fits to the map."""
AT_REST = (0.02, 0.01)
"""Way in metres and turn in radians up to which a robot rests; its particles are scattered by as much."""
ANYWHERE = 0.7
"""Share of the particles that are drawn anywhere when scans fit badly, if recovery is requested."""


class Beams(NamedTuple):
    """Ends of a scan's beams, in metres `ahead` of the robot and to its left (`aside`), of one scanner."""

    ahead: Floats
    aside: Floats
    range_max: float
    scanner: str = ""


class BeamSkip(NamedTuple):
    """Options for leaving beams out that the map does not explain, with Nav2's parameters of similar names.

    A beam agrees with a particle if it ends within `distance` metres of a wall; one that agrees with no more than the
    share `threshold` of the particles is left out, unless as many as the share `error_threshold` of all beams were.
    """

    distance: float = 0.5
    threshold: float = 0.3
    error_threshold: float = 0.9


class LocalizationOptions(NamedTuple):
    """Options, with Nav2's parameters of the same names and their defaults.

    `skip` of None uses every beam. With a `recovery_alpha_fast` above 0 a robot that seems lost is searched everywhere.
    """

    particles: FilterOptions = FilterOptions()
    sensor: SensorModel = SensorModel()
    alphas: Alphas = Alphas()
    motion: MotionModel = move_differential
    skip: BeamSkip | None = None
    update_min_d: float = 0.25
    update_min_a: float = 0.2
    resample_interval: int = 1
    recovery_alpha_slow: float = 0.0
    recovery_alpha_fast: float = 0.0


class Localization:
    """Estimate of a robot's pose on a map.

    Args:
        options: Options.
        random: Generator of all that is drawn.
    """

    estimate: Estimate | None = None
    """Latest estimate, at the last update; None before the first one."""
    fit: float = 1.0
    """Share of the last scan's beams that end near a wall of the map, as seen from the estimated pose."""
    searches: int = 0
    """Number of times that particles were drawn anywhere, since the robot seemed lost."""

    def __init__(self, options: LocalizationOptions, random: np.random.Generator) -> None:
        self._options = options
        self._fields: dict[float, LikelihoodField] = {}
        self._grid: Grid | None = None
        self._places: Floats = np.empty((2, 0))
        self.particles = ParticleFilter(options.particles, random)
        self._begin()

    def _begin(self) -> None:
        """Wait for the first scan, which is used wherever the robot is."""
        self.estimate = None
        self._updated_at: Pose | None = None
        self._seen_at: Pose | None = None
        self._due: dict[str, bool] = {}
        self._updates, self.is_forced, self._is_restarted = 0, False, False
        self.watch = FitWatch(self._options.recovery_alpha_slow, self._options.recovery_alpha_fast)

    @property
    def options(self) -> LocalizationOptions:
        """Options; new ones hold from the next scan on, and the particles stay."""
        return self._options

    @options.setter
    def options(self, options: LocalizationOptions) -> None:
        self._options, self.particles.options = options, options.particles
        self._fields = {}

    def set_map(self, grid: Grid) -> None:
        """Use a map, in place of another one, of cells from 0 (free) to 100, -1 for unknown; the particles stay."""
        self._grid, self._fields = grid, {}
        self._places = np.array(grid.cell_to_world(*(grid.cells == 0).nonzero()))

    @property
    def has_map(self) -> bool:
        """True once a map is there."""
        return self._grid is not None

    # Beginnings

    def start_at(self, pose: Pose, covariance: Floats) -> None:
        """Begin about a pose; the covariance is that of x, y and heading (3 x 3)."""
        self.particles.scatter_about(pose, covariance)
        self._begin()

    def start_anywhere(self) -> bool:
        """Begin with poses in all free cells of the map; return False if there is none."""
        if self._grid is None or not self._places.shape[1]:
            return False
        self.particles.scatter_over(self._places, self._grid.resolution)
        self._begin()
        return True

    def restart_odometry(self) -> None:
        """Take the next odometry as a jump, however near it is: it has begun anew."""
        self._is_restarted = True

    # Scans

    def update(self, odometry: Pose, beams: Beams, seconds: float = math.inf) -> bool:
        """Take a scan; return True if it was used, since the robot has moved far enough, or it was requested.

        Args:
            odometry: Pose of the robot by odometry at the time of the scan.
            beams: Scan.
            seconds: Time since the last scan, by which a jump of odometry is told from a way.

        Returns:
            True if there is a new estimate.
        """
        self._note_jump(odometry, seconds)
        if self._grid is None or not self._is_due(odometry, beams.scanner):
            return False
        if self._updated_at is not None:
            motion, alphas = self._options.motion, self._options.alphas
            self.particles.move(partial(_moved, motion, self._updated_at, odometry, alphas))
            if not _is_beyond(self._updated_at, odometry, *AT_REST):
                self.particles.move(lambda poses, random: roughen(poses, *AT_REST, random))
        self._updated_at, self._due[beams.scanner], self.is_forced = odometry, False, False
        field = self._field(beams.range_max)
        self._weigh(field, beams)
        self.estimate = self.particles.estimate()
        self._note_fit(field, beams)
        self._updates += 1
        if self.seems_lost and self._options.recovery_alpha_fast and self._places.shape[1]:
            self.particles.scatter_some(ANYWHERE, self._places, self._grid.resolution)
            self.watch.begin_again()
            self.searches += 1
        elif self._updates % max(self._options.resample_interval, 1) == 0:
            self.particles.resample()
        return True

    def _note_jump(self, odometry: Pose, seconds: float) -> None:
        """Split the particles if odometry has jumped since the last scan, `seconds` ago.

        Half of them stay: odometry was set back. The others jump with it: the robot was put elsewhere, as when a
        simulator is reset. The scans tell which is right.
        """
        last, self._seen_at = self._seen_at, odometry
        if last is None or self._updated_at is None:
            return
        most = FASTEST * max(seconds, 0.1)
        has_moved = math.dist(last[:2], odometry[:2]) <= most and abs(wrapped(last.theta - odometry.theta)) <= most
        if has_moved and not self._is_restarted:
            return
        self.particles.move(partial(_follow, seen_from(self._updated_at, last), 0))
        self.particles.resample()
        self.particles.move(partial(_follow, seen_from(last, odometry), 1))
        self._updated_at, self._is_restarted, self.is_forced = odometry, False, True

    def _is_due(self, odometry: Pose, scanner: str) -> bool:
        """Return True if a scanner's scan is to be used: each has its turn whenever the robot has moved."""
        self._due.setdefault(scanner, True)
        last = self._updated_at
        far, turned = self._options.update_min_d, self._options.update_min_a
        if last is None or self.is_forced or _is_beyond(last, odometry, far, turned):
            self._due = dict.fromkeys(self._due, True)
        return self._due[scanner]

    def _field(self, range_max: float) -> LikelihoodField:
        assert self._grid is not None
        if range_max not in self._fields:
            if len(self._fields) == MOST_FIELDS:
                del self._fields[next(iter(self._fields))]
            self._fields[range_max] = LikelihoodField(self._grid, self._options.sensor, range_max)
        return self._fields[range_max]

    def _weigh(self, field: LikelihoodField, beams: Beams) -> None:
        ratings = field.ratings(self.particles.poses, beams.ahead, beams.aside)
        skip = self._options.skip
        if skip is not None and ratings.size:
            ratings = ratings[:, _agreed(ratings, field.rating(skip.distance), skip)]
        self.particles.weigh(ratings.sum(axis=1, dtype=np.int32) / UNITS, ratings.shape[1])

    def _note_fit(self, field: LikelihoodField, beams: Beams) -> None:
        """Note how well a scan fits to the map from the estimated pose."""
        if self.estimate is None or self._grid is None or not len(beams.ahead):
            return
        ratings = field.ratings(np.array(self.estimate.pose)[:, None], beams.ahead, beams.aside)
        self.fit = float((ratings >= field.rating(NEAR * self._grid.resolution)).mean())
        if not self.particles.is_spread():
            self.watch.note(self.fit)

    @property
    def seems_lost(self) -> bool:
        """True if scans fit to the map much worse than usual: the robot may be elsewhere."""
        return self.watch.is_bad

    # Results

    def origin_of_odometry(self) -> Pose | None:
        """Return the pose on the map of odometry's origin: the transform from the map to it. None before a scan."""
        if self.estimate is None or self._updated_at is None:
            return None
        return placed_on(self.estimate.pose, seen_from(self._updated_at, Pose()))


def _moved(
    motion: MotionModel, before: Pose, after: Pose, alphas: Alphas, poses: Floats, random: np.random.Generator
) -> None:
    motion(poses, before, after, alphas, random)


def _follow(way: Pose, every: int, poses: Floats, random: np.random.Generator) -> None:
    """Move poses by a way of the robot, without errors: all of them, or with `every` of 1 every second one."""
    chosen = poses[:, :: every + 1]
    cos, sin = cos_and_sin(chosen[2])
    chosen[0] += cos * way.x - sin * way.y
    chosen[1] += sin * way.x + cos * way.y
    chosen[2] += way.theta
    wrap_headings(poses)


def _is_beyond(last: Pose, now: Pose, far: float, turned: float) -> bool:
    """Return True if a robot has moved by more than a way along x or y, or a turn."""
    moved = max(abs(now.x - last.x), abs(now.y - last.y))
    return moved > far or abs(wrapped(now.theta - last.theta)) > turned


def _agreed(ratings: npt.NDArray[np.int16], least: int, skip: BeamSkip) -> npt.NDArray[np.bool_]:
    """Return which beams are used."""
    used: npt.NDArray[np.bool_] = (ratings >= least).mean(axis=0) > skip.threshold
    if (~used).mean() >= skip.error_threshold:
        used[:] = True  # the pose may be wrong, not the beams
    return used
