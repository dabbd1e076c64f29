"""Drawn pictures in the place of a camera's: burgers that fly about."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Picture = npt.NDArray[np.uint8]

LAYERS = (
    ("upper", -0.55, 0.45, (60, 140, 215)),
    ("block", -0.10, 0.12, (60, 190, 90)),
    ("block", 0.02, 0.18, (40, 60, 95)),
    ("block", 0.20, 0.08, (70, 210, 250)),
    ("lower", 0.28, 0.27, (70, 150, 220)),
)
"""Parts of a burger from above: shape, upper edge and height as shares of its size, colour as blue, green, red."""
BACKGROUND = (40, 30, 30)


class Flight(NamedTuple):
    """Path of one burger: size as a share of the picture's height, and speed in shares of the picture per frame."""

    size: float
    x: float
    y: float
    dx: float
    dy: float


FLIGHTS = (
    Flight(0.22, 0.1, 0.3, 0.011, 0.007),
    Flight(0.16, 0.7, 0.6, 0.008, 0.013),
    Flight(0.12, 0.4, 0.1, 0.017, 0.01),
)


def render(width: int, height: int, number: int) -> Picture:
    """Return the picture of a frame, as (rows, columns, 3) in the order blue, green, red.

    Args:
        width: Width in pixels.
        height: Height in pixels.
        number: Number of the frame.
    """
    picture = np.empty((height, width, 3), np.uint8)
    picture[:] = BACKGROUND
    for each in FLIGHTS:
        radius = max(each.size * height, 2.0)
        x = radius + bounced(each.x + each.dx * number) * max(width - 2 * radius, 0.0)
        y = radius + bounced(each.y + each.dy * number) * max(height - 2 * radius, 0.0)
        draw(picture, x, y, radius)
    return picture


def bounced(way: float) -> float:
    """Return a place from 0 to 1 after a way that turns at both ends.

    >>> [round(bounced(each), 2) for each in (0.25, 1.25, 2.25)]
    [0.25, 0.75, 0.25]
    """
    rest = way % 2.0
    return rest if rest <= 1.0 else 2.0 - rest


def draw(picture: Picture, x: float, y: float, radius: float) -> None:
    """Draw a burger at a place in pixels."""
    height, width = picture.shape[:2]
    rows, columns = np.ogrid[:height, :width]
    across, down = (columns - x) / radius, (rows - y) / radius
    for shape, top, tall, colour in LAYERS:
        inside = (down >= top) & (down < top + tall) & (np.abs(across) <= 0.95)
        if shape == "upper":
            inside = inside & (across**2 + ((down - top - tall) / tall) ** 2 <= 0.9)
        elif shape == "lower":
            inside = inside & (np.abs(across) <= 0.95 - 0.6 * np.clip(down - top, 0.0, 1.0))
        picture[inside] = colour
