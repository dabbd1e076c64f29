"""Check of a node that finds a colour, with images of the check's own."""

from __future__ import annotations

import numpy as np

from robolink.image import to_message
from robolink.learn.trial import Trial

WIDTH, HEIGHT = 81, 60
GREY, YELLOW, RED, WHITE = (110, 110, 110), (30, 200, 230), (40, 40, 220), (240, 240, 240)
"""Colours as blue, green and red."""


def check(trial: Trial) -> None:
    """Send images, and compare what is said."""
    trial.start()
    trial.run(0.2)
    middle = said(trial, (40, YELLOW))
    trial.tell("says", middle is not None)
    trial.tell("middle", abs(middle) < 0.05, said=middle)
    left = said(trial, (10, YELLOW))
    trial.tell("left", left is not None and abs(left + 0.75) < 0.05, said=left or 0.0)
    others = said(trial, (10, YELLOW), (50, RED), (70, WHITE))
    trial.tell("others", others is not None and abs(others + 0.75) < 0.05, said=others or 0.0)
    none = said(trial, (50, RED), (70, WHITE))
    trial.tell("none", none is None, said=none or 0.0)


def said(trial: Trial, *things: tuple[int, tuple[int, int, int]]) -> float | None:
    """Send an image with things at these columns; return what comes on direction."""
    image = np.full((HEIGHT, WIDTH, 3), GREY, np.uint8)
    for column, colour in things:
        image[20:40, column - 4 : column + 5] = colour
    trial.system.publish("camera/image_raw", to_message(image, "bgr8"))
    heard = trial.heard("direction", within=0.5)
    return None if heard is None else float(heard.data)
