"""Compressed images as files hold them: JPEG, PNG and others by OpenCV, and PNG without it."""

from __future__ import annotations

import struct
import zlib
from typing import Any

import numpy as np

from robolink.image.conversion import Pixels
from robolink.image.encodings import ImageError, encoding_of_array
from robolink.image.opencv import call, opencv
from robolink.system.terminal import shown

_CODED = {
    ("8U", 1): "mono8",
    ("8U", 3): "bgr8",
    ("8U", 4): "bgra8",
    ("16U", 1): "mono16",
    ("16U", 3): "bgr16",
    ("16U", 4): "bgra16",
}


def decoded(data: np.ndarray[Any, Any]) -> tuple[Pixels, str]:
    """Return the pixels of a file's bytes, as they are in it, and their encoding: OpenCV's order, ``bgr8``.

    Raises ImageError without OpenCV, and for bytes that are not a picture.
    """
    cv2 = opencv("a compressed image")
    if not data.size:
        raise ImageError("the compressed image is empty")
    image = call(f"decode {data.size} bytes", cv2.imdecode, data, cv2.IMREAD_UNCHANGED)
    if image is None:
        raise ImageError(f"the {data.size} bytes are not a JPEG, PNG or other picture, or break off")
    found = encoding_of_array(image)
    return image, _CODED.get((found.depth, found.channels), found.name)


def encoded(image: Pixels, form: str) -> bytes:
    """Return an image in OpenCV's order of colours as a file's bytes.

    Args:
        image: Array of (rows, columns) or (rows, columns, channels).
        form: Kind of file, as its suffix without the dot: ``jpg``, ``png``.

    Raises:
        ImageError: without OpenCV, and for what cannot be in such a file.
    """
    cv2 = opencv(f"writing {shown(form, 20)}")
    found = encoding_of_array(image)
    what = f"make {shown(form, 20)} of {image.shape[1]} x {image.shape[0]} pixels of {found.name}"
    done, data = call(what, cv2.imencode, f".{form}", np.ascontiguousarray(image))
    if not done:
        raise ImageError(f"OpenCV could not {what}")
    made: bytes = data.tobytes()
    return made


_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_KINDS = {1: 0, 3: 2, 4: 6}
"""PNG's numbers of grey, colours, and colours with alpha, by channels."""


def png_of(image: Pixels) -> bytes:
    """Return an image as the bytes of a PNG file, in which every bit is kept.

    Args:
        image: Array of (rows, columns) or (rows, columns, channels) in the order red, green, blue, alpha, of uint8 or
            uint16.
    """
    height, width = image.shape[:2]
    channels = image.shape[2] if image.ndim == 3 else 1
    rows = np.ascontiguousarray(image, image.dtype.newbyteorder(">")).view(np.uint8).reshape(height, -1)
    filtered = np.concatenate([np.zeros((height, 1), np.uint8), rows], axis=1)  # 0: a row as it is
    header = struct.pack(">IIBBBBB", width, height, 8 * image.dtype.itemsize, _KINDS[channels], 0, 0, 0)
    return b"".join(
        [
            _SIGNATURE,
            _chunk(b"IHDR", header),
            _chunk(b"IDAT", zlib.compress(filtered.tobytes(), 1)),
            _chunk(b"IEND", b""),
        ]
    )


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
