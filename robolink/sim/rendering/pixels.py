"""Pixels of a message from a canvas: colours in an encoding of ROS, and depths."""

from __future__ import annotations

import numpy as np

from robolink.sim.rendering.arrays import Bytes, Floats, Packed

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
