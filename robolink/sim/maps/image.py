"""What an image is, whatever file it was in: shades of gray as an array, and what makes one too large."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from robolink.exceptions import RobolinkError

Shades: TypeAlias = npt.NDArray[np.uint8]

MOST_PIXELS = 25_000_000
"""What an image may have: 5,000 x 5,000, a quarter of a kilometre each way at 5 cm."""
MOST_BYTES = 50_000_000
"""What its pixels may take as they are stored, unpacked: 16 bits of gray for all of them, colours for fewer."""
_BLOCK = 1_000_000
"""Pixels that are converted at once, since numpy takes eight bytes for each meanwhile."""


class ImageError(RobolinkError, ValueError):
    """A file that is no image, or none that can be read here; the text says what is wrong with it."""


class Image(NamedTuple):
    """An image's shades, 0 black to 255 white, first row at the top; and where one can see through it, if anywhere."""

    shades: Shades
    transparent: npt.NDArray[np.bool_] | None = None


def check_size(width: int, height: int, bits: int = 8) -> None:
    """Refuse an image without pixels, or with too many (of so many bits each), before memory is taken for them."""
    if not 0 < width * height <= MOST_PIXELS:
        raise ImageError(f"{width} x {height} pixels: expected 1 to {MOST_PIXELS // 10**6} million")
    if width * height * bits > 8 * MOST_BYTES:
        most = f"at most {MOST_BYTES // 10**6} MB"
        raise ImageError(f"{width} x {height} pixels of {bits} bits: {most}, so save it in 8 bits of gray")


def in_blocks(convert: Callable[[npt.NDArray[Any]], Shades], samples: npt.NDArray[Any]) -> Shades:
    """Convert an image (line, column, channel) to shades (line, column), some lines at a time."""
    height, width = samples.shape[:2]
    result = np.empty((height, width), np.uint8)
    lines = max(1, _BLOCK // width)
    for first in range(0, height, lines):
        result[first : first + lines] = convert(samples[first : first + lines])
    return result


def eight_bits(values: npt.NDArray[Any], largest: int) -> Shades:
    """Bring values of 0 to `largest` to 0 to 255."""
    if largest == 255:
        return values.astype(np.uint8, copy=False)
    shades: Shades = np.round(np.arange(largest + 1) * (255.0 / largest)).astype(np.uint8)[values]
    return shades
