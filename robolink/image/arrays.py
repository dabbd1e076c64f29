"""Images of messages as numpy arrays, and arrays as messages."""

from __future__ import annotations

import sys
from array import array
from typing import Any

import numpy as np

from robolink.image.codecs import decoded
from robolink.image.conversion import Pixels, convert
from robolink.image.encodings import PASSTHROUGH, Encoding, ImageError, encoding_of, encoding_of_array
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.system.terminal import shown

COMMON = {("8U", 1): "mono8", ("8U", 3): "bgr8", ("8U", 4): "bgra8", ("16U", 3): "bgr16", ("16U", 4): "bgra16"}
"""Encodings of arrays that come without one, by depth and channels: OpenCV's order of colours."""


def to_array(message: Any, encoding: str = "passthrough") -> Pixels:
    """Return an image as a numpy array of (rows, columns) or (rows, columns, channels), which can be drawn on.

    Args:
        message: A sensor_msgs Image, or a CompressedImage (that needs OpenCV).
        encoding: The wanted encoding: ``bgr8`` for OpenCV, ``rgb8`` for matplotlib, ``mono8`` for grey;
            ``passthrough``, the default, converts nothing: distances of a depth camera stay metres.

    Raises:
        ImageError: if the message contradicts itself, or cannot be converted.
    """
    if isinstance(message, CompressedImage):
        return decompressed(message, encoding)
    image = raw_array(message)
    return image if encoding in PASSTHROUGH else convert(image, message.encoding, encoding)


def to_message(image: Pixels, encoding: str = "", header: Header | None = None) -> Image:
    """Return a numpy array as an image that can be published.

    Args:
        image: Array of (rows, columns) or (rows, columns, channels).
        encoding: What the array is. '', the default, takes three channels of 8 or 16 bits for blue, green and red, as
            OpenCV has them, four for these and alpha, one of 8 bits for grey, and all else for numbers (``32FC1``).
        header: Stamp and frame; None leaves them empty.

    Raises:
        ImageError: if no image is like this array, or the encoding is of another type.
    """
    found = encoding_of_array(_checked(image))
    if not encoding:
        encoding = COMMON.get((found.depth, found.channels), found.name)
    return raw_message(image, found, encoding, header)


def raw_array(message: Image) -> Pixels:
    """Return the pixels of an image as they are, in the machine's byte order.

    The array shares the message's memory, as with cv_bridge, unless rows are padded or the byte order is another.
    Raises ImageError if the message contradicts itself.
    """
    _check_type(message, Image)
    encoding = encoding_of(message.encoding)
    kind, channels = encoding.dtype, encoding.channels
    height, width, step = _size(message)
    data: Any = message.data  # an array, as in rclpy
    if step < width * channels * kind.itemsize or len(data) < height * step:
        raise ImageError(
            f"Image is wrongly formed: {width} x {height} pixels of {encoding.name} are {height} rows of at least"
            f" {width * channels * kind.itemsize} bytes; it has a step of {step} and {len(data)} bytes"
        )
    order = kind.newbyteorder(">" if message.is_bigendian else "<")
    strides = (step, channels * kind.itemsize, kind.itemsize)
    image: Pixels = np.ndarray((height, width, channels), order, data, strides=strides)
    if channels == 1:
        image = image[..., 0]
    if image.dtype != kind:
        return image.astype(kind)
    return np.ascontiguousarray(image)


def raw_message(image: Pixels, found: Encoding, encoding: str, header: Header | None = None) -> Image:
    """Return an array as an image of an encoding. Raises ImageError if the array is of another type.

    Args:
        image: The array.
        found: The encoding of its type.
        encoding: The encoding that the message names.
        header: Stamp and frame; None leaves them empty.
    """
    expected = encoding_of(encoding)
    if (expected.depth, expected.channels) != (found.depth, found.channels):
        raise ImageError(f"encoding specified as {encoding}, but image has incompatible type {found.cv_type}")
    message = Image(height=image.shape[0], width=image.shape[1], encoding=encoding)
    if header is not None:
        message.header = header
    message.is_bigendian = int(image.dtype.byteorder == ">" or (sys.byteorder == "big" and image.dtype.isnative))
    message.step = image.shape[1] * found.channels * image.dtype.itemsize
    message.data = array("B")
    message.data.frombytes(np.ascontiguousarray(image).reshape(-1).view(np.uint8).data)
    return message


def decompressed(message: CompressedImage, encoding: str = "passthrough") -> Pixels:
    """Return the pixels of a compressed image; by default in the file's depth, and in OpenCV's order of colours.

    Args:
        message: The message.
        encoding: The wanted encoding.

    Raises:
        ImageError: without OpenCV, for bytes that are not a picture, and if it cannot be converted.
    """
    _check_type(message, CompressedImage)
    image, coded = decoded(np.asarray(message.data, np.uint8))
    return image if encoding in PASSTHROUGH else convert(image, coded, encoding)


def _checked(image: Any) -> Pixels:
    if not isinstance(image, np.ndarray | np.generic):
        raise ImageError(f"Your input type is not a numpy array, but {type(image).__name__}")
    return image  # type: ignore[return-value]


def _check_type(message: Any, expected: type[Any]) -> None:
    if isinstance(message, expected):
        return
    found = getattr(message, "__ros_type__", "") or type(message).__name__
    hint = ": compressed_imgmsg_to_cv2 reads it" if isinstance(message, CompressedImage) else ""
    raise ImageError(f"expected a message of {expected.__ros_type__}, got {shown(found, 60)}{hint}")


def _size(message: Image) -> tuple[int, int, int]:
    size = (message.height, message.width, message.step)
    if all(isinstance(each, int | np.integer) and each >= 0 for each in size):
        return int(size[0]), int(size[1]), int(size[2])
    raise ImageError(f"height, width and step are counts, not {shown(str(size), 80)}")
