"""Fiducial markers by family and number, drawn without OpenCV: AprilTag's 16h5, 25h9 and 36h11, and ArUco's.

The cells are those of OpenCV's dictionaries of the same names, turned as OpenCV draws them. AprilTag's own library
takes the opposite corner for the first.
"""

from __future__ import annotations

from functools import cache, lru_cache
from pathlib import Path
from typing import NamedTuple

from robolink.exceptions import nearest
from robolink.sim.scene.solids import Picture
from robolink.system.terminal import shown

BORDER, MARGIN = 1, 1
"""Width of a marker's black border, and of the white margin around that, in cells."""

_TABLE = Path(__file__).with_name("tags.txt")

_ORIGINAL = "aruco_original"
_ORIGINAL_ROWS = (0b10000, 0b10111, 0b01001, 0b01110)
"""Cells of a row of the original ArUco markers, by its two bits of the number: parity makes them five."""


class Family(NamedTuple):
    """A family of markers: the number of cells along a side, without the border, and a code for each marker."""

    side: int
    codes: tuple[int, ...]


class Tag(NamedTuple):
    """A marker: the name of its family, and its number."""

    family: str
    number: int


@cache
def families() -> dict[str, Family]:
    """Return all families by name."""
    found: dict[str, tuple[int, list[int]]] = {}
    for line in _TABLE.read_text(encoding="ascii").splitlines():
        if line.startswith("#"):
            continue
        if not line.startswith(" "):
            name, side = line.split()
            found[name] = int(side), []
        else:
            found[name][1].extend(int(each, 16) for each in line.split())
    made = {name: Family(side, tuple(codes)) for name, (side, codes) in found.items()}
    made[_ORIGINAL] = Family(5, tuple(map(_original, range(1024))))
    return made


def _original(number: int) -> int:
    code = 0
    for shift in range(8, -1, -2):
        code = code << 5 | _ORIGINAL_ROWS[number >> shift & 3]
    return code


def tag_of(text: str) -> Tag:
    """Return the marker that a text such as '36h11/3' names: family and number.

    Args:
        text: The name, in capitals or not.

    Raises:
        ValueError: for an unknown family or number; the text tells what there is.
    """
    name, slash, digits = text.partition("/")
    name = name.strip().lower()
    known = families()
    if name not in known:
        there = f"one of {', '.join(known)}"
        raise ValueError(f"'{shown(text, 40)}' has no known family{nearest(name, known)}: expected {there}, then /3")
    last = len(known[name].codes) - 1
    digits = digits.strip()
    if not slash or not digits.isascii() or not digits.isdigit() or len(digits) > 9 or int(digits) > last:
        raise ValueError(f"'{shown(text, 40)}' is not a tag of {name}: expected {name}/0 to {name}/{last}")
    return Tag(name, int(digits))


@lru_cache(maxsize=256)
def tag_picture(tag: Tag) -> Picture:
    """Return a marker with its border and white margin as a picture of one pixel a cell, read-only."""
    import numpy as np  # late: a check of a world needs only names and sizes

    side, codes = families()[tag.family]
    code = codes[tag.number]
    bits = [code >> place & 1 for place in range(side * side - 1, -1, -1)]
    inner = np.array(bits, np.uint8).reshape(side, side) * np.uint8(255)
    shades = np.pad(np.pad(inner, BORDER), MARGIN, constant_values=255)
    picture = np.repeat(shades[:, :, None], 3, axis=2)
    picture.flags.writeable = False
    return picture


def plate_size(tag: Tag, size: float) -> float:
    """Return the side in metres of a marker with its margin, whose black square has the side `size`."""
    black = families()[tag.family].side + 2 * BORDER
    return size * (black + 2 * MARGIN) / black
