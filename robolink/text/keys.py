"""Keys in what a terminal or Windows' console sends: letters, and words for the keys that are none."""

from __future__ import annotations

import re

_SPECIAL = {
    "A": "up",
    "B": "down",
    "C": "right",
    "D": "left",
    "H": "home",
    "F": "end",
    "5~": "pageup",
    "6~": "pagedown",
}
"""Names by the end of an escape sequence."""
_WINDOWS = {
    "H": "up",
    "P": "down",
    "M": "right",
    "K": "left",
    "G": "home",
    "O": "end",
    "I": "pageup",
    "Q": "pagedown",
}
"""Names by the second of the two characters that Windows' console sends."""
_PLAIN = {"\r": "enter", "\n": "enter", "\x1b": "escape", "\x7f": "backspace", "\b": "backspace", "\t": "tab"}
_KEY = re.compile(
    r"\x1b(?:\[(?P<number>[0-9;]*)|O)(?P<special>[A-Za-z~])|[\x00\xe0](?P<windows>.)|(?P<plain>.)", re.DOTALL
)


def split_keys(text: str) -> list[str]:
    """Return the names of the keys in what a terminal has sent: a character, or a word such as `up` or `enter`.

    Special keys without a name are left out; those that are held with shift or the like count as without.

    >>> split_keys("q\\x1b[A \\r")
    ['q', 'up', ' ', 'enter']
    """
    return [name for match in _KEY.finditer(text) if (name := _name(match))]


def _name(match: re.Match[str]) -> str:
    special = match["special"]
    if special == "~":
        return _SPECIAL.get(f"{match['number']}~", "")
    if special:
        return _SPECIAL.get(special, "")
    if match["windows"]:
        return _WINDOWS.get(match["windows"], "")
    return _PLAIN.get(match["plain"], match["plain"])
