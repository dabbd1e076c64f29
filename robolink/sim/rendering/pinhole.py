"""Pinhole camera: its rays, and the renderer's arrays and vectors in space as rows x, y and z."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from robolink.geometry.trigonometry import cos_and_sin_of

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


# The pinhole camera: its focal length and pixels, and where it stands and looks.
#
# Pixel centres have whole numbers, as in OpenCV: the principal point of an image is ((width - 1) / 2, (height - 1)
# / 2).


class Pinhole:
    """A camera without distortion, of square pixels.

    Args:
        width: Columns of an image.
        height: Rows of an image.
        fov: Horizontal field of view in degrees, between the outer edges of the first and last column.
    """

    def __init__(self, width: int, height: int, fov: float) -> None:
        self.width, self.height = width, height
        cos, sin = cos_and_sin_of(math.radians(fov / 2))
        self.focal = width / 2 * (cos / sin)
        """Focal length in pixels."""
        self.centre = (width - 1) / 2, (height - 1) / 2
        """Principal point: column and row."""
        self.columns: Array = np.arange(width, dtype=np.float64) - self.centre[0]
        """Columns from the principal point, in pixels."""
        self.rows: Array = np.arange(height, dtype=np.float64) - self.centre[1]
        """Rows from the principal point, in pixels."""


class View(NamedTuple):
    """Place of a camera in the world, and its axes.

    Args:
        position: x, y, z in metres.
        axes: Unit vectors in the world: to the right in the image, down in it, and ahead.
    """

    position: tuple[float, float, float]
    axes: Array

    def seen(self, vectors: Array) -> Array:
        """Return vectors of the world, an array (3, n), along the camera's axes."""
        of_x, of_y, of_z = self.axes.T[:, :, None]
        seen: Array = vectors[0] * of_x + vectors[1] * of_y + vectors[2] * of_z
        return seen

    def seen_points(self, points: Array) -> Array:
        """Return points of the world, an array (3, n), in the camera's frame."""
        return self.seen(points - np.array(self.position)[:, None])


def view_from(position: tuple[float, float, float], yaw: float, pitch: float) -> View:
    """Return the view of a camera that looks ahead along `yaw` (radians from the x axis), `pitch` radians downwards."""
    (cy, sy), (cp, sp) = cos_and_sin_of(yaw), cos_and_sin_of(pitch)
    return View(position, np.array(((sy, -cy, 0.0), (-sp * cy, -sp * sy, -cp), (cy * cp, sy * cp, -sp))))
