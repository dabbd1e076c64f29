"""Webots' cameras and range finders, from the image topics of a simulated robot."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from robolink.image import ImageError, to_array
from robolink.image.blobs import Blob, find_blobs
from robolink.image.codecs import encoded, png_of
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image
from robolink.subscription import Subscription
from robolink.webots_controller.sensors import Sensor

Depths = npt.NDArray[np.float32]

ValueT = TypeVar("ValueT")


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


class ImageSensor(Sensor[Image], Generic[ValueT]):
    """Base class of cameras: an image of `width` times `height` values of the type that a program reads."""

    message = Image
    folder = ""
    """Part of the topic's name between the device's name and image_raw."""

    def __init__(self, topics: Any, name: str) -> None:
        super().__init__(topics, name)
        self._shown: tuple[Image | None, ValueT | None] = (None, None)
        self._info: CameraInfo | None = None
        self._infos: Subscription[CameraInfo] | None = None

    @classmethod
    def topic_of(cls, name: str) -> str:
        """Return the name of the image topic of a device."""
        return f"{name}{cls.folder}/image_raw"

    def disable(self) -> None:
        """Disable the sensor."""
        super().disable()
        self._shown = (None, None)

    def getWidth(self) -> int:
        """Return the columns of an image; 0 until the world is heard."""
        info = self._calibration()
        return info.width if info else 0

    def getHeight(self) -> int:
        """Return the rows of an image; 0 until the world is heard."""
        info = self._calibration()
        return info.height if info else 0

    def getFov(self) -> float:
        """Return the horizontal field of view in radians; NaN until the world is heard."""
        info = self._calibration()
        return 2.0 * math.atan(info.width / 2 / info.k[0]) if info else math.nan

    def _subscribe(self) -> None:
        self._calibration()
        super()._subscribe()

    def _calibration(self) -> CameraInfo | None:
        """Return the camera's calibration, once it has come."""
        if self._infos is None:
            topic = self._topics.find(CameraInfo, f"{self._name}{self.folder}/camera_info", or_only=False)
            if topic:
                name = f"{self._topics.prefix}{topic}"
                self._infos = self._topics.node.create_subscription(CameraInfo, name, self._on_info, 1)
        return self._info

    def _on_info(self, info: CameraInfo) -> None:
        self._info = info

    def _converted(self) -> ValueT | None:
        """Return the latest image as programs read it; None before the first."""
        latest = self.latest
        if latest is not self._shown[0]:
            self._shown = (latest, None if latest is None else self._convert(latest))
        return self._shown[1]

    def _convert(self, image: Image) -> ValueT:
        raise NotImplementedError


class Camera(ImageSensor[bytes]):
    """A camera of colours, which recognizes objects by their colours."""

    def __init__(self, topics: Any, name: str) -> None:
        super().__init__(topics, name)
        self._recognizer: Recognizer | None = None
        self._recognition_period = 0
        self._recognized: Image | None = None
        self._depth = RangeFinder(topics, name)

    def getImage(self) -> bytes | None:
        """Return the bytes of the pixels, row by row: blue, green, red and alpha of each; None before the first."""
        return self._converted()

    def getImageArray(self) -> list[list[list[int]]]:
        """Return the red, green and blue of each pixel, as lists by column and row; empty before the first image."""
        latest = self.latest
        if latest is None:
            return []
        columns: list[list[list[int]]] = to_array(latest, "rgb8").swapaxes(0, 1).tolist()
        return columns

    def saveImage(self, filename: str, quality: int) -> int:
        """Write the latest image to a file, .png or .jpg.

        Args:
            filename: The file.
            quality: Quality of a JPEG, of which nothing is made here.

        Returns:
            0, or -1 if there is no image yet, or it could not be written.
        """
        latest = self.latest
        if latest is None:
            return -1
        try:
            if Path(filename).suffix.lower() in {".jpg", ".jpeg"}:
                data = encoded(to_array(latest, "bgr8"), "jpg")
            else:
                data = png_of(to_array(latest, "rgb8"))
            Path(filename).write_bytes(data)
        except (ImageError, OSError):
            return -1
        return 0

    def hasRecognition(self) -> bool:
        """Return True: each camera recognizes areas of one hue, red, yellow, green, cyan, blue or magenta."""
        return True

    def recognitionEnable(self, samplingPeriod: int) -> None:
        """Begin to recognize objects in the images of the camera, which must be enabled too."""
        self._recognition_period = int(samplingPeriod)
        self._recognizer, self._recognized = Recognizer(), None
        self._depth.enable(samplingPeriod)

    def recognitionDisable(self) -> None:
        """End recognizing objects."""
        self._recognition_period, self._recognizer = 0, None
        self._depth.disable()

    def getRecognitionSamplingPeriod(self) -> int:
        """Return the sampling period of recognition in ms; 0 if disabled."""
        return self._recognition_period

    def getRecognitionNumberOfObjects(self) -> int:
        """Return the number of objects in the latest image."""
        return len(self.getRecognitionObjects())

    def getRecognitionObjects(self) -> list[CameraRecognitionObject]:
        """Return the objects in the latest image, the largest first; none before the first image, or if disabled."""
        latest, recognizer = self.latest, self._recognizer
        if latest is None or recognizer is None:
            return []
        if latest is not self._recognized:
            self._recognized = latest
            recognizer.look(to_array(latest, "rgb8"), self._depth.depths(), self._lens())
        return list(recognizer.objects)

    def _lens(self) -> Lens | None:
        info = self._calibration()
        return None if info is None else Lens(info.k[0], info.k[2], info.k[5])

    @staticmethod
    def imageGetRed(image: bytes, width: int, x: int, y: int) -> int:
        """Return the red of a pixel of `getImage`, 0 to 255."""
        return image[4 * (y * width + x) + 2]

    @staticmethod
    def imageGetGreen(image: bytes, width: int, x: int, y: int) -> int:
        """Return the green of a pixel of `getImage`, 0 to 255."""
        return image[4 * (y * width + x) + 1]

    @staticmethod
    def imageGetBlue(image: bytes, width: int, x: int, y: int) -> int:
        """Return the blue of a pixel of `getImage`, 0 to 255."""
        return image[4 * (y * width + x)]

    @staticmethod
    def imageGetGray(image: bytes, width: int, x: int, y: int) -> int:
        """Return the mean of red, green and blue of a pixel of `getImage`, 0 to 255."""
        place = 4 * (y * width + x)
        return sum(image[place : place + 3]) // 3

    @staticmethod
    def imageGetGrey(image: bytes, width: int, x: int, y: int) -> int:
        """Return the same as `imageGetGray`."""
        return Camera.imageGetGray(image, width, x, y)

    def _convert(self, image: Image) -> bytes:
        return to_array(image, "bgra8").tobytes()


class RangeFinder(ImageSensor[list[float]]):
    """A camera of depths in metres: inf beyond its range, 0 before it."""

    folder = "/depth"

    def getRangeImage(self, data_type: str = "list") -> Any:
        """Return the depth of each pixel, row by row; empty before the first image.

        Args:
            data_type: `list`, or `buffer` for the bytes of 32-bit numbers.

        Raises:
            ValueError: for another type.
        """
        if data_type not in {"list", "buffer"}:
            raise ValueError(f"data_type is 'list' or 'buffer', not '{data_type}'")
        depths = self._converted() or []
        return depths if data_type == "list" else np.array(depths, dtype=np.float32).tobytes()

    def getRangeImageArray(self) -> list[list[float]]:
        """Return the depth of each pixel, as lists by column and row; empty before the first image."""
        depths, latest = self._converted(), self.latest
        if depths is None or latest is None:
            return []
        return [depths[column :: latest.width] for column in range(latest.width)]

    @staticmethod
    def rangeImageGetDepth(image: list[float], width: int, x: int, y: int) -> float:
        """Return the depth of a pixel of `getRangeImage` in metres."""
        return image[y * width + x]

    def depths(self) -> npt.NDArray[np.float32] | None:
        """Return the depths of the latest image, an array of (rows, columns) in metres; None before the first."""
        latest = self.latest
        return None if latest is None else np.asarray(to_array(latest), dtype=np.float32)

    def _convert(self, image: Image) -> list[float]:
        depths: list[float] = np.maximum(to_array(image), 0.0).ravel().tolist()
        return depths
