"""Recognition of objects by a Webots camera: areas of one colour in its image, with their places if it has depths."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.image.blobs import Blob, find_blobs

Depths = npt.NDArray[np.float32]


class Lens(NamedTuple):
    """Calibration of a camera without distortion: focal length, and principal point, all in pixels."""

    focal: float
    column: float
    row: float


class CameraRecognitionObject:
    """An object that a camera has recognized, under Webots' names.

    Args:
        number: Its number, the same from image to image while it stays in view.
        blob: Its area in the image.
        position: Metres ahead of the camera, to its left and upwards; NaN if the camera has no depths.
        size: Metres across and upwards; NaN if the camera has no depths.
    """

    def __init__(
        self, number: int, blob: Blob, position: tuple[float, float, float], size: tuple[float, float]
    ) -> None:
        self.blob = blob
        self._number, self._position, self._size = number, position, size

    def getId(self) -> int:
        """Return the object's number, the same from image to image while it stays in view."""
        return self._number

    def getModel(self) -> str:
        """Return the name of its hue: red, yellow, green, cyan, blue or magenta."""
        return self.blob.hue

    def getPosition(self) -> list[float]:
        """Return metres ahead of the camera, to its left and upwards; NaN if the camera has no depths."""
        return list(self._position)

    def getOrientation(self) -> list[float]:
        """Return a turn by nothing, as axis and angle: how an object is turned cannot be seen by its colour."""
        return [0.0, 0.0, 1.0, 0.0]

    def getSize(self) -> list[float]:
        """Return metres across and upwards; NaN if the camera has no depths."""
        return list(self._size)

    def getPositionOnImage(self) -> list[int]:
        """Return the column and row of its middle."""
        return list(self.blob.centre)

    def getSizeOnImage(self) -> list[int]:
        """Return its width and height in pixels."""
        return [self.blob.width, self.blob.height]

    def getNumberOfColors(self) -> int:
        """Return 1."""
        return 1

    def getColors(self) -> list[float]:
        """Return the mean of its red, green and blue, 0 to 1."""
        return [channel / 255 for channel in self.blob.colour]


class Recognizer:
    """Recognizes objects in images one after another, and numbers them."""

    def __init__(self) -> None:
        self.objects: list[CameraRecognitionObject] = []
        """The objects of the last image, the largest first."""
        self._next = 1

    def look(self, image: npt.NDArray[np.uint8], depths: Depths | None, lens: Lens | None) -> None:
        """Recognize the objects of an image.

        Args:
            image: Array of (rows, columns, 3) in the order red, green, blue.
            depths: Metres ahead of each pixel, of the same rows and columns; None for none.
            lens: The camera's calibration; None if it is not known.
        """
        left = list(self.objects)
        self.objects = [self._object(blob, left, depths, lens) for blob in find_blobs(image)]

    def _object(
        self, blob: Blob, left: list[CameraRecognitionObject], depths: Depths | None, lens: Lens | None
    ) -> CameraRecognitionObject:
        """Return the object of a blob, with the number that it had; `left` are those not found again yet."""
        known = next((each for each in left if each.blob.hue == blob.hue and _overlap(each.blob, blob)), None)
        if known is not None:
            left.remove(known)
            number = known.getId()
        else:
            number, self._next = self._next, self._next + 1
        depth = math.nan if depths is None or lens is None else _depth(depths, blob)
        if lens is None or not math.isfinite(depth):
            return CameraRecognitionObject(number, blob, (math.nan,) * 3, (math.nan,) * 2)
        across, down = (blob.centre[0] - lens.column) / lens.focal, (blob.centre[1] - lens.row) / lens.focal
        size = blob.width * depth / lens.focal, blob.height * depth / lens.focal
        return CameraRecognitionObject(number, blob, (depth, -across * depth, -down * depth), size)


def _overlap(one: Blob, other: Blob) -> bool:
    """True if the boxes of two blobs have pixels in common."""
    across = max(one.left, other.left) < min(one.left + one.width, other.left + other.width)
    return across and max(one.top, other.top) < min(one.top + one.height, other.top + other.height)


def _depth(depths: Depths, blob: Blob) -> float:
    """Return the depth of the middle of a blob, in metres; inf if there is nothing, NaN if the image is another's."""
    column, row = blob.centre
    if row >= depths.shape[0] or column >= depths.shape[1]:
        return math.nan
    return float(depths[row, column])
