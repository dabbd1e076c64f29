"""Controller by rollouts (MPPI): many ways to drive on are tried by arithmetic, and the good ones are averaged.

The method is model predictive path integral control (Williams et al. 2017, "Information theoretic MPC for model-based
reinforcement learning"), with the parameters of Nav2's controller of that name.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import Pose
from robolink.navigation.critics import USUAL, Batch, Critic, Surroundings, costs_at, obstructed
from robolink.navigation.footprint import INSCRIBED, UNKNOWN
from robolink.navigation.grid import Floats
from robolink.navigation.local_path import LocalPath
from robolink.navigation.singles import F, Singles, cos_and_sin, decayed, summed

_SMOOTHING = tuple(F(each / 231) for each in (-21, 14, 39, 54, 59, 54, 39, 14, -21))
"""Weights of nine neighbours: a parabola is fitted to them (Savitzky and Golay 1964)."""
_MARGIN = len(_SMOOTHING) // 2
_HOLD = 0.4
"""Seconds from one draw of the noise to the next."""
_BLOCKED = 3
"""Points of the path ahead that may be obstructed before another way is looked for."""
_WEIGHTY = F(1e-4)
"""Share of the best rollout's weight below which one is left out of the mean."""


@dataclass(frozen=True)
class Options:
    """Parameters under Nav2's names; the defaults of the first three and of `temperature` are not Nav2's, but measured.

    Units: speeds in m/s and rad/s, accelerations in m/s² and rad/s², `model_dt` in seconds.

    `batch_size` rollouts of `time_steps` steps are drawn with the standard deviations `vx_std` and `wz_std` about the
    sequence found last. A low `temperature` trusts the best ones, `gamma` weighs how far one is from that sequence.
    With `regenerate_noises` new ones are drawn in each step. `min_turning_r` in metres is for robots that steer.
    """

    batch_size: int = 400
    time_steps: int = 28
    model_dt: float = 0.1
    iteration_count: int = 1
    temperature: float = 0.1
    gamma: float = 0.015
    vx_max: float = 0.5
    vx_min: float = -0.35
    wz_max: float = 1.9
    ax_max: float = 3.0
    ax_min: float = -3.0
    az_max: float = 3.5
    vx_std: float = 0.2
    wz_std: float = 0.4
    regenerate_noises: bool = True
    min_turning_r: float = 0.0

    def limited(self, limit: float, *, percentage: bool) -> Options:
        """Return them with lower speeds.

        Args:
            limit: Greatest speed ahead in m/s; 0.0 leaves all as it is.
            percentage: True takes `limit` as percent of `vx_max`.
        """
        if limit <= 0.0:
            return self
        share = min(1.0, limit / 100.0 if percentage else limit / self.vx_max)
        return replace(self, vx_max=self.vx_max * share, vx_min=self.vx_min * share, wz_max=self.wz_max * share)


class Command(NamedTuple):
    """Speeds to drive with: `v` in m/s ahead, `w` in rad/s to the left.

    `is_valid` is False if every way is obstructed; the speeds are 0 then.
    """

    v: float
    w: float
    is_valid: bool
    trajectory: Floats
    """Poses to which this leads, of shape (steps, 3)."""


class Rollouts:
    """Controller that remembers the sequence it found last.

    Args:
        options: Its parameters.
        critics: What judges the rollouts.
        random: Source of the noise: the same one gives the same commands.
        period: Seconds between two calls of `step`.
    """

    def __init__(
        self,
        options: Options,
        critics: tuple[Critic, ...] = USUAL,
        *,
        random: np.random.Generator,
        period: float = 0.05,
    ) -> None:
        self.options, self.critics, self._random, self._period = options, critics, random, period
        self._noise: npt.NDArray[np.float32] | None = None
        self._fan = _fan(options)
        self.reset()

    def reset(self) -> None:
        """Forget the sequence: the next step begins with the robot's present speed."""
        self._sequence: Singles = np.zeros((self.options.time_steps, 2), F)
        self._past: Singles = np.zeros((_MARGIN, 2), F)
        self._trajectory: Floats = np.zeros((1, 3))
        self._is_fresh = True

    def step(
        self,
        pose: Pose,
        speed: tuple[float, float],
        path: LocalPath,
        goal: Pose,
        around: Surroundings,
    ) -> Command:
        """Return the command of now.

        Args:
            pose: Pose of the robot, in the frame of everything here.
            speed: Its speed in m/s and rad/s.
            path: What lies ahead.
            goal: Where the whole path ends.
            around: The costmap about the robot, and what moves there.
        """
        if self._is_fresh:
            self._sequence[:] = self._within(np.array([speed], F))
            self._is_fresh = False
        for _ in range(2):
            for _ in range(max(1, self.options.iteration_count)):
                is_valid = self._improve(pose, speed, path, goal, around)
            if is_valid:
                break
            self._sequence[:] = 0.0  # from a standstill there may be a way
        return self._command(pose, is_valid)

    def _improve(
        self,
        pose: Pose,
        speed: tuple[float, float],
        path: LocalPath,
        goal: Pose,
        around: Surroundings,
    ) -> bool:
        """Replace the sequence by the mean of rollouts about it; False, and the old one, if all of them collide."""
        options = self.options
        found = costs_at(around.costs, path.x.astype(F), path.y.astype(F))
        clear = (found < INSCRIBED) | (found == UNKNOWN)
        furthest = min(len(path.x) - 1, round(options.vx_max * options.time_steps * options.model_dt / path.spacing))
        is_blocked = int((~clear).sum()) > _BLOCKED
        v, w = self._drawn(speed, is_blocked=is_blocked)
        x, y, theta = integrated(pose, v, w, options.model_dt)
        batch = Batch(x, y, theta, v, w, options.model_dt, pose, path, clear, furthest, goal, around)
        total, collides = self._judged(batch, fan=len(self._fan) if is_blocked else 0)
        if collides.all():
            return False
        total -= total.min()
        weights = decayed(total * F(1 / options.temperature))
        good = np.flatnonzero(weights >= _WEIGHTY)
        weights = weights[good] / weights[good].sum(dtype=F)
        drawn = self._unclipped(v, good), w[:, good]
        mean = np.stack([(each * weights).sum(axis=1, dtype=F) for each in drawn], axis=1)
        self._sequence = self._feasible(self._smoothed(mean), speed)
        self._trajectory = _led(pose, self._sequence, options.model_dt)
        if self._collides(pose, around):  # two ways round an obstacle have a mean that leads into it
            best = int(total.argmin())
            self._sequence = np.stack([v[:, best], w[:, best]], axis=1)
            self._trajectory = _led(pose, self._sequence, options.model_dt)
        return True

    def _unclipped(self, v: Singles, good: npt.NDArray[np.intp]) -> Singles:
        """Return speeds as they were drawn where they are the greatest there are.

        The mean of what was clipped to the limit is below it, and so no robot would drive at full speed.
        """
        assert self._noise is not None
        clipped = v[:, good]
        drawn = self._noise[:, 0, good] + self._sequence[:, :1]
        return np.where(clipped >= F(self.options.vx_max), np.maximum(drawn, clipped), clipped)

    def _collides(self, pose: Pose, around: Surroundings) -> bool:
        """Return whether the sequence leads into an obstacle."""
        x, y = self._trajectory[:, 0].astype(F), self._trajectory[:, 1].astype(F)
        return bool(obstructed(around.costs, pose, x, y, costs_at(around.costs, x, y)).any())

    def _judged(self, batch: Batch, *, fan: int) -> tuple[Singles, npt.NDArray[np.bool_]]:
        total, options = np.zeros(batch.x.shape[1], F), self.options
        collides = np.zeros(batch.x.shape[1], bool)
        for critic in self.critics:
            judgement = critic.judge(batch) if critic.enabled else None
            if judgement is not None:
                total += judgement.costs
                collides = collides if judgement.collides is None else collides | judgement.collides
        if options.gamma > 0.0:
            for each, column, deviation in ((batch.v, 0, options.vx_std), (batch.w, 1, options.wz_std)):
                mean = self._sequence[:, column, None]
                if deviation > 0.0 and mean.any():
                    far = ((each - mean) * mean).sum(axis=0, dtype=F) * F(options.gamma / deviation**2)
                    far[1 : fan + 1] = 0.0  # this is a measure for what was drawn about the sequence
                    total += far
        return total, collides

    def _drawn(self, speed: tuple[float, float], *, is_blocked: bool = False) -> tuple[Singles, Singles]:
        """Return the speeds of rollouts about the sequence, within all limits."""
        options = self.options
        shape = (options.time_steps, 2, options.batch_size)
        if self._noise is None or options.regenerate_noises or self._noise.shape != shape:
            self._noise = self._noises(shape)
        drawn = self._noise + self._sequence[:, :, None]
        if is_blocked:
            self._add_fan(drawn)
        np.clip(drawn[:, 0], F(options.vx_min), F(options.vx_max), out=drawn[:, 0])
        np.clip(drawn[:, 1], F(-options.wz_max), F(options.wz_max), out=drawn[:, 1])
        rise, fall = self._rates()
        last = np.empty(shape[1:], F)
        last[:] = np.array(speed, F)[:, None]
        low, high = np.empty_like(last), np.empty_like(last)
        for row in drawn:
            np.subtract(last, fall, out=low)
            np.add(last, rise, out=high)
            np.maximum(row, low, out=row)
            np.minimum(row, high, out=row)
            last = row
        if options.min_turning_r > 0.0:
            most = np.abs(drawn[:, 0]) * F(1 / options.min_turning_r)
            np.clip(drawn[:, 1], -most, most, out=drawn[:, 1])
        return drawn[:, 0], drawn[:, 1]

    def _add_fan(self, drawn: Singles) -> None:
        """Put plain ways in place of some rollouts: arcs, turns to and fro, a turn on the spot, backwards, a stop.

        Noise about the sequence alone would never find the way round an obstacle that stands right ahead.
        """
        half = len(drawn) * 2 // 5
        fan = self._fan[: drawn.shape[2] // 3]
        drawn[:half, :, 1 : len(fan) + 1] = fan[:, :2].T
        drawn[half:, :, 1 : len(fan) + 1] = fan[:, [0, 2]].T

    def _noises(self, shape: tuple[int, int, int]) -> Singles:
        """Return noise that is drawn each `_HOLD` seconds, and in between changes evenly from one to the next.

        Noise that is new in each step, as Nav2's, cancels itself out: its rollouts stay close together, and it takes
        several times as many to find the way round an obstacle.
        """
        steps, _, count = shape
        options = self.options
        hold = max(1, round(_HOLD / options.model_dt))
        knots = self._random.standard_normal((-(-steps // hold) + 1, 2, count), F)
        knots *= np.array((options.vx_std, options.wz_std), F)[:, None]
        first, share = np.divmod(np.arange(steps), hold)
        noise = knots[first]
        noise += (knots[first + 1] - noise) * (share / hold).astype(F)[:, None, None]
        noise[:, :, 0] = 0.0  # the sequence itself is one of them
        return noise

    def _rates(self) -> tuple[Singles, Singles]:
        """Return by how much both speeds may rise and fall in a step."""
        options = self.options
        rise = np.array([[options.ax_max], [options.az_max]], F) * F(options.model_dt)
        fall = np.array([[abs(options.ax_min)], [options.az_max]], F) * F(options.model_dt)
        return rise, fall

    def _within(self, sequence: Singles) -> Singles:
        options = self.options
        low = np.array((options.vx_min, -options.wz_max), F)
        return np.clip(sequence, low, np.array((options.vx_max, options.wz_max), F))

    def _smoothed(self, sequence: Singles) -> Singles:
        """Return a sequence smoothed along time, together with the commands before it."""
        whole = np.concatenate((self._past, sequence, np.repeat(sequence[-1:], _MARGIN, axis=0)))
        smooth = np.zeros_like(sequence)
        for shift, weight in enumerate(_SMOOTHING):
            smooth += whole[shift : shift + len(sequence)] * weight
        return smooth

    def _feasible(self, sequence: Singles, speed: tuple[float, float]) -> Singles:
        """Return a sequence within the limits of speed and acceleration, from the present speed on."""
        options, dt = self.options, self.options.model_dt
        rise, fall, turn = options.ax_max * dt, abs(options.ax_min) * dt, options.az_max * dt
        v, w = map(float, speed)
        found = []
        for next_v, next_w in self._within(sequence).tolist():
            v = min(max(next_v, v - fall), v + rise)
            w = min(max(next_w, w - turn), w + turn)
            found.append((v, w))
        return np.array(found, F)

    def _command(self, pose: Pose, is_valid: bool) -> Command:
        if not is_valid:
            self.reset()
            return Command(0.0, 0.0, False, np.array([pose], np.float64))
        first = self._sequence[0].copy()
        self._past = np.concatenate((self._past[1:], first[None]))
        self._shift()
        return Command(float(first[0]), float(first[1]), True, self._trajectory)

    def _shift(self) -> None:
        """Move the sequence on by the period of control, which may be less than a step of the model."""
        share = F(min(1.0, self._period / self.options.model_dt))
        following = np.concatenate((self._sequence[1:], self._sequence[-1:]))
        self._sequence = self._sequence + (following - self._sequence) * share


def _fan(options: Options) -> Singles:
    """Return plain ways to drive, each a speed ahead, a turning speed at first and one later."""
    turns = np.linspace(-1.0, 1.0, 7) * min(options.wz_max, 1.4)
    ways = [(0.0, 0.0, 0.0), (options.vx_min / 2, 0.0, 0.0)]
    ways += [(0.0, turn, turn) for turn in turns if turn]
    for share in (1.0, 0.5):
        ways += [(options.vx_max * share, first, then) for first in turns * share for then in turns * share]
    return np.array(ways, F)


def integrated(pose: Pose, v: Singles, w: Singles, dt: float) -> tuple[Singles, Singles, Singles]:
    """Return where speeds lead: x, y and theta after each step, of the shape of `v`, in which steps are rows."""
    theta = w * F(dt)
    middle = theta * F(-0.5)
    middle += summed(theta, math.remainder(pose.theta, math.tau))
    cos, sin = cos_and_sin(middle)
    way = v * F(dt)
    cos *= way
    sin *= way
    return summed(cos, pose.x), summed(sin, pose.y), theta


def _led(pose: Pose, sequence: Singles, dt: float) -> Floats:
    """Return the poses to which one sequence leads, of shape (steps, 3)."""
    x, y, theta = pose
    poses = []
    for v, w in sequence.tolist():
        middle = theta + w * dt / 2
        x, y, theta = x + v * dt * math.cos(middle), y + v * dt * math.sin(middle), theta + w * dt
        poses.append((x, y, theta))
    return np.array(poses)
