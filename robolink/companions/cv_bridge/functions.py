"""Functions of cv_bridge: numbers of OpenCV's types, conversion, and images in colours that can be looked at."""

from __future__ import annotations

from typing import Any

import numpy as np

from robolink.companions.cv_bridge.label_colours import LABEL_COLOURS
from robolink.image.conversion import Pixels, convert
from robolink.image.encodings import Encoding, ImageError, encoding_of
from robolink.image.opencv import call, opencv

__all__ = ["CV_MAT_CNWrap", "CV_MAT_DEPTHWrap", "CvBridgeError", "cvtColor2", "cvtColorForDisplay", "getCvType"]

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
        encoding_out: The wanted one.

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
        encoding_out: The wanted encoding of 8 bits, '' for ``bgr8``.
        do_dynamic_scaling: True: the least value becomes black, the largest white.
        min_image_value: Value that becomes black; it counts where `max_image_value` is another.
        max_image_value: Value that becomes white.
        colormap: One of OpenCV's colour maps for scaled values, `cv2.COLORMAP_JET`; -1 for shades of grey.

    Raises:
        CvBridgeError: if the image has several channels and is to be scaled, or cannot be converted.
    """
    came, wanted = encoding_of(encoding_in), encoding_of(encoding_out or "bgr8")
    if wanted.bits != 8 or wanted.colours not in ("mono", "bgr", "rgb", "bgra", "rgba"):
        raise CvBridgeError(f"cvtColorForDisplay makes colours or grey of 8 bits, not {wanted.name}")
    if wanted.name == "bgr8" and came.name == "32SC1":
        return _labels(source)
    if do_dynamic_scaling:
        seen = source[np.isfinite(source)]
        min_image_value, max_image_value = (float(seen.min()), float(seen.max())) if seen.size else (0.0, 0.0)
        if min_image_value == max_image_value:
            shape = source.shape[:2] if wanted.channels == 1 else (*source.shape[:2], wanted.channels)
            return np.full(shape, GREY, np.uint8)
    if min_image_value != max_image_value:
        return _scaled(source, came, wanted, (min_image_value, max_image_value), colormap)
    return convert(source, _SEEN_AS.get(came.cv_type, came.name) if not came.colours else came.name, wanted.name)


def _scaled(source: Pixels, came: Encoding, wanted: Encoding, ends: tuple[float, float], colormap: int) -> Pixels:
    if came.channels != 1:
        raise CvBridgeError(f"cvtColorForDisplay scales images of one channel, and {came.name} has {came.channels}")
    low, high = ends
    shades = (source.astype(np.float64) - low) * (255.0 / (high - low))
    unknown = np.isnan(shades)
    grey = np.clip(np.rint(np.where(unknown, 0.0, shades)), 0, 255).astype(np.uint8)
    if colormap == -1:
        return convert(grey, "mono8", wanted.name)
    cv2 = opencv("a colour map")
    coloured: Any = call("apply the colour map", cv2.applyColorMap, grey, colormap)
    coloured[unknown] = 0
    return convert(coloured, "bgr8", wanted.name)


def _labels(source: Pixels) -> Pixels:
    """Return a colour for each label."""
    made: Pixels = LABEL_COLOURS[source % len(LABEL_COLOURS)]
    made[source == BACKGROUND] = 0
    return made
