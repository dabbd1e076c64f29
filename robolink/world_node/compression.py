"""Compression of camera images to JPEG, by OpenCV if it is installed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.image import ImageError
from robolink.image.codecs import encoded
from robolink.image.conversion import convert
from robolink.interfaces.sensor_msgs.msg import CompressedImage
from robolink.interfaces.std_msgs.msg import Header


class Compression:
    """Makes compressed images; if that fails, it says so once, and makes none.

    Args:
        warn: Function that is called with the one line.
    """

    def __init__(self, warn: Callable[[str], object]) -> None:
        self._warn, self._works = warn, True

    def message(self, image: Any, encoding: str, header: Header) -> CompressedImage | None:
        """Return an image as a JPEG, with the format that image_transport names; None if that cannot be done.

        Args:
            image: Pixels (rows, columns) or (rows, columns, channels).
            encoding: Encoding of the pixels.
            header: Stamp and frame.
        """
        if not self._works:
            return None
        grey = encoding == "mono8"
        try:
            data = encoded(image if grey else convert(image, encoding, "bgr8"), "jpg")
        except ImageError as error:
            self._works = False
            self._warn(f"no compressed images: {error}")
            return None
        form = f"{encoding}; jpeg compressed {'mono8' if grey else 'bgr8'}"
        return CompressedImage(header=header, format=form, data=data)
