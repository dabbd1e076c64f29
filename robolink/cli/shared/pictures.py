"""Check of commands that write pictures, before their work: the file's kind, and that matplotlib is there."""

from __future__ import annotations

import os
from pathlib import Path


def check_picture(path: Path) -> None:
    """Raise `DrawingError` if no picture can be drawn into such a file, or matplotlib is not installed.

    From then on matplotlib draws into files, whatever the shell says: that may want a screen, or a notebook's module.
    """
    from robolink.sim import drawing

    os.environ["MPLBACKEND"] = "agg"
    drawing.check_picture(path)
