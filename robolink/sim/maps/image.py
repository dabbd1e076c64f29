"""What an image is, whatever file it was in: shades of gray as an array, and what makes one too large."""

from __future__ import annotations

from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from robolink.exceptions import RobolinkError

Shades: TypeAlias = npt.NDArray[np.uint8]

MOST_PIXELS = 100_000_000
"""What an image may have: 10,000 x 10,000, half a kilometre each way at 5 cm."""


class ImageError(RobolinkError, ValueError):
    """A file that is no image, or none that can be read here; the text says what is wrong with it."""


class Image(NamedTuple):
    """An image's shades, 0 black to 255 white, first row at the top; and where one can see through it, if anywhere."""

    shades: Shades
    transparent: npt.NDArray[np.bool_] | None = None


def check_size(width: int, height: int) -> None:
    """Refuse an image without pixels, or with absurdly many, before memory is taken for them."""
    if not 0 < width * height <= MOST_PIXELS:
        raise ImageError(f"{width} x {height} pixels: expected 1 to {MOST_PIXELS // 10**6} million")


def eight_bits(values: npt.NDArray[Any], largest: int) -> Shades:
    """Bring values of 0 to `largest` to 0 to 255."""
    if largest == 255:
        return values.astype(np.uint8)
    shades: Shades = np.round(np.arange(largest + 1) * (255.0 / largest)).astype(np.uint8)[values]
    return shades
