"""Noise of an image: for each value a table of 256 equally likely readings, of which a random byte chooses one.

So it costs a look-up for each byte of an image, a twentieth of what normal numbers would.
"""

from __future__ import annotations

import hashlib
import math
from statistics import NormalDist

import numpy as np

from robolink.sim.rendering.arrays import Array, Bytes

_DIGITS = 6
"""Decimals of the quantiles: logarithms in them differ between machines in the last bit, which rounding removes."""


class ImageNoise:
    """Gaussian noise of a camera; each image has its own random bytes, whichever other images are made.

    Args:
        deviation: Standard deviation, in units of a byte.
        key: Text from which all random numbers follow: seed, robot and camera.
    """

    def __init__(self, deviation: float, key: str) -> None:
        values, errors = np.arange(256)[:, None], deviation * _errors()
        self._table: Bytes = np.clip(np.floor(values + errors + 0.5), 0, 255).astype(np.uint8).reshape(-1)
        self._key = key

    def disturb(self, image: Bytes, number: int) -> None:
        """Add noise to a contiguous image, in place; `number` is which image of the camera it is."""
        digest = hashlib.sha256(f"{self._key}/{number}".encode()).digest()
        random = np.random.PCG64(int.from_bytes(digest[:16], "little"))
        flat = image.reshape(-1)
        drawn = random.random_raw((flat.size + 7) // 8).astype("<u8").view(np.uint8)[: flat.size]
        place = flat.astype(np.uint16)
        place <<= 8
        place |= drawn
        self._table.take(place, out=flat, mode="clip")


def _errors() -> Array:
    """Return 256 equally likely normal errors with a mean of 0 and a standard deviation of 1, the least first."""
    normal = NormalDist()
    upper = [round(normal.inv_cdf((number + 0.5) / 256), _DIGITS) for number in range(128, 256)]
    deviation = math.sqrt(math.fsum(each * each for each in upper) / 128)
    return np.array([-each for each in reversed(upper)] + upper) / deviation
