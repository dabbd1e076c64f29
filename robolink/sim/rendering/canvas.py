"""Canvas of a camera, the noise on it, and the pixels of a message made of it."""

from __future__ import annotations

import hashlib
import math
from statistics import NormalDist

import numpy as np

from robolink.sim.rendering.pinhole import Array, Bytes, Floats, Packed, Pinhole


class Canvas:
    """Buffers of (rows, columns): `inverse` depth in 1/m, 0 where nothing is, and packed `colours`."""

    def __init__(self, pinhole: Pinhole) -> None:
        shape = pinhole.height, pinhole.width
        self.inverse: Floats = np.zeros(shape, dtype=np.float32)
        self.colours: Packed = np.zeros(shape, dtype=np.uint32)

    def clear(self, sky: int) -> None:
        """Make all pixels sky, a packed colour, without an end."""
        self.inverse.fill(0.0)
        self.colours.fill(sky)


# Noise of an image: for each value a table of 256 equally likely readings, of which a random byte chooses one.
#
# So it costs a look-up for each byte of an image, a twentieth of what normal numbers would.


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


CHANNELS = {"rgb8": (0, 1, 2), "bgr8": (2, 1, 0), "rgba8": (0, 1, 2, 3), "bgra8": (2, 1, 0, 3), "mono8": ()}
"""Encodings of images: for each the byte of a packed colour in each of its channels; grey is none of them."""

_GREY = (9798, 19235, 3735)
"""Weights of red, green and blue in grey, of 2**15: those of OpenCV."""


def channels(encoding: str) -> int:
    """Return the number of bytes of a pixel. Raises KeyError for an unknown encoding."""
    return len(CHANNELS[encoding]) or 1


def write_colours(colours: Packed, encoding: str, image: Bytes) -> None:
    """Write packed colours (rows, columns) in an encoding to `image`, an array (rows, columns, channels)."""
    parts = colours.view(np.uint8).reshape(*colours.shape, 4)
    if encoding == "mono8":
        red, green, blue = (
            parts[..., channel].astype(np.uint32) * np.uint32(weight) for channel, weight in enumerate(_GREY)
        )
        image[..., 0] = (red + green + blue + np.uint32(1 << 14)) >> np.uint32(15)
        return
    for channel, part in enumerate(CHANNELS[encoding]):
        image[..., channel] = parts[..., part]


def write_depths(inverse: Floats, nearest: float, farthest: float, depths: Floats) -> None:
    """Write the depths of inverse ones as REP 118 has them: +inf beyond the farthest, -inf before the nearest."""
    depths.fill(np.inf)
    np.divide(np.float32(1.0), inverse, out=depths, where=inverse >= np.float32(1.0 / farthest))
    np.copyto(depths, np.float32(-np.inf), where=inverse > np.float32(1.0 / nearest))
