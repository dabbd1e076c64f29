"""The pinhole camera: its focal length and pixels, and where it stands and looks.

Pixel centres have whole numbers, as in OpenCV: the principal point of an image is ((width - 1) / 2, (height - 1) / 2).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from robolink.sim.rendering.arrays import Array
from robolink.sim.trigonometry import cos_and_sin_of


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
