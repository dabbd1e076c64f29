"""Gray images as arrays, whatever file they were in, and limits of their size."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from robolink.exceptions import RobolinkError

Shades: TypeAlias = npt.NDArray[np.uint8]

MOST_PIXELS = 25_000_000
"""Most pixels of an image: 5,000 x 5,000, a quarter of a kilometre each way at 5 cm."""
MOST_BYTES = 50_000_000
"""Most bytes of an image's pixels as stored, uncompressed: 16 bits of gray for all of them, colours for fewer."""
LONGEST_SIDE = 65_535
"""Most pixels along a side, as of a JPEG: undoing a PNG's filters takes some calls of numpy for each of them."""
_BLOCK = 1_000_000
"""Number of pixels that are converted at once, since numpy takes eight bytes for each meanwhile."""


class ImageError(RobolinkError, ValueError):
    """A file that is not an image, or none that can be read here; the text says why."""


class Image(NamedTuple):
    """An image: `shades` 0 black to 255 white, first row at the top; `transparent` pixels, None if there are none."""

    shades: Shades
    transparent: npt.NDArray[np.bool_] | None = None


def check_size(width: int, height: int, bits: int = 8) -> None:
    """Raise `ImageError` for an image without pixels or with too many (of `bits` each), before memory is allocated."""
    if not 0 < width * height <= MOST_PIXELS:
        raise ImageError(f"{width} x {height} pixels: expected 1 to {MOST_PIXELS // 10**6} million")
    if max(width, height) > LONGEST_SIDE:
        raise ImageError(f"{width} x {height} pixels: at most {LONGEST_SIDE:,} along a side")
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
    """Scale values of 0 to `largest` to 0 to 255."""
    if largest == 255:
        return values.astype(np.uint8, copy=False)
    shades: Shades = np.round(np.arange(largest + 1) * (255.0 / largest)).astype(np.uint8)[values]
    return shades
