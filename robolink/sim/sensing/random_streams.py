"""Seeded noise: one random stream for each (seed, robot, sensor), so that adding a robot changes no other's."""

from __future__ import annotations

import hashlib

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.sensors import Lidar


def stream(seed: int, robot: str, sensor: str) -> np.random.Generator:
    """Return the random stream of one sensor of one robot; the same on every machine and in every process."""
    digest = hashlib.sha256(f"{seed}/{robot}/{sensor}".encode()).digest()
    return np.random.Generator(np.random.PCG64(int.from_bytes(digest[:16], "little")))


class LidarNoise:
    """Gaussian noise and lost returns; each scan draws the same count of numbers, whatever the beams hit."""

    def __init__(self, lidar: Lidar, random: np.random.Generator) -> None:
        self._noise, self._dropout, self._random = lidar.noise, lidar.dropout, random

    def disturbed(self, ranges: Array) -> Array:
        """Return the ranges as this scanner reads them; a lost beam is inf."""
        if self._noise:
            ranges = ranges + self._noise * self._random.standard_normal(len(ranges))
        if self._dropout:
            ranges = np.where(self._random.random(len(ranges)) < self._dropout, np.inf, ranges)
        return ranges
