"""Noise of odometry: factors of its speeds, drawn for many steps at once."""

from __future__ import annotations

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.description import OdomNoise

BLOCK = 256
"""Number of steps whose errors are drawn at once, which is cheaper than one by one."""


class OdometryErrors:
    """The errors of one robot's odometry: factors of its speeds v, s and w, drawn for each step."""

    def __init__(self, noise: OdomNoise, random: np.random.Generator) -> None:
        self._shares, self._random = np.array((noise.v, noise.v, noise.w)), random
        self._number, self._block = -1, np.ones((0, 3))
        self._rows: list[tuple[float, float, float]] = []

    def block(self, step: int) -> Array:
        """Return the errors of the block of `BLOCK` steps that holds `step`, as rows; steps only increase."""
        if step // BLOCK != self._number:
            self._number = step // BLOCK
            self._block = 1.0 + self._shares * self._random.standard_normal((BLOCK, 3))
            self._rows = []
        return self._block

    def at(self, step: int) -> tuple[float, float, float]:
        """Return the errors of one step."""
        block = self.block(step)
        if not self._rows:
            self._rows = [(v, s, w) for v, s, w in block.tolist()]
        return self._rows[step % BLOCK]
