"""Reads the images that ROS keeps maps in, PGM and PNG, as arrays of shades; no library of images is needed for it.

The formats: netpbm's pgm(5), plain (P2) and raw (P5), and W3C's Portable Network Graphics (see `png`).
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from robolink.exceptions import RobolinkError

Shades: TypeAlias = npt.NDArray[np.uint8]

MOST_PIXELS = 100_000_000
"""What an image may have: 10,000 x 10,000, half a kilometre each way at 5 cm."""

_LARGEST_FILE = 8 * MOST_PIXELS
_PGM = re.compile(rb"P([25])" + 3 * rb"(?:\s|#[^\n]*\n)+(\d{1,9})" + rb"(?:[ \t]*#[^\n]*)?\s")


class ImageError(RobolinkError, ValueError):
    """A file that is no image, or none that can be read here; the text says what is wrong with it."""


class Image(NamedTuple):
    """An image's shades, 0 black to 255 white, first row at the top; and where one can see through it, if anywhere."""

    shades: Shades
    transparent: npt.NDArray[np.bool_] | None = None


def read_image(path: Path) -> Image:
    """Read a PGM or PNG file of any depth as 8 bits a pixel. Raises `ImageError`, and OSError from reading the file."""
    from robolink.sim.png import SIGNATURE, read_png

    with path.open("rb") as stream:
        raw = stream.read(_LARGEST_FILE + 1)
    if len(raw) > _LARGEST_FILE:
        raise ImageError(f"longer than {_LARGEST_FILE // 2**20} MiB")
    if raw.startswith(SIGNATURE):
        return read_png(raw)
    if raw[:2] in (b"P2", b"P5"):
        return _read_pgm(raw)
    raise ImageError(f"neither PGM (P2, P5) nor PNG, but it begins with {raw[:8]!r}: save it as one of these")


def check_size(width: int, height: int) -> None:
    """Refuse an image without pixels, or with absurdly many, before memory is taken for them."""
    if not 0 < width * height <= MOST_PIXELS:
        raise ImageError(f"{width} x {height} pixels: expected 1 to {MOST_PIXELS // 10**6} million")


def eight_bits(values: npt.NDArray[Any], largest: int) -> Shades:
    """Bring values of 0 to `largest` to 0 to 255."""
    if largest == 255:
        return values.astype(np.uint8)
    shades: Shades = np.round(np.arange(largest + 1) * (255.0 / largest)).astype(np.uint8)[values]
    return shades


def _read_pgm(raw: bytes) -> Image:
    header = _PGM.match(raw)
    if header is None:
        raise ImageError(f"after {raw[:2].decode()} a PGM has its width, height and largest value")
    width, height, largest = (int(each) for each in header.groups()[1:])
    check_size(width, height)
    if not 1 <= largest <= 65535:
        raise ImageError(f"the largest value is {largest}: expected 1 to 65535")
    values = _plain(raw, header.end()) if header[1] == b"2" else _packed(raw, header.end(), largest)
    if len(values) < width * height:
        raise ImageError(f"it ends too early: {len(values)} of {width * height} pixels")
    values = values[: width * height].reshape(height, width)
    if int(values.max()) > largest:
        raise ImageError(f"a value of {values.max()}, where the largest is {largest}")
    return Image(eight_bits(values, largest))


def _plain(raw: bytes, at: int) -> npt.NDArray[Any]:
    """Read numbers as text; a comment goes from # to the end of its line."""
    body = re.sub(rb"#[^\n]*", b"", raw[at:])
    if strange := re.search(rb"[^0-9\s]", body):
        raise ImageError(f"{strange[0]!r} among the numbers")
    return np.fromstring(body.decode(), dtype=np.int64, sep=" ")


def _packed(raw: bytes, at: int, largest: int) -> npt.NDArray[Any]:
    if largest < 256:
        return np.frombuffer(raw, np.uint8, offset=at)
    return np.frombuffer(raw, ">u2", offset=at, count=(len(raw) - at) // 2)
