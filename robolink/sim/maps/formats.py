"""Reads the images that ROS keeps maps in, PGM and PNG; no library of images is needed for it."""

from __future__ import annotations

from pathlib import Path

from robolink.sim.maps import pgm, png
from robolink.sim.maps.image import MOST_PIXELS, Image, ImageError

_LARGEST_FILE = 8 * MOST_PIXELS


def read_image(path: Path) -> Image:
    """Read a PGM or PNG file of any depth as 8 bits a pixel. Raises `ImageError`, and OSError from reading the file."""
    with path.open("rb") as stream:
        raw = stream.read(_LARGEST_FILE + 1)
    if len(raw) > _LARGEST_FILE:
        raise ImageError(f"longer than {_LARGEST_FILE // 2**20} MiB")
    if raw.startswith(png.SIGNATURE):
        return png.read_png(raw)
    if raw.startswith(pgm.BEGINNINGS):
        return pgm.read_pgm(raw)
    raise ImageError(f"neither PGM (P2, P5) nor PNG, but it begins with {raw[:8]!r}: save it as one of these")
