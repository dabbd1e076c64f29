"""Oracle for conversions of images: the steps of ROS 2's cv_bridge, each by OpenCV itself."""

from __future__ import annotations

import re
from typing import Any

import cv2
import numpy as np

DEPTHS = ["8U", "8S", "16U", "16S", "32S", "32F", "64F"]
GENERIC = [f"{depth}C{channels}" for depth in DEPTHS for channels in (1, 2, 3, 4)]
ORDERS = [f"{order}{bits}" for order in ("mono", "rgb", "bgr", "rgba", "bgra") for bits in (8, 16)]
BAYER = [f"bayer_{pattern}{bits}" for pattern in ("rggb", "bggr", "gbrg", "grbg") for bits in (8, 16)]
YUV = ["yuv422", "yuv422_yuy2"]
ENCODINGS = [*ORDERS, *BAYER, *YUV, *GENERIC]

_CODES = {"rggb": "BG", "bggr": "RG", "gbrg": "GR", "grbg": "GB"}
_TYPES = dict(zip(DEPTHS, ["u1", "i1", "u2", "i2", "i4", "f4", "f8"], strict=True))


class NoSenseError(Exception):
    """cv_bridge refuses this conversion."""


def parted(encoding: str) -> tuple[str, str, int]:
    """Return the colours, '' for none, the depth and the channels of an encoding."""
    if encoding in YUV:
        return encoding, "8U", 2
    match = re.fullmatch(r"(.*?)(8|16)", encoding)
    if match:
        channels = 1 if match[1].startswith(("mono", "bayer")) else len(match[1])
        return match[1], f"{match[2]}U", channels
    depth, channels_ = encoding.split("C")
    return "", depth, int(channels_)


def some_image(encoding: str, rng: np.random.Generator, height: int, width: int) -> Any:
    """Return a random image, whose values reach the ends of their range."""
    _, depth, channels = parted(encoding)
    shape = (height, width) if channels == 1 else (height, width, channels)
    kind = np.dtype(_TYPES[depth])
    if kind.kind == "f":
        wide = rng.normal(size=shape) * 10.0 ** rng.integers(-3, 11, shape)
        near = rng.integers(-200_000, 200_000, shape) / 2
        image = np.where(rng.random(shape) < 0.5, wide, near).astype(kind)
        image[rng.random(shape) < 0.1] = rng.choice([np.nan, np.inf, -np.inf])
        return image
    limits = np.iinfo(kind)
    image = rng.integers(limits.min, limits.max, shape, dtype=kind, endpoint=True)
    image[rng.random(shape) < 0.2] = rng.choice(np.array([limits.min, limits.max, 0], kind))
    return image


def by_opencv(image: Any, source: str, target: str) -> Any:
    """Return what cv_bridge's C++ returns. Raises NoSenseError for what it refuses."""
    if source == target:
        return image
    (came, depth, channels), (wanted, deep, many) = parted(source), parted(target)
    if came and wanted:
        if came != wanted or "bayer" in came:
            image = cv2.cvtColor(image, _code(came, wanted))
    elif wanted or channels != many:
        raise NoSenseError(source, target)
    return _converted(image, depth, deep)


def _code(came: str, wanted: str) -> int:
    wanted_ = wanted.upper().replace("MONO", "GRAY")
    if wanted.startswith(("bayer", "yuv")) or (came.startswith("bayer") and wanted in ("rgba", "bgra")):
        raise NoSenseError(came, wanted)
    if came.startswith("bayer"):
        return int(getattr(cv2, f"COLOR_Bayer{_CODES[came[6:]]}2{wanted_}"))
    if came in YUV:
        return int(getattr(cv2, f"COLOR_YUV2{wanted_}_{'UYVY' if came == 'yuv422' else 'YUY2'}"))
    return int(getattr(cv2, f"COLOR_{came.upper().replace('MONO', 'GRAY')}2{wanted_}"))


def _converted(image: Any, depth: str, deep: str) -> Any:
    """Return what cv::Mat::convertTo makes, which Python has not, but `normalize` and `add` end in it."""
    if depth == deep:
        return image
    if {depth[:-1], deep[:-1]} != {"8", "16"}:
        return cv2.add(image, (0, 0, 0, 0), dtype=getattr(cv2, f"CV_{deep}"))
    largest = int(np.abs(image.astype(np.int64)).max())
    scaled = largest * 257 if deep[:-1] == "16" else largest * 255 / 65535
    return cv2.normalize(image, None, scaled, 0, cv2.NORM_INF, getattr(cv2, f"CV_{deep}"))
