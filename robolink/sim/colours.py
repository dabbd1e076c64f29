"""Colours of a world file: '#rrggbb', or a name of CSS, as red, green and blue."""

from __future__ import annotations

import re
from typing import TypeAlias

from robolink.exceptions import nearest
from robolink.system.terminal import shown

Colour: TypeAlias = tuple[int, int, int]
"""Red, green and blue, 0 to 255 each."""

NAMES = {
    "aqua": "00ffff",
    "black": "000000",
    "blue": "0000ff",
    "brown": "a52a2a",
    "cyan": "00ffff",
    "fuchsia": "ff00ff",
    "gold": "ffd700",
    "gray": "808080",
    "green": "008000",
    "grey": "808080",
    "lime": "00ff00",
    "magenta": "ff00ff",
    "maroon": "800000",
    "navy": "000080",
    "olive": "808000",
    "orange": "ffa500",
    "pink": "ffc0cb",
    "purple": "800080",
    "red": "ff0000",
    "silver": "c0c0c0",
    "teal": "008080",
    "turquoise": "40e0d0",
    "violet": "ee82ee",
    "white": "ffffff",
    "yellow": "ffff00",
}
"""Named colours, with the values of CSS: its 16 basic ones, and some that are often meant."""

_HEX = re.compile(r"#([0-9A-Fa-f]{6})")


def colour_of(text: str) -> Colour:
    """Return a colour's red, green and blue, 0 to 255 each.

    Args:
        text: '#rrggbb', or a name of `NAMES`, in capitals or not.

    Raises:
        ValueError: for anything else; the text tells what was expected.
    """
    match = _HEX.fullmatch(text)
    digits = match[1] if match else NAMES.get(text.lower())
    if digits is None:
        near = nearest(text.lower(), NAMES)
        raise ValueError(
            f"'{shown(text, 40)}' is not a colour{near}: write '#rrggbb' in quotes, or a name such as orange"
        )
    return int(digits[:2], 16), int(digits[2:4], 16), int(digits[4:], 16)


def hex_of(colour: Colour) -> str:
    """Return a colour as '#rrggbb'."""
    return "#{:02x}{:02x}{:02x}".format(*colour)
