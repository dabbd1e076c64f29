"""Errors of odometry: systematic ones and noise, computed for many steps at once."""

from __future__ import annotations

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.description import Odom

BLOCK = 256
"""Number of steps whose errors are drawn at once, which is cheaper than one by one."""

COLUMNS = 4
"""Numbers of a step: factors of the speeds v, s and w, and the turn in rad for each metre ahead."""


class OdometryErrors:
    """The errors of one robot's odometry, for each step: factors of its speeds v, s and w, and its drift in rad/m.

    The factors are the scale times the noise, which is drawn anew at each step.
    """

    def __init__(self, odom: Odom, random: np.random.Generator) -> None:
        noise, scale = odom.noise, odom.scale
        self._shares, self._random = np.array((noise.v, noise.v, noise.w)), random
        self._scale, self._drift = np.array((scale.v, scale.v, scale.w)), odom.drift
        self._number, self._block = -1, np.ones((0, COLUMNS))
        self._rows: list[tuple[float, float, float, float]] = []

    def block(self, step: int) -> Array:
        """Return the errors of the block of `BLOCK` steps that holds `step`, as rows; steps only increase."""
        if step // BLOCK != self._number:
            self._number = step // BLOCK
            self._block = np.empty((BLOCK, COLUMNS))
            self._block[:, :3] = self._scale * (1.0 + self._shares * self._random.standard_normal((BLOCK, 3)))
            self._block[:, 3] = self._drift
            self._rows = []
        return self._block

    def at(self, step: int) -> tuple[float, float, float, float]:
        """Return the errors of one step."""
        block = self.block(step)
        if not self._rows:
            self._rows = [(v, s, w, drift) for v, s, w, drift in block.tolist()]
        return self._rows[step % BLOCK]
