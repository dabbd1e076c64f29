"""PNG files without OpenCV: grey and colours of 8 and 16 bits, compressed by zlib."""

from __future__ import annotations

import struct
import zlib

import numpy as np

from robolink.image.conversion import Pixels

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
