"""Package cv_bridge of ROS 2: images of messages as numpy arrays, as OpenCV has them, and back.

Names and conversions are those of ROS 2's. Most need numpy alone; OpenCV is imported for JPEG and PNG, Bayer patterns,
YUV, colour maps, and for the numbers of OpenCV's types, which differ between its versions. What upstream stumbles over
works: images that cannot be written to, rows with padding, and big endian with numpy 2.
"""

from __future__ import annotations

from array import array
from typing import Any

import numpy as np

from robolink.image.arrays import decompressed, raw_array, raw_message
from robolink.image.codecs import encoded
from robolink.image.conversion import Pixels, convert
from robolink.image.encodings import DEPTHS, DTYPES, PASSTHROUGH, Encoding, ImageError, encoding_of, encoding_of_array
from robolink.image.opencv import call, opencv
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.interfaces.std_msgs.msg import Header

__all__ = [
    "CV_MAT_CNWrap",
    "CV_MAT_DEPTHWrap",
    "CvBridge",
    "CvBridgeError",
    "cvtColor2",
    "cvtColorForDisplay",
    "getCvType",
]


_RGB = """
f0f8ff faebd7 00ffff 7fffd4 f0ffff f5f5dc ffe4c4 000000 ffebcd 0000ff 8a2be2 a52a2a deb887 5f9ea0
7fff00 d2691e ff7f50 6495ed fff8dc dc143c 00ffff 00008b 008b8b b8860b a9a9a9 006400 a9a9a9 bdb76b
8b008b 556b2f ff8c00 9932cc 8b0000 e9967a 8fbc8f 483d8b 2f4f4f 2f4f4f 00ced1 9400d3 ff1493 00bfff
696969 696969 1e90ff b22222 fffaf0 228b22 ff00ff dcdcdc f8f8ff ffd700 daa520 808080 008000 adff2f
808080 f0fff0 ff69b4 cd5c5c 4b0082 fffff0 f0e68c e6e6fa fff0f5 7cfc00 fffacd add8e6 f08080 e0ffff
fafad2 d3d3d3 90ee90 d3d3d3 ffb6c1 ffa07a 20b2aa 87cefa 778899 778899 b0c4de ffffe0 00ff00 32cd32
faf0e6 ff00ff 800000 66cdaa 0000cd ba55d3 9370db 3cb371 7b68ee 00fa9a 48d1cc c71585 191970 f5fffa
ffe4e1 ffe4b5 ffdead 000080 fdf5e6 808000 6b8e23 ffa500 ff4500 da70d6 eee8aa 98fb98 afeeee ffefd5
ffdab9 cd853f ffc0cb dda0dd b0e0e6 800080 ff0000 bc8f8f 4169e1 8b4513 fa8072 f4a460 2e8b57 fff5ee
a0522d c0c0c0 87ceeb 6a5acd 708090 708090 fffafa 00ff7f 4682b4 d2b48c 008080 d8bfd8 ff6347 40e0d0
ee82ee f5deb3 ffffff f5f5f5 ffff00 9acd32
"""
LABEL_COLOURS = np.array([list(bytes.fromhex(each))[::-1] for each in _RGB.split()], np.uint8)
"""Blue, green and red of the labels 0 to 145; the next ones begin again."""


CvBridgeError = ImageError
"""Error of cv_bridge: robolink.image's."""

BACKGROUND = -1
"""Label that is shown black."""
GREY = 127
"""Shade of an image whose values are all the same."""

_SEEN_AS = {"8UC1": "mono8", "8UC3": "bgr8", "8UC4": "bgra8", "16UC1": "mono16", "16UC3": "bgr16", "16UC4": "bgra16"}


def getCvType(encoding: str) -> int:  # noqa: N802
    """Return the number of an encoding's type in the installed OpenCV, `cv2.CV_8UC3` for ``bgr8``.

    Args:
        encoding: Name of the encoding.

    Raises:
        CvBridgeError: for an unknown encoding, or without OpenCV: its versions have different numbers.
    """
    found = encoding_of(encoding)
    cv2 = opencv(f"the number of {found.cv_type}")
    number: int = getattr(cv2, f"CV_{found.depth}C")(found.channels)
    return number


def CV_MAT_CNWrap(i: int) -> int:  # noqa: N802
    """Return the number of channels of a type of OpenCV's.

    Args:
        i: Number of the type.
    """
    return (i >> _shift()) + 1


def CV_MAT_DEPTHWrap(i: int) -> int:  # noqa: N802
    """Return the number of the depth of a type of OpenCV's.

    Args:
        i: Number of the type.
    """
    return i & ((1 << _shift()) - 1)


def _shift() -> int:
    """Return how many bits of a type's number hold the depth: two channels are one step above."""
    cv2 = opencv("the number of a type")
    step: int = cv2.CV_8UC2 - cv2.CV_8UC1
    return step.bit_length() - 1


def cvtColor2(source: Pixels, encoding_in: str, encoding_out: str) -> Pixels:  # noqa: N802
    """Return an image in another encoding.

    Args:
        source: The image.
        encoding_in: Its encoding.
        encoding_out: The requested one.

    Raises:
        CvBridgeError: if the conversion makes no sense, or the image is not of its encoding.
    """
    return convert(source, encoding_in, encoding_out)


def cvtColorForDisplay(  # noqa: N802
    source: Pixels,
    encoding_in: str,
    encoding_out: str = "",
    do_dynamic_scaling: bool = False,
    min_image_value: float = 0.0,
    max_image_value: float = 0.0,
    colormap: int = -1,
) -> Pixels:
    """Return an image in 8 bits, to be looked at.

    Args:
        source: The image.
        encoding_in: Its encoding. Labels (``32SC1``) get a colour each, and -1 is black.
        encoding_out: The requested encoding of 8 bits, '' for ``bgr8``.
        do_dynamic_scaling: True: the least value becomes black, the largest white.
        min_image_value: Value that becomes black; it counts where `max_image_value` is another.
        max_image_value: Value that becomes white.
        colormap: One of OpenCV's colour maps for scaled values, `cv2.COLORMAP_JET`; -1 for shades of grey.

    Raises:
        CvBridgeError: if the image has several channels and is to be scaled, or cannot be converted.
    """
    came, requested = encoding_of(encoding_in), encoding_of(encoding_out or "bgr8")
    if requested.bits != 8 or requested.colours not in ("mono", "bgr", "rgb", "bgra", "rgba"):
        raise CvBridgeError(f"cvtColorForDisplay makes colours or grey of 8 bits, not {requested.name}")
    if requested.name == "bgr8" and came.name == "32SC1":
        return _labels(source)
    if do_dynamic_scaling:
        seen = source[np.isfinite(source)]
        min_image_value, max_image_value = (float(seen.min()), float(seen.max())) if seen.size else (0.0, 0.0)
        if min_image_value == max_image_value:
            shape = source.shape[:2] if requested.channels == 1 else (*source.shape[:2], requested.channels)
            return np.full(shape, GREY, np.uint8)
    if min_image_value != max_image_value:
        return _scaled(source, came, requested, (min_image_value, max_image_value), colormap)
    return convert(source, _SEEN_AS.get(came.cv_type, came.name) if not came.colours else came.name, requested.name)


def _scaled(source: Pixels, came: Encoding, requested: Encoding, ends: tuple[float, float], colormap: int) -> Pixels:
    if came.channels != 1:
        raise CvBridgeError(f"cvtColorForDisplay scales images of one channel, and {came.name} has {came.channels}")
    low, high = ends
    shades = (source.astype(np.float64) - low) * (255.0 / (high - low))
    unknown = np.isnan(shades)
    grey = np.clip(np.rint(np.where(unknown, 0.0, shades)), 0, 255).astype(np.uint8)
    if colormap == -1:
        return convert(grey, "mono8", requested.name)
    cv2 = opencv("a colour map")
    coloured: Any = call("apply the colour map", cv2.applyColorMap, grey, colormap)
    coloured[unknown] = 0
    return convert(coloured, "bgr8", requested.name)


def _labels(source: Pixels) -> Pixels:
    """Return a colour for each label."""
    made: Pixels = LABEL_COLOURS[source % len(LABEL_COLOURS)]
    made[source == BACKGROUND] = 0
    return made


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
            desired_encoding: The requested encoding, such as ``bgr8``; ``passthrough`` converts nothing.

        Raises:
            CvBridgeError: if the message contradicts itself, or cannot be converted.
        """
        image = raw_array(img_msg)
        return image if desired_encoding in PASSTHROUGH else convert(image, img_msg.encoding, desired_encoding)

    def compressed_imgmsg_to_cv2(self, cmprs_img_msg: CompressedImage, desired_encoding: str = "passthrough") -> Pixels:
        """Return a compressed image as an array; OpenCV decodes it.

        Args:
            cmprs_img_msg: The compressed image.
            desired_encoding: Requested encoding; ``passthrough`` is what is in the file, in OpenCV's order of colours.

        Raises:
            CvBridgeError: without OpenCV, for bytes that are not a picture, and if it cannot be converted.
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
