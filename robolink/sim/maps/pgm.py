"""Reader of PGM images: plain (P2) and raw (P5), of any depth. The format is netpbm's pgm(5)."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import numpy.typing as npt

from robolink.sim.maps.image import Image, ImageError, check_size, eight_bits, in_blocks

BEGINNINGS = (b"P2", b"P5")
LONGEST_PLAIN = 20_000_000
"""Most bytes of an image whose numbers are text, which takes much more memory to read."""

LONGEST_HEADER = 100_000
"""Most bytes of a header with its comments, each of which takes a hundred times as much memory to read."""

_PGM = re.compile(rb"P([25])" + 3 * rb"(?:\s|#[^\n]*\n)+(\d{1,9})" + rb"(?:[ \t]*#[^\n]*)?\s")


def read_pgm(raw: bytes) -> Image:
    """Read a PGM file's bytes. Raises `ImageError`."""
    header = _PGM.match(raw[:LONGEST_HEADER])
    if header is None:
        raise ImageError(f"after {raw[:2].decode()} a PGM has its width, height and largest value")
    width, height, largest = (int(each) for each in header.groups()[1:])
    check_size(width, height)
    if not 1 <= largest <= 65535:
        raise ImageError(f"the largest value is {largest}: expected 1 to 65535")
    values = _plain(raw, header.end(), width * height) if header[1] == b"2" else _packed(raw, header.end(), largest)
    if len(values) < width * height:
        raise ImageError(f"it ends too early: {len(values)} of {width * height} pixels")
    values = values[: width * height].reshape(height, width)
    if int(values.max()) > largest:
        raise ImageError(f"a value of {values.max()}, where the largest is {largest}")
    return Image(in_blocks(lambda block: eight_bits(block, largest), values))


def _plain(raw: bytes, at: int, count: int) -> npt.NDArray[Any]:
    """Read numbers as text; a comment goes from # to the end of its line."""
    if len(raw) > LONGEST_PLAIN:
        raise ImageError(f"it is longer than {LONGEST_PLAIN // 10**6} MB: save it as a raw PGM (P5)")
    body = re.sub(rb"#[^\n]*", b"", raw[at:])
    if re.search(rb"[^0-9\s]", body):
        raise ImageError("something else among the numbers")
    values = np.fromstring(body.decode(), dtype=np.int64, sep=" ")
    return values[:count]


def _packed(raw: bytes, at: int, largest: int) -> npt.NDArray[Any]:
    if largest < 256:
        return np.frombuffer(raw, np.uint8, offset=at)
    return np.frombuffer(raw, ">u2", offset=at, count=(len(raw) - at) // 2)
