"""Class CvBridge of cv_bridge: conversion of image messages to OpenCV's arrays and back."""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from robolink.companions.cv_bridge.functions import CV_MAT_CNWrap, CV_MAT_DEPTHWrap, CvBridgeError, getCvType
from robolink.image.arrays import decompressed, raw_array, raw_message
from robolink.image.codecs import encoded
from robolink.image.conversion import Pixels, convert
from robolink.image.encodings import DEPTHS, DTYPES, PASSTHROUGH, encoding_of, encoding_of_array
from robolink.image.opencv import opencv
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.interfaces.std_msgs.msg import Header

__all__ = ["CvBridge", "CvBridgeError"]

MOST_NAMED = 4
"""Most channels of the types in `CvBridge.cvtype_to_name`."""


class CvBridge:
    """Converter between image messages and the numpy arrays that OpenCV works with.

    `numpy_type_to_cvtype` maps names of numpy's types to OpenCV's depths and back.
    """

    def __init__(self) -> None:
        self.numpy_type_to_cvtype: dict[str, str] = {**DEPTHS, **DTYPES}

    @property
    def cvtype_to_name(self) -> dict[int, str]:
        """Names such as ``8UC3`` by the numbers of the installed OpenCV, which it needs."""
        cv2 = opencv("the number of a type")
        names = [f"{depth}C{channels}" for depth in DTYPES for channels in range(1, MOST_NAMED + 1)]
        return {getattr(cv2, f"CV_{name}"): name for name in names}

    @property
    def cvdepth_to_numpy_depth(self) -> dict[int, str]:
        """Names of numpy's types by the numbers of the installed OpenCV, which it needs."""
        cv2 = opencv("the number of a type")
        return {getattr(cv2, f"CV_{depth}"): name for depth, name in DTYPES.items()}

    def dtype_with_channels_to_cvtype2(self, dtype: np.dtype[Any], n_channels: int) -> str:
        """Return OpenCV's name of a type, ``8UC3``. Raises CvBridgeError for a type of values that it lacks.

        Args:
            dtype: numpy's type of a value.
            n_channels: Number of channels.
        """
        name = np.dtype(dtype).name
        if name not in DEPTHS:
            raise CvBridgeError(f"no encoding has values of {name}, only of {', '.join(DEPTHS)}")
        return f"{DEPTHS[name]}C{n_channels}"

    def cvtype2_to_dtype_with_channels(self, cvtype: int) -> tuple[str, int]:
        """Return numpy's name of the type of a value, and the number of channels, of a type of OpenCV's.

        Args:
            cvtype: Number of the type, `cv2.CV_8UC3`.
        """
        names = self.cvdepth_to_numpy_depth
        depth = CV_MAT_DEPTHWrap(cvtype)
        if depth not in names:
            raise CvBridgeError(f"{cvtype} is not a type of images")
        return names[depth], CV_MAT_CNWrap(cvtype)

    def encoding_to_cvtype2(self, encoding: str) -> int:
        """Return the number of an encoding's type, `cv2.CV_8UC3` for ``bgr8``.

        Args:
            encoding: Name of the encoding.

        Raises:
            CvBridgeError: for an unknown encoding, or without OpenCV.
        """
        return getCvType(encoding)

    def encoding_to_dtype_with_channels(self, encoding: str) -> tuple[str, int]:
        """Return numpy's name of the type of a value, and the number of channels, ``('uint8', 3)`` for ``bgr8``.

        Args:
            encoding: Name of the encoding.

        Raises:
            CvBridgeError: for an unknown encoding.
        """
        found = encoding_of(encoding)
        return DTYPES[found.depth], found.channels

    def imgmsg_to_cv2(self, img_msg: Image, desired_encoding: str = "passthrough") -> Pixels:
        """Return an image as an array of (rows, columns), or (rows, columns, channels), which can be drawn on.

        Args:
            img_msg: The image.
            desired_encoding: The wanted encoding, such as ``bgr8``; ``passthrough`` converts nothing.

        Raises:
            CvBridgeError: if the message contradicts itself, or cannot be converted.
        """
        image = raw_array(img_msg)
        return image if desired_encoding in PASSTHROUGH else convert(image, img_msg.encoding, desired_encoding)

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough") -> Pixels:
        """Return a compressed image as an array; OpenCV decodes it.

        Args:
            cmprs_img_msg: The compressed image.
            desired_encoding: The wanted encoding; ``passthrough`` is what is in the file, in OpenCV's order of colours.

        Raises:
            CvBridgeError: without OpenCV, for bytes that are no picture, and if it cannot be converted.
        """
        return decompressed(cmprs_img_msg, desired_encoding)

    def cv2_to_imgmsg(self, cvim: Pixels, encoding: str = "passthrough", header: Header | None = None) -> Image:
        """Return an array as an image.

        Args:
            cvim: Array of (rows, columns) or (rows, columns, channels).
            encoding: What the array is, such as ``bgr8``; ``passthrough`` names its type only: ``8UC3``.
            header: Stamp and frame; None leaves them empty.

        Raises:
            CvBridgeError: if no image is like this array, or the encoding is of another type.
        """
        found = encoding_of_array(_array(cvim))
        return raw_message(cvim, found, found.name if encoding in PASSTHROUGH else encoding, header)

    def cv2_to_compressed_imgmsg(self, cvim: Pixels, dst_format: str = "jpg") -> CompressedImage:
        """Return an array as a compressed image; OpenCV encodes it, and takes three channels for blue, green and red.

        Args:
            cvim: Array of (rows, columns) or (rows, columns, channels).
            dst_format: ``jpg``, ``png`` or another suffix that OpenCV knows.

        Raises:
            CvBridgeError: without OpenCV, and for what cannot be in such a file.
        """
        return CompressedImage(format=dst_format, data=array("B", encoded(_array(cvim), dst_format)))


def _array(image: Any) -> Pixels:
    if not isinstance(image, np.ndarray | np.generic):
        raise CvBridgeError(f"Your input type is not a numpy array, but {type(image).__name__}")
    return image  # type: ignore[return-value]
