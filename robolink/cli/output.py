"""Output of commands: lines to standard output, at once, and words for the person at the keyboard.

All that is written here is fit for a terminal, whoever said it: see `robolink.terminal`.
"""

from __future__ import annotations

import sys
from typing import Any

from robolink.terminal import fit

_CLEAR = "\x1b[H\x1b[2J"
"""What empties a terminal."""


def say(text: str) -> None:
    """Write lines to standard output, at once."""
    _write(fit(text))


def say_json(value: Any) -> None:
    """Write a line of JSON to standard output."""
    import msgspec

    say(msgspec.json.encode(value).decode())


def clear() -> None:
    """Empty the terminal."""
    _write(_CLEAR)


def tell(text: str, *, colours: bool = False) -> None:
    """Write lines for the person at the keyboard to standard error; with `colours`, what sets some may be in them."""
    if sys.stderr is not None:
        sys.stderr.write(fit(text, colours=colours) + "\n")
        sys.stderr.flush()


def _write(text: str) -> None:
    if sys.stdout is not None:  # it is None where it was closed from the start
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
