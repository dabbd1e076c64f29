"""Mipmaps: a picture at full, half, quarter ... resolution, so that far away each pixel shows the mean of an area."""

from __future__ import annotations

import numpy as np

from robolink.sim.rendering.arrays import Bytes, Packed, packed

_SMALLEST = 4
"""Smallest side in pixels of a level that is halved again."""


class Level:
    """One resolution of a picture, packed, with a border; pixel i, j of it is `flat[(i + 1) * stride + j + 1]`.

    Args:
        picture: The picture at this resolution.
        scale: Pixels of it for each of the full picture's, along a side.
        border: Packed colour around it; None repeats its edge.
    """

    def __init__(self, picture: Bytes, scale: float, border: int | None) -> None:
        self.scale, (self.rows, self.columns) = scale, picture.shape[:2]
        whole = np.pad(packed(picture), 1, mode="edge")
        if border is not None:
            whole[0], whole[-1], whole[:, 0], whole[:, -1] = (border,) * 4
        self.flat: Packed = whole.reshape(-1)
        self.stride = self.columns + 2


def mipmaps(picture: Bytes, border: int | None = None) -> list[Level]:
    """Return the levels of a picture (rows, columns, 3), the finest first; `border` is that of `Level`."""
    levels = [Level(picture, 1.0, border)]
    while min(picture.shape[:2]) > _SMALLEST:
        picture = _halved(picture)
        levels.append(Level(picture, levels[-1].scale / 2, border))
    return levels


def _halved(picture: Bytes) -> Bytes:
    """Return the means of two by two pixels; an odd last row or column counts twice."""
    rows, columns = picture.shape[:2]
    even = np.pad(picture, ((0, rows % 2), (0, columns % 2), (0, 0)), mode="edge").astype(np.uint16)
    total = even[::2, ::2] + even[1::2, ::2] + even[::2, 1::2] + even[1::2, 1::2]
    return ((total + 2) >> 2).astype(np.uint8)
