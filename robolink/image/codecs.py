"""Compressed images as files hold them: JPEG, PNG and others by OpenCV."""

from __future__ import annotations

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

    Raises ImageError without OpenCV, and for bytes that are no picture.
    """
    cv2 = opencv("a compressed image")
    if not data.size:
        raise ImageError("the compressed image is empty")
    image = call(f"decode {data.size} bytes", cv2.imdecode, data, cv2.IMREAD_UNCHANGED)
    if image is None:
        raise ImageError(f"the {data.size} bytes are no JPEG, PNG or other picture, or break off")
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
