"""Reader of images of maps, PGM and PNG; needs no image library."""

from __future__ import annotations

from pathlib import Path

from robolink.sim.maps import pgm, png
from robolink.sim.maps.image import MOST_BYTES, Image, ImageError
from robolink.system.files import read_plain

LARGEST_FILE = MOST_BYTES + 10_000_000
"""Largest file of an image in bytes: uncompressed pixels, and headers around them."""


def read_image(path: Path) -> Image:
    """Read a PGM or PNG file of any depth as 8 bits a pixel. Raises `ImageError`, and OSError from reading the file."""
    raw = read_plain(path, LARGEST_FILE)
    if raw.startswith(png.SIGNATURE):
        return png.read_png(raw)
    if raw.startswith(pgm.BEGINNINGS):
        return pgm.read_pgm(raw)
    raise ImageError("neither PGM (P2, P5) nor PNG: save it as one of these")
