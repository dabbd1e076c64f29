"""What the commands that write pictures ask first: whether that can be done at all, before they work for it."""

from __future__ import annotations

import os
from pathlib import Path


def check_picture(path: Path) -> None:
    """Raise `DrawingError` when no picture can be drawn into such a file, or matplotlib is not installed.

    From then on matplotlib draws into files, whatever the shell says: that may want a screen, or a notebook's module.
    """
    from robolink import drawing

    os.environ["MPLBACKEND"] = "agg"
    drawing.check_picture(path)
