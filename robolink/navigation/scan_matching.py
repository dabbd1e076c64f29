"""Scan matching: the pose at which a lidar's points fit best onto those of earlier scans (correlative scan matching).

Every pose of a window is looked at: a field of scores is drawn around the earlier points, and branch and bound finds
the best sum of it over the scan's points (Olson, Real-time correlative scan matching, ICRA 2009; sliding maxima as in
Hess et al., Real-time loop closure in 2D LIDAR SLAM, ICRA 2016). A quadratic through the responses around the best
pose refines it below a cell, and its curvature says how certain it is.
"""

from __future__ import annotations

import functools
import heapq
import itertools
import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose, wrapped
from robolink.navigation.grid import Floats

Cells = npt.NDArray[np.uint8]

_NATS = 4.5
"""Fall of a Gaussian from its top to three deviations, in natural units of its logarithm."""
_STEPS = 127
"""Steps into which that fall is divided: the sum of two still fits into a byte."""
_SCORES = np.append(np.round(255.0 * np.exp(-np.arange(_STEPS) * _NATS / _STEPS)), np.zeros(129)).astype(np.uint8)
_TABLE = _SCORES / 255.0
_EXPANSIONS = 1500
"""Blocks that a search divides at most, which bounds its time where every place is alike."""
_NEIGHBOURS = 8
"""Points before and after one that make its surface, if they are near."""
_JOINED = 2.5
"""Metres between two neighbours on a wall from which on the wall between them is not believed."""
_LOOSE = 0.015
"""Mean square of a motion across surfaces that is taken for noise."""
_LEAST_INFORMATION = 1e-2
"""Information in 1/m² that is counted with where every place is alike: a deviation of 10 m."""


class Window(NamedTuple):
    """Poses that are looked at: up to `reach` metres from the guess in x and in y, and `turn` radians in heading.

    `angle_step` is the step in heading (radians). `blocks` are the sides in cells of the blocks that bound the
    search, from large to 1, each a multiple of the next.
    """

    reach: float = 0.25
    turn: float = 0.349
    angle_step: float = 0.00873
    blocks: tuple[int, ...] = (4, 1)


class Match(NamedTuple):
    """A pose that fits.

    `response` is the mean score of the points, from 0 to 1. `covariance` is that of x, y (metres) and heading
    (radians), in the frame of the pose; along directions in which every place is alike it is huge.
    """

    pose: Pose
    response: float
    covariance: Floats


class Field:
    """Scores of places: 1 where a point of an earlier scan is, and less around it, as a Gaussian falls off.

    Args:
        points: Points of earlier scans in metres, as rows.
        centre: Where the scan will be, about; x and y in metres.
        radius: Distance from `centre` within which the scan's points will be, in metres.
        resolution: Side of a cell in metres.
        smear: Standard deviation of the Gaussian, in metres.
        reach: Metres that searches go from `centre`, in x and in y.
    """

    def __init__(
        self,
        points: Floats,
        centre: tuple[float, float],
        radius: float,
        *,
        resolution: float = 0.03,
        smear: float = 0.06,
        reach: float = 0.3,
    ) -> None:
        self.resolution, self.smear = resolution, smear
        self._spread = max(1, math.ceil(3.0 * smear / resolution))
        self._reach = math.ceil(reach / resolution) + 1
        inner = 2 * math.ceil((radius + smear) / resolution) + 2
        self._margin = self._reach + self._spread + 32
        side = inner + 2 * self._margin
        self.origin = (centre[0] - side * resolution / 2, centre[1] - side * resolution / 2)
        self._side = side
        self._falls = self._drawn(points)
        self.scores: Cells = _SCORES.take(self._falls)
        self.sharp_smear = min(smear, max(smear / 2.0, 1.2 * resolution))
        """Standard deviation of the sharper Gaussian with which `refined` looks at the same points, in metres."""
        sharper = (smear / self.sharp_smear) ** 2 * _NATS / _STEPS
        self._sharp = np.append(np.exp(-np.arange(_STEPS) * sharper), np.zeros(129))
        self._maxima: dict[int, Cells] = {1: self.scores}

    def _drawn(self, points: Floats) -> Cells:
        """Return how far the logarithm of each cell's score has fallen: along rows first, then along columns."""
        side, spread = self._side, self._spread
        cells = np.floor((points - self.origin) / self.resolution)
        fits = ((cells >= spread) & (cells < side - spread)).all(axis=1)
        column, row = cells[fits].astype(np.int64).T
        places = np.unique(row * side + column)
        falls = np.full(side * side, _STEPS, np.uint8)
        fall = np.minimum(_STEPS, np.round(np.arange(spread + 1) ** 2 * self._fall)).astype(np.uint8)
        for shift in range(spread, -1, -1):
            for each in (places + shift, places - shift):
                falls[each] = np.minimum(falls[each], fall[shift])
        along = falls.reshape(side, side)
        found: Cells = along.copy()
        moved = np.empty_like(along)
        for shift in range(1, spread + 1):
            np.add(along, fall[shift], out=moved)
            np.minimum(found[shift:], moved[:-shift], out=found[shift:])
            np.minimum(found[:-shift], moved[shift:], out=found[:-shift])
        return found

    @property
    def _fall(self) -> float:
        """Steps of the logarithm by which the score falls at one cell's distance."""
        return (self.resolution / self.smear) ** 2 / 2.0 * _STEPS / _NATS

    def maxima(self, block: int) -> Cells:
        """Return the largest score of the `block` times `block` cells right of each cell and above it."""
        if block not in self._maxima:
            found = self.scores.copy()
            reached = 1
            while reached < block:
                shift = min(reached, block - reached)
                np.maximum(found[:-shift], found[shift:], out=found[:-shift])
                np.maximum(found[:, :-shift], found[:, shift:], out=found[:, :-shift])
                reached += shift
            self._maxima[block] = found
        return self._maxima[block]

    def places(self, points: Floats, poses: Floats) -> Floats:
        """Return where points seen from poses are, in cells: poses by points by (column, row)."""
        cos, sin = np.cos(poses[:, 2:3]), np.sin(poses[:, 2:3])
        found = np.empty((len(poses), len(points), 2))
        found[:, :, 0] = cos * points[:, 0] - sin * points[:, 1] + (poses[:, 0:1] - self.origin[0])
        found[:, :, 1] = sin * points[:, 0] + cos * points[:, 1] + (poses[:, 1:2] - self.origin[1])
        found /= self.resolution
        return found

    def cells(self, points: Floats, poses: Floats) -> npt.NDArray[np.int32]:
        """Return the numbers of the cells that points lie in; those too far out are brought to the margin."""
        places = self.places(points, poses).astype(np.int32)
        np.clip(places, self._margin - self._spread, self._side - self._margin + self._spread - 1, out=places)
        numbers: npt.NDArray[np.int32] = places[:, :, 1] * np.int32(self._side) + places[:, :, 0]
        return numbers

    def responses(self, points: Floats, poses: Floats, *, sharp: bool = False) -> Floats:
        """Return the mean scores of poses, from 0 to 1, interpolated between the centres of cells.

        Args:
            points: Points of a scan, in the frame of the poses, as rows.
            poses: Rows of x, y and heading.
            sharp: True takes the sharper Gaussian.
        """
        places = self.places(points, poses)
        places -= 0.5
        np.clip(places, 0, self._side - 2, out=places)
        whole = places.astype(np.int64)
        share = places - whole
        right, up = share[:, :, 0], share[:, :, 1]
        flat, table = self._falls.ravel(), self._sharp if sharp else _TABLE
        cell = whole[:, :, 1] * self._side + whole[:, :, 0]

        def score(shift: int) -> Floats:
            found: Floats = table.take(flat.take(cell + shift))
            return found

        below = (1.0 - right) * score(0) + right * score(1)
        above = (1.0 - right) * score(self._side) + right * score(self._side + 1)
        return np.asarray((below + up * (above - below)).mean(axis=1))

    def search(self, points: Floats, guess: Pose, window: Window, least: float = 0.0) -> tuple[Pose, float] | None:
        """Return the pose of the window with the largest response, to a cell and an angle's step, and that response.

        Args:
            points: Points of the scan, in the frame of the pose, as rows.
            guess: Middle of the window.
            window: Poses that are looked at.
            least: Response below which nothing is found: None is returned then.
        """
        if not len(points):
            return None
        turns = _ceil(window.turn, window.angle_step)
        angles = guess.theta + np.arange(-turns, turns + 1) * window.angle_step
        poses = np.column_stack((np.full(len(angles), guess.x), np.full(len(angles), guess.y), angles))
        reach = min(_ceil(window.reach, self.resolution), self._reach)
        found = _best(self, self.cells(points, poses), reach, window.blocks, math.ceil(least * 255 * len(points)))
        if found is None:
            return None
        score, angle, up, right = found
        x, y = guess.x + right * self.resolution, guess.y + up * self.resolution
        return Pose(x, y, wrapped(float(angles[angle]))), score / (255.0 * len(points))


def _ceil(size: float, step: float) -> int:
    return math.ceil(size / step - 1e-9)


def _best(
    field: Field, cells: npt.NDArray[np.int32], reach: int, blocks: tuple[int, ...], least: int
) -> tuple[int, int, int, int] | None:
    """Return the largest sum of scores over shifts up to `reach` cells, and its angle, row and column of the shift.

    Blocks of shifts wait in order of their bounds: the sums of the largest scores that each point can reach within
    the block. The first block of a single shift that comes up is the best.
    """
    side, block = field.scores.shape[1], blocks[0]
    shifts = np.arange(-reach, reach + 1, block)
    maxima = field.maxima(block).ravel()
    bounds = np.empty((len(shifts), len(shifts), len(cells)), np.int64)
    for (i, up), (j, right) in itertools.product(enumerate(shifts), enumerate(shifts)):
        bounds[i, j] = maxima.take(cells + np.int32(up * side + right)).sum(axis=1, dtype=np.int64)
    promising = np.flatnonzero(bounds.ravel() >= least)
    rows, columns, angles = np.unravel_index(promising, bounds.shape)
    last = len(blocks) - 1
    numbers = (-bounds.ravel()[promising], np.full_like(rows, last), angles, shifts[rows], shifts[columns])
    waiting = list(zip(*(each.tolist() for each in numbers), strict=True))
    heapq.heapify(waiting)
    for _ in range(_EXPANSIONS):
        if not waiting:
            return None
        bound, left, angle, up, right = heapq.heappop(waiting)  # of those that are alike, the smallest block
        if not left:
            return -bound, angle, up, right
        for child in _divided(field, cells[angle], blocks[last - left], blocks[last - left + 1], (up, right), reach):
            if child[0] >= least:
                heapq.heappush(waiting, (-child[0], left - 1, angle, *child[1:]))
    leaves = [each for each in waiting if not each[1]]
    return _shift(min(leaves)) if leaves else None


def _shift(leaf: tuple[int, int, int, int, int]) -> tuple[int, int, int, int]:
    return -leaf[0], *leaf[2:]


def _divided(
    field: Field, cells: npt.NDArray[np.int32], block: int, into: int, corner: tuple[int, int], reach: int
) -> list[tuple[int, int, int]]:
    """Divide a block of shifts into smaller ones; return their bounds, rows and columns, without those out of reach."""
    steps = np.arange(0, block, into)
    ups, rights = (corner[0] + steps)[corner[0] + steps <= reach], (corner[1] + steps)[corner[1] + steps <= reach]
    up, right = np.repeat(ups, len(rights)), np.tile(rights, len(ups))
    shifts = (up * field.scores.shape[1] + right).astype(np.int32)
    sums = field.maxima(into).ravel().take(cells[None, :] + shifts[:, None]).sum(axis=1, dtype=np.int64)
    return list(zip(sums.tolist(), up.tolist(), right.tolist(), strict=True))


class Surface(NamedTuple):
    """A quadratic through the responses around a pose: gradient and curvature of x, y (cells) and heading (steps)."""

    gradient: Floats
    curvature: Floats


@functools.cache
def _stencil() -> tuple[Floats, Floats]:
    """Return the 27 poses around one, in steps, and what fits a quadratic's ten numbers to their responses."""
    steps = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=3)))
    x, y, t = steps.T
    columns = [np.ones(27), x, y, t, x * x / 2, y * y / 2, t * t / 2, x * y, x * t, y * t]
    return steps, np.linalg.pinv(np.column_stack(columns))


def _surface(field: Field, points: Floats, pose: Pose, steps: Floats) -> Surface:
    stencil, fit = _stencil()
    responses = field.responses(points, np.array(pose) + stencil * steps, sharp=True)
    _, *gradient, xx, yy, tt, xy, xt, yt = (fit @ responses).tolist()
    return Surface(np.array(gradient), np.array([[xx, xy, xt], [xy, yy, yt], [xt, yt, tt]]))


class Scan(NamedTuple):
    """Points of a scan in the frame of the robot, as rows, and the surfaces that they lie on.

    A normal is as long as its surface is straight: 1 for a wall, 0 where there is none. `surface` are the points, and
    more between those that are neighbours on a straight wall: what later scans are matched onto, since beams far off
    hit a wall at other places each time.
    """

    points: Floats
    normals: Floats
    surface: Floats


def scan_of(points: Floats) -> Scan:
    """Return a scan of points that follow each other as the beams do."""
    centre, spread = np.zeros((len(points), 2)), np.zeros((len(points), 3))
    count = np.zeros(len(points))
    near = 0.3 + 0.06 * np.sqrt(np.square(points).sum(axis=1))
    for shift in range(-_NEIGHBOURS, _NEIGHBOURS + 1):
        gaps = np.roll(points, shift, axis=0) - points
        fits = np.square(gaps).sum(axis=1) < near * near
        gaps[~fits] = 0.0
        centre += gaps
        spread += np.column_stack((gaps[:, 0] ** 2, gaps[:, 1] ** 2, gaps[:, 0] * gaps[:, 1]))
        count += fits
    centre /= np.maximum(count, 1.0)[:, None]
    spread /= np.maximum(count, 1.0)[:, None]
    xx, yy, xy = (spread - np.column_stack((centre[:, 0] ** 2, centre[:, 1] ** 2, centre[:, 0] * centre[:, 1]))).T
    along, total = np.hypot(xx - yy, 2.0 * xy), np.maximum(xx + yy, 1e-12)
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    straight = np.where(count >= 3, along / total, 0.0)
    normals = straight[:, None] * np.column_stack((-np.sin(angle), np.cos(angle)))
    return Scan(points, normals, np.concatenate((points, _between(points, normals))))


def _between(points: Floats, normals: Floats) -> Floats:
    """Return points between neighbours on straight walls, some 6 cm apart, at most a dozen between two."""
    if len(points) < 2:
        return np.empty((0, 2))
    gaps, after = np.roll(points, -1, axis=0) - points, np.roll(normals, -1, axis=0)
    lengths = np.sqrt(np.square(gaps).sum(axis=1))
    across = np.maximum(np.abs((gaps * normals).sum(axis=1)), np.abs((gaps * after).sum(axis=1)))
    straight = np.minimum(np.square(normals).sum(axis=1), np.square(after).sum(axis=1)) > 0.7
    joined = straight & (across < 0.15 * lengths) & (lengths < _JOINED)
    counts = np.where(joined, np.minimum(lengths / 0.06, 12.0), 0.0).astype(np.int64)
    place = np.repeat(np.arange(len(points)), counts)
    number = np.arange(len(place)) - np.repeat(np.cumsum(counts) - counts, counts) + 1
    found: Floats = points[place] + gaps[place] * (number / (counts[place] + 1))[:, None]
    return found


def _outlined(scan: Scan, heading: float, radius: float) -> Floats:
    """Return how firmly the surfaces of a scan hold it: the mean square of each motion across them, from 0 to 1.

    It is that of x, y and heading, the last in units of `radius`. What the noise of points makes of a corridor is 0.
    """
    cos, sin = math.cos(heading), math.sin(heading)
    turn = np.array([[cos, -sin], [sin, cos]])
    normals, points = scan.normals @ turn.T, scan.points @ turn.T
    across = np.column_stack((normals, (points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0]) / radius))
    values, axes = np.linalg.eigh(across.T @ across / len(across))
    firm = values * np.clip((values - _LOOSE) / _LOOSE, 0.0, 1.0)
    return np.asarray(axes * firm @ axes.T)


def refined(field: Field, scan: Scan, pose: Pose, rounds: int = 3) -> Match:
    """Return the best pose near another, below the size of a cell, with its response and covariance.

    The covariance is that of as many beams as there are points (at most 200, since the errors of neighbours are
    alike), each with an error of half the sharper smear: about twice what matches in simulated rooms show.

    Args:
        field: Scores of earlier scans.
        scan: What is placed.
        pose: Pose to begin at, within a cell or so of the best.
        rounds: Quadratics that are fitted one after the other, each a Newton step.
    """
    points = scan.points
    radius = math.sqrt(float(np.mean(np.square(points).sum(axis=1)))) + field.resolution
    steps = np.array([field.resolution, field.resolution, field.resolution / radius])
    best, response = pose, float(field.responses(points, np.array([pose]), sharp=True)[0])
    for _ in range(rounds):
        surface = _surface(field, points, best, steps)
        moved = _newton(surface) * steps
        there = Pose(*(np.array(best) + moved).tolist())
        found = float(field.responses(points, np.array([there]), sharp=True)[0])
        if found <= response:
            break
        best, response = there, found
        if (np.abs(moved) < 0.02 * steps).all():
            break
    smear = field.sharp_smear
    wide = np.maximum(steps, np.array([smear, smear, smear / radius]) * 0.7)
    curvature = _surface(field, points, best, wide).curvature / np.outer(wide, wide)
    scale = np.array([1.0, 1.0, radius])
    count = 4.0 * min(len(points), 200)
    covariance = _inverse(count * -curvature / np.outer(scale, scale))
    # Points that are far apart look like posts, which hold a scan where a wall would not: surfaces have a say, too.
    covariance += _inverse(count * _outlined(scan, best.theta, radius) / smear**2)
    response = float(field.responses(points, np.array([best]))[0])
    return Match(best._replace(theta=wrapped(best.theta)), response, covariance / np.outer(scale, scale))


def _newton(surface: Surface) -> Floats:
    """Return the step to the top of a quadratic, at most one step along each axis, and none where it is flat."""
    values, axes = np.linalg.eigh(-surface.curvature)
    along = axes.T @ surface.gradient
    firm = values > 1e-3 * max(float(values[-1]), 1e-9)
    step = axes @ np.where(firm, along / np.where(firm, values, 1.0), 0.0)
    clipped: Floats = np.clip(step, -1.0, 1.0)
    return clipped


def _inverse(information: Floats) -> Floats:
    """Return the covariance of an information matrix, at most that of `_LEAST_INFORMATION`."""
    values, axes = np.linalg.eigh(information)
    return np.asarray(axes / np.maximum(values, _LEAST_INFORMATION) @ axes.T)


def blended(match: Match, expected: Pose, covariance: Floats) -> Match:
    """Return a match that leaves to odometry what the scans do not say.

    In directions in which the match is less certain than odometry (along a corridor whose walls look alike
    everywhere, the heading in a round room) the pose is drawn to the expected one; elsewhere it stays.

    Args:
        match: What scan matching found.
        expected: The pose by odometry.
        covariance: That of the expected pose, as `Match.covariance`.
    """
    roots = np.sqrt(np.diag(covariance))
    values, axes = np.linalg.eigh(match.covariance / np.outer(roots, roots))
    # Now odometry's variance is about 1 along each axis. A quarter of that is as good as certain: even a small share
    # of odometry in each step would bend a long way by its systematic errors.
    share = np.where(values < 0.25, 0.0, values / (1.0 + values))
    gap = np.array([expected.x - match.pose.x, expected.y - match.pose.y, wrapped(expected.theta - match.pose.theta)])
    moved = axes @ (share * (axes.T @ (gap / roots))) * roots
    pose = Pose(*(np.array(match.pose) + moved).tolist())
    joined = (axes * (values / (1.0 + values))) @ axes.T * np.outer(roots, roots)
    return Match(pose._replace(theta=wrapped(pose.theta)), match.response, np.asarray(joined))
