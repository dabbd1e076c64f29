"""Type aliases of the renderer's arrays, and vectors in space as rows x, y and z."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

Array: TypeAlias = "npt.NDArray[np.float64]"
Floats: TypeAlias = "npt.NDArray[np.float32]"
Indices: TypeAlias = "npt.NDArray[np.intp]"
Columns: TypeAlias = "npt.NDArray[np.int16]"
Places: TypeAlias = "npt.NDArray[np.int32]"
Bytes: TypeAlias = "npt.NDArray[np.uint8]"
Flags: TypeAlias = "npt.NDArray[np.bool_]"

Packed: TypeAlias = "npt.NDArray[np.uint32]"
"""Colours of pixels: the bytes red, green, blue and 255, in this order in memory."""


def packed(colours: Bytes) -> Packed:
    """Pack colours, an array (..., 3) of red, green and blue, to an array (...)."""
    whole = np.full((*colours.shape[:-1], 4), 255, dtype=np.uint8)
    whole[..., :3] = colours
    return whole.view(np.uint32)[..., 0]


def cross(a: Array, b: Array) -> Array:
    """Return the cross products of vectors, arrays (3, n)."""
    return np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def dot(a: Array, b: Array) -> Array:
    """Return the scalar products of vectors, arrays (3, n); not by BLAS, whose bits differ between machines."""
    products: Array = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return products
