"""Reader of the pictures on signs and floors: PNG and PGM by robolink itself, JPEG by OpenCV."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import numpy as np

from robolink.sim.maps import pgm, png
from robolink.sim.maps.formats import LARGEST_FILE
from robolink.sim.maps.image import ImageError
from robolink.sim.scene.solids import Picture
from robolink.system.files import read_plain

MOST_PIXELS = 8_000_000
"""Most pixels of a picture: 4,000 x 2,000."""

MOST_CACHED = 16
"""Most pictures that are cached in memory."""

_known: dict[str, tuple[tuple[int, int], Picture]] = {}
"""The last pictures by path, each with its file's time and size; the latest is the last."""

_lock = threading.Lock()

_JPEG = b"\xff\xd8\xff"
_STARTS = (*range(0xC0, 0xC4), *range(0xC5, 0xC8), *range(0xC9, 0xCC), *range(0xCD, 0xD0))
"""Markers of JPEG's frame headers, which have the size (ITU-T T.81, table B.1)."""


def read_picture(path: str) -> Picture:
    """Return a picture file's pixels, the first row at the top, read-only; transparent parts are white.

    Args:
        path: The file: PNG, PGM or JPEG.

    Raises:
        OSError: if it cannot be read.
        ImageError: if it is not a picture, a broken or a huge one, or a JPEG without OpenCV.
        ValueError: if the path is none.
    """
    if "\0" in path:
        raise ValueError("a path has no null character")  # each Python has words of its own for that
    found = Path(path).stat()
    state = (found.st_mtime_ns, found.st_size)
    with _lock:
        known = _known.get(path)
    if known is None or known[0] != state:
        known = state, _decoded(read_plain(path, LARGEST_FILE))
        known[1].flags.writeable = False
    with _lock:
        _known.pop(path, None)
        _known[path] = known
        while len(_known) > MOST_CACHED:
            del _known[next(iter(_known))]
    return known[1]


def cached_picture(path: str) -> Picture:
    """Return a picture as `read_picture` does, or as it was if its file has gone or changed for the worse since then.

    A world that runs keeps its signs, whatever happens to their files.
    """
    try:
        return read_picture(path)
    except (OSError, ValueError):
        with _lock:
            known = _known.get(path)
        if known is None:
            raise
        return known[1]


def _decoded(raw: bytes) -> Picture:
    if raw.startswith(png.SIGNATURE):
        _check(*(int.from_bytes(raw[at : at + 4], "big") for at in (16, 20)))
        return png.read_png_colours(raw)
    if raw.startswith(pgm.BEGINNINGS):
        shades = pgm.read_pgm(raw).shades
        _check(shades.shape[1], shades.shape[0])
        return np.repeat(shades[:, :, None], 3, axis=2)
    if raw.startswith(_JPEG):
        _check(*_jpeg_size(raw))
        return _from_jpeg(raw)
    raise ImageError("no PNG, JPEG or PGM: save it as PNG")


def _check(width: int, height: int) -> None:
    if width * height > MOST_PIXELS:
        raise ImageError(f"{width} x {height} pixels: at most {MOST_PIXELS // 10**6} million")


def _jpeg_size(raw: bytes) -> tuple[int, int]:
    """Return the width and height that a JPEG file tells, without decoding it."""
    at = 2
    while at + 9 <= len(raw):
        if raw[at] != 0xFF:
            break
        marker = raw[at + 1]
        if marker in _STARTS:
            return int.from_bytes(raw[at + 7 : at + 9], "big"), int.from_bytes(raw[at + 5 : at + 7], "big")
        at += 1 if marker == 0xFF else 2 + int.from_bytes(raw[at + 2 : at + 4], "big")
    raise ImageError("it is damaged: a JPEG without its size")


def _from_jpeg(raw: bytes) -> Picture:
    try:
        import cv2
    except (ImportError, AttributeError):  # the second: built for another numpy
        raise ImageError("JPEG needs OpenCV: pip install opencv-python-headless, or save it as PNG") from None
    opencv: Any = cv2
    try:
        decoded = opencv.imdecode(np.frombuffer(raw, np.uint8), opencv.IMREAD_COLOR)
    except opencv.error:
        decoded = None
    if decoded is None:
        raise ImageError("it is damaged: OpenCV cannot decode this JPEG")
    return np.ascontiguousarray(decoded[:, :, ::-1])
