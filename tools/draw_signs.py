"""Draws the traffic signs of the world `signs` (configs/worlds/signs): outlines of our own, on white plates.

python tools/draw_signs.py
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from robolink.image.codecs import png_of
from robolink.sim.colours import Colour, colour_of
from robolink.sim.physics.convex import convex_parts
from robolink.sim.scene.floor import Layer
from robolink.sim.scene.solids import Picture
from robolink.sim.scene.strokes import Stroke

FOLDER = Path(__file__).resolve().parent.parent / "configs" / "worlds" / "signs"

SIDE = 128
"""Width and height of a sign in pixels."""

RED, BLUE, BLACK, WHITE = (colour_of(each) for each in ("#c81e1e", "#1e50b4", "#141414", "white"))

Point = tuple[float, float]

LETTERS: dict[str, list[list[Point]]] = {
    "S": [[(4, 5.4), (3, 6), (1, 6), (0, 5), (0, 4), (1, 3), (3, 3), (4, 2), (4, 1), (3, 0), (1, 0), (0, 0.6)]],
    "T": [[(0, 6), (4, 6)], [(2, 6), (2, 0)]],
    "O": [[(1, 0), (3, 0), (4, 1), (4, 5), (3, 6), (1, 6), (0, 5), (0, 1), (1, 0)]],
    "P": [[(0, 0), (0, 6), (3, 6), (4, 5), (4, 4), (3, 3), (0, 3)]],
    "3": [[(0, 5), (1, 6), (3, 6), (4, 5), (4, 4), (3, 3), (1.5, 3)], [(3, 3), (4, 2), (4, 1), (3, 0), (1, 0), (0, 1)]],
    "0": [[(1, 0), (3, 0), (4, 1), (4, 5), (3, 6), (1, 6), (0, 5), (0, 1), (1, 0)]],
}
"""Letters as lines on a grid of 4 x 6."""


class Plate:
    """A white plate to draw on; coordinates go from -1 to 1, y upwards."""

    def __init__(self) -> None:
        self.image: Picture = np.full((SIDE, SIDE, 3), 255, np.uint8)

    def polygon(self, corners: Sequence[Point], colour: Colour) -> None:
        """Fill a polygon, its corners counter-clockwise."""
        layer = Layer(self.image)
        for part in convex_parts(corners):
            layer.add_polygon([_pixel(each) for each in part])
        layer.blend(colour)

    def disc(self, radius: float, colour: Colour) -> None:
        """Fill a disc about the middle."""
        layer = Layer(self.image)
        layer.add_disc(SIDE / 2, SIDE / 2, radius * SIDE / 2)
        layer.blend(colour)

    def write(self, text: str, height: float, colour: Colour, width: float) -> None:
        """Write letters into the middle, with lines of a width."""
        unit = height / 6
        left = -(len(text) * 5.5 - 1.5) * unit / 2
        layer = Layer(self.image)
        for index, letter in enumerate(text):
            for line in LETTERS[letter]:
                points = [_pixel((left + (index * 5.5 + x) * unit, (y - 3) * unit)) for x, y in line]
                layer.add_stroke(Stroke(points, ring=True), width * SIDE / 2)
        layer.blend(colour)


def _pixel(point: Point) -> Point:
    return (point[0] + 1) * SIDE / 2, (point[1] + 1) * SIDE / 2


def _regular(count: int, radius: float, turn: float) -> list[Point]:
    angles = [turn + math.tau * each / count for each in range(count)]
    return [(radius * math.cos(each), radius * math.sin(each)) for each in angles]


def _stop(plate: Plate) -> None:
    for radius, colour in ((0.98, RED), (0.90, WHITE), (0.86, RED)):
        plate.polygon(_regular(8, radius, math.pi / 8), colour)
    plate.write("STOP", 0.42, WHITE, 0.08)


def _no_entry(plate: Plate) -> None:
    plate.disc(0.96, RED)
    plate.polygon([(-0.68, -0.16), (0.68, -0.16), (0.68, 0.16), (-0.68, 0.16)], WHITE)


def _speed_30(plate: Plate) -> None:
    plate.disc(0.96, RED)
    plate.disc(0.72, WHITE)
    plate.write("30", 0.7, BLACK, 0.13)


def _yield(plate: Plate) -> None:
    for size, colour in ((0.96, RED), (0.58, WHITE)):
        plate.polygon([(x * size, y * size + 0.16) for x, y in ((0.0, -1.1), (1.0, 0.7), (-1.0, 0.7))], colour)


def _arrow(turns: int) -> Callable[[Plate], None]:
    """An arrow that points ahead (0), to the left (1) or to the right (3)."""
    outline = [(0.0, 0.68), (-0.42, 0.22), (-0.15, 0.22), (-0.15, -0.62), (0.15, -0.62), (0.15, 0.22), (0.42, 0.22)]

    def draw(plate: Plate) -> None:
        plate.disc(0.96, BLUE)
        turned = outline
        for _ in range(turns):
            turned = [(-y, x) for x, y in turned]
        plate.polygon(turned, WHITE)

    return draw


SIGNS: dict[str, Callable[[Plate], None]] = {
    "stop": _stop,
    "no_entry": _no_entry,
    "speed_30": _speed_30,
    "yield": _yield,
    "ahead": _arrow(0),
    "left": _arrow(1),
    "right": _arrow(3),
}


def drawn(name: str) -> bytes:
    """Return a sign as the bytes of a PNG file."""
    plate = Plate()
    SIGNS[name](plate)
    return png_of(plate.image[::-1])


def main() -> None:
    """Write all signs."""
    FOLDER.mkdir(exist_ok=True)
    for name in SIGNS:
        (FOLDER / f"{name}.png").write_bytes(drawn(name))


if __name__ == "__main__":
    main()
