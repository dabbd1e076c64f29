"""Pictures: in the terminal, two pixels a character, in 24-bit colour; and the check of files that are drawn."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robolink.exceptions import RobolinkError
from robolink.system.terminal import shown

Pixels = NDArray[np.uint8]
"""Picture as rows of red, green and blue: shape (height, width, 3)."""

IMAGE = "sensor_msgs/msg/Image"

_HALF, _END = "\u2580", "\x1b[0m"
"""Upper half block, whose foreground is the upper pixel; and the end of colours."""

_SHADES = 255.0


class PictureError(RobolinkError, ValueError):
    """A message that is not a picture which can be shown, or a terminal that cannot show it."""


def check_terminal(is_terminal: bool) -> None:
    """Raise PictureError unless standard output is a terminal that says that it has 24-bit colours.

    Args:
        is_terminal: True if standard output is a terminal.
    """
    if not is_terminal:
        raise PictureError(
            "an image is drawn on a terminal, and the output is none: 'robolink image save' writes files"
        )
    if os.environ.get("COLORTERM") in ("truecolor", "24bit") or os.environ.get("WT_SESSION"):
        return
    kind = shown(os.environ.get("TERM", ""), 40)
    raise PictureError(
        f"this terminal (TERM='{kind}') does not say that it has 24-bit colours: kitty, iTerm2, GNOME Terminal,"
        " Konsole, Windows Terminal and VS Code have them (COLORTERM=truecolor); 'robolink view' shows images, too"
    )


def drawn(message: Any) -> str:
    """Return a sensor_msgs/msg/Image as lines of a terminal, as large as it has room for, with its size below.

    Raises PictureError for another type, an unknown encoding, or data that is too short for its size.
    """
    if getattr(message, "__ros_type__", "") != IMAGE:
        raise PictureError(f"--image shows {IMAGE}, not {message.__ros_type__}")
    pixels = pixels_of(message)
    columns, rows = shutil.get_terminal_size()
    small = _shrunk(pixels, columns, 2 * max(1, rows - 2))
    lines = [_line(upper, lower) for upper, lower in zip(small[0::2], small[1::2], strict=True)]
    return "\n".join([*lines, f"{message.width} x {message.height} {shown(message.encoding, 40)}"])


def pixels_of(message: Any) -> Pixels:
    """Return the pixels of an image. Raises PictureError for an unknown encoding, or data that is too short."""
    read = _READERS.get(message.encoding)
    if read is None:
        known = ", ".join(_READERS)
        raise PictureError(f"encoding '{shown(message.encoding, 40)}' cannot be shown here; these can: {known}")
    size, kind, convert = read
    height, width, step = message.height, message.width, message.step
    data = np.frombuffer(memoryview(message.data), np.uint8)
    if not height or not width:
        raise PictureError(f"the image is empty: {width} x {height} pixels")
    if step < width * size or len(data) < step * height:
        raise PictureError(
            f"{width} x {height} pixels of {shown(message.encoding, 40)} need {width * size} bytes a row: the image"
            f" says {step} and has {len(data)} bytes"
        )
    rows = data[: step * height].reshape(height, step)[:, : width * size]
    order = ">" if message.is_bigendian else "<"
    values = np.ascontiguousarray(rows).view(np.dtype(f"{order}{kind}")).reshape(height, width, -1)
    return convert(values)


def _colours(*channels: int) -> Callable[[NDArray[Any]], Pixels]:
    return lambda values: np.ascontiguousarray(values[..., list(channels)])


def _stretched(values: NDArray[Any]) -> Pixels:
    """Return shades of grey from the least to the largest value; what is not a number is black."""
    single = values[..., 0].astype(np.float64)
    finite = np.isfinite(single)
    low, high = (single[finite].min(), single[finite].max()) if finite.any() else (0.0, 0.0)
    grey = np.zeros(single.shape, np.uint8)
    grey[finite] = np.rint((single[finite] - low) / ((high - low) or 1.0) * _SHADES)
    return np.repeat(grey[..., None], 3, axis=2)


_READERS: dict[str, tuple[int, str, Callable[[NDArray[Any]], Pixels]]] = {
    "rgb8": (3, "u1", _colours(0, 1, 2)),
    "bgr8": (3, "u1", _colours(2, 1, 0)),
    "rgba8": (4, "u1", _colours(0, 1, 2)),
    "bgra8": (4, "u1", _colours(2, 1, 0)),
    "8UC3": (3, "u1", _colours(2, 1, 0)),
    "mono8": (1, "u1", _colours(0, 0, 0)),
    "8UC1": (1, "u1", _colours(0, 0, 0)),
    "mono16": (2, "u2", _stretched),
    "16UC1": (2, "u2", _stretched),
    "32FC1": (4, "f4", _stretched),
}
"""Bytes of a pixel, type of a channel, and conversion, by sensor_msgs's names of encodings."""


def _shrunk(pixels: Pixels, columns: int, rows: int) -> Pixels:
    """Return the picture in at most so many columns and rows, the rows even, by the nearest pixel."""
    height, width = pixels.shape[:2]
    scale = max(width / max(1, columns), height / rows, 1.0)
    wide = max(1, int(width / scale))
    high = max(2, int(height / scale) // 2 * 2)
    across = np.minimum((np.arange(wide) + 0.5) * width / wide, width - 1).astype(int)
    down = np.minimum((np.arange(high) + 0.5) * height / high, height - 1).astype(int)
    small: Pixels = pixels[down][:, across]
    return small


def _line(upper: Pixels, lower: Pixels) -> str:
    pairs = np.concatenate([upper, lower], axis=1).tolist()
    cells = (f"\x1b[38;2;{r};{g};{b};48;2;{r2};{g2};{b2}m{_HALF}" for r, g, b, r2, g2, b2 in pairs)
    return "".join(cells) + _END


def check_picture(path: Path) -> None:
    """Raise `DrawingError` if no picture can be drawn into such a file, or matplotlib is not installed.

    From then on matplotlib draws into files, whatever the shell says: that may want a screen, or a notebook's module.
    """
    from robolink.sim import drawing

    os.environ["MPLBACKEND"] = "agg"
    drawing.check_picture(path)
