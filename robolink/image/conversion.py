"""Conversion of images between encodings, bit for bit as OpenCV does it, by numpy where no pattern has to be undone."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from robolink.image.encodings import PASSTHROUGH, Encoding, ImageError, encoding_of, encoding_of_array
from robolink.image.opencv import call, opencv

Pixels = NDArray[Any]
"""Image as an array of (rows, columns) or (rows, columns, channels)."""

_ORDERS = ("mono", "bgr", "rgb", "bgra", "rgba")
_SHIFT = np.uint32(15)
_HALF = np.uint32(1 << 14)
_WEIGHTS = {"r": np.uint32(9798), "g": np.uint32(19235), "b": np.uint32(3735)}
"""Shares of the colours in grey, in 1 / 2**15, as OpenCV has them for 8 and for 16 bits; and a half."""
_SCALE = 257
"""Factor from 8 to 16 bits: 255 becomes 65535."""
_INT32 = 2.0**31

_BAYER = {"rggb": "BG", "bggr": "RG", "gbrg": "GR", "grbg": "GB"}
"""OpenCV's names of Bayer patterns, after the second row's second and third pixel, by those of ROS."""
_YUV = {"uyvy": "UYVY", "yuyv": "YUY2"}


def convert(image: Pixels, source: str, target: str) -> Pixels:
    """Return a copy of an image in another encoding.

    Args:
        image: Array of (rows, columns) or (rows, columns, channels).
        source: Its encoding, such as ``bgr8``.
        target: The wanted encoding; '' or ``passthrough`` for the same.

    Raises:
        ImageError: if an encoding is unknown, the image is not of its encoding, or the conversion makes no sense.
    """
    came = encoding_of(source)
    found = encoding_of_array(image)
    if (found.depth, found.channels) != (came.depth, came.channels):
        raise ImageError(f"an image of {source} is {came.cv_type}, and this one is {found.cv_type}")
    if target in PASSTHROUGH or target == source:
        return np.array(image)
    expected = encoding_of(target)
    if not _has_same_channels(came, expected):
        image = _coloured(image, came, expected)
    elif came.depth == expected.depth:
        return np.array(image)
    return _deep(image, came, expected)


def _has_same_channels(came: Encoding, expected: Encoding) -> bool:
    """Return True if only the depth may change. Raises ImageError if a colour would have to be guessed."""
    if came.colours and expected.colours:
        return came.colours == expected.colours and "bayer" not in came.colours
    if not came.colours and expected.colours:
        raise ImageError(
            f"[{came.name}] is not a color format. but [{expected.name}] is. The conversion does not make sense:"
            " ask for 'passthrough', and scale the numbers yourself"
        )
    if came.channels != expected.channels:
        what = "is a color format but" if came.colours else "and"
        raise ImageError(
            f"[{came.name}] {what} [{expected.name}] do not have the same number of channels:"
            f" {came.channels} and {expected.channels}"
        )
    return True


def _coloured(image: Pixels, came: Encoding, expected: Encoding) -> Pixels:
    """Return the image with other channels, as deep as before."""
    if expected.colours in _ORDERS:
        if came.colours in _ORDERS:
            return _ordered(image.reshape(*image.shape[:2], came.channels), came.colours, expected.colours)
        if came.colours in _YUV:
            return _by_opencv(image, f"YUV2{_opencvs(expected.colours)}_{_YUV[came.colours]}", came, expected)
        if "a" not in expected.colours:
            pattern = _BAYER[came.colours.removeprefix("bayer_")]
            return _by_opencv(image, f"Bayer{pattern}2{_opencvs(expected.colours)}", came, expected)
    raise ImageError(f"Unsupported conversion from [{came.name}] to [{expected.name}]")


def _opencvs(colours: str) -> str:
    return "GRAY" if colours == "mono" else colours.upper()


def _by_opencv(image: Pixels, code: str, came: Encoding, expected: Encoding) -> Pixels:
    cv2 = opencv(f"{came.name} to {expected.name}")
    what = f"convert {image.shape[1]} x {image.shape[0]} pixels from {came.name} to {expected.name}"
    converted: Pixels = call(what, cv2.cvtColor, np.ascontiguousarray(image), getattr(cv2, f"COLOR_{code}"))
    return converted


def _ordered(image: Pixels, came: str, expected: str) -> Pixels:
    if expected == "mono":
        return _grey(image, came)
    made = np.empty((*image.shape[:2], len(expected)), image.dtype)
    for place, colour in enumerate(expected):
        if came == "mono":
            made[..., place] = image[..., 0]
        elif colour in came:
            made[..., place] = image[..., came.index(colour)]
        if colour == "a" and "a" not in came:
            made[..., place] = np.iinfo(image.dtype).max
    return made


def _grey(image: Pixels, came: str) -> Pixels:
    """Return the rounded shades; the sums of 16 bits just fit into 32."""
    sums: Pixels = np.full(image.shape[:2], _HALF, np.uint32)
    for place, colour in enumerate(came):
        if colour != "a":
            sums += np.multiply(image[..., place], _WEIGHTS[colour], dtype=np.uint32)
    grey: Pixels = (sums >> _SHIFT).astype(image.dtype)
    return grey


def _deep(image: Pixels, came: Encoding, expected: Encoding) -> Pixels:
    """Return the image with values of another type: scaled between 8 and 16 bits, else rounded and cut to its range."""
    if came.depth == expected.depth:
        return image
    kind = expected.dtype
    if {came.bits, expected.bits} == {8, 16}:
        values = image.astype(np.int32)
        return _cut(values * _SCALE if expected.bits == 16 else (values + _SCALE // 2) // _SCALE, kind)
    if kind.kind == "f":
        with np.errstate(over="ignore", invalid="ignore"):
            return image.astype(kind)
    if image.dtype.kind == "f":
        values = np.rint(image)
        values[~((values >= -_INT32) & (values < _INT32))] = -_INT32  # what a processor of Intel's makes of it
        return _cut(values, kind)
    return _cut(image.astype(np.int32), kind)


def _cut(values: Pixels, kind: np.dtype[Any]) -> Pixels:
    limits = np.iinfo(kind)
    if kind == np.int32:
        return values.astype(kind)
    return np.clip(values, limits.min, limits.max).astype(kind)
