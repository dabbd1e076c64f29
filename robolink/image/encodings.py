"""Encodings of images by sensor_msgs's names: type and number of channels of a pixel, and their colours."""

from __future__ import annotations

import functools
import re
from typing import Any, NamedTuple

import numpy as np

from robolink.exceptions import MessageError, nearest
from robolink.system.terminal import shown

DTYPES = {
    "8U": "uint8",
    "8S": "int8",
    "16U": "uint16",
    "16S": "int16",
    "32S": "int32",
    "32F": "float32",
    "64F": "float64",
}
"""numpy's types by OpenCV's depths."""
DEPTHS = {name: depth for depth, name in DTYPES.items()}
"""OpenCV's depths by numpy's types."""
PASSTHROUGH = ("", "passthrough")
"""Encodings that are asked for in order to get an image as it is."""
MOST_CHANNELS = 512
"""Most channels that OpenCV 4 knows."""

_GENERIC = re.compile(r"(8U|8S|16U|16S|32S|32F|64F)(?:C([1-9][0-9]{0,2}))?")


class ImageError(MessageError, TypeError):
    """An image that contradicts itself, an encoding that nobody knows, or a conversion that makes no sense."""


class Encoding(NamedTuple):
    """Encoding of an image: OpenCV's depth such as ``8U``, how many channels, and the colours.

    `colours` names the channels in their order (``bgr``, ``rgba``, ``mono``), or a pattern (``bayer_rggb``, ``uyvy``);
    it is empty for numbers without a meaning, as ``32FC1`` has.
    """

    name: str
    depth: str
    channels: int
    colours: str = ""

    @property
    def dtype(self) -> np.dtype[Any]:
        """Type of a channel, in the machine's byte order."""
        return np.dtype(DTYPES[self.depth])

    @property
    def bits(self) -> int:
        """Size of a channel in bits."""
        return int(self.depth[:-1])

    @property
    def cv_type(self) -> str:
        """OpenCV's name of the type of such an array, ``8UC3``."""
        return f"{self.depth}C{self.channels}"


def _colours() -> dict[str, Encoding]:
    orders = {"mono": 1, "bgr": 3, "rgb": 3, "bgra": 4, "rgba": 4}
    patterns = {f"bayer_{pattern}": 1 for pattern in ("rggb", "bggr", "gbrg", "grbg")}
    found = {
        f"{colours}{bits}": Encoding(f"{colours}{bits}", f"{bits}U", channels, colours)
        for colours, channels in {**orders, **patterns}.items()
        for bits in (8, 16)
    }
    mixed = {"yuv422": "uyvy", "uyvy": "uyvy", "yuv422_yuy2": "yuyv", "yuyv": "yuyv"}
    return found | {name: Encoding(name, "8U", 2, colours) for name, colours in mixed.items()}


COLOURED = _colours()
"""Encodings with colours, by name."""


@functools.lru_cache(maxsize=256)
def encoding_of(name: str) -> Encoding:
    """Return the encoding of a name, such as ``bgr8``, ``32FC1`` or ``16U``. Raises ImageError for an unknown one."""
    found = COLOURED.get(name)
    if found is not None:
        return found
    match = _GENERIC.fullmatch(name)
    if match is None or int(match[2] or 1) > MOST_CHANNELS:
        hint = nearest(name, [*COLOURED, *(f"{depth}C1" for depth in DTYPES)])
        raise ImageError(f"Unrecognized image encoding [{shown(name, 40)}]{hint}")
    return Encoding(name, match[1], int(match[2] or 1))


def encoding_of_array(image: np.ndarray[Any, Any]) -> Encoding:
    """Return the encoding without colours of an array of (rows, columns) or (rows, columns, channels), as ``8UC3``.

    Raises ImageError for another shape, or a type of values that no encoding has.
    """
    if image.ndim not in (2, 3):
        raise ImageError(f"an image is an array of (rows, columns) or (rows, columns, channels), not of {image.shape}")
    depth = DEPTHS.get(image.dtype.name)
    channels = image.shape[2] if image.ndim == 3 else 1
    if depth is None:
        raise ImageError(
            f"no encoding has values of {image.dtype.name}, only of {', '.join(DEPTHS)}: try image.astype(np.uint8)"
        )
    if not 1 <= channels <= MOST_CHANNELS:
        raise ImageError(f"an image has 1 to {MOST_CHANNELS} channels, not {channels}")
    name = f"{depth}C{channels}"
    return Encoding(name, depth, channels)
