"""What commands write: lines to standard output, at once, and words for the person at the keyboard."""

from __future__ import annotations

import sys
from typing import Any


def say(text: str) -> None:
    """Write a line to standard output, at once."""
    if sys.stdout is not None:  # it is None where it was closed from the start
        sys.stdout.write(text + "\n")
        sys.stdout.flush()


def say_json(value: Any) -> None:
    """Write a line of JSON to standard output."""
    import msgspec

    say(msgspec.json.encode(value).decode())


def tell(text: str) -> None:
    """Write a line for the person at the keyboard to standard error."""
    sys.stderr.write(text + "\n")
    sys.stderr.flush()
