"""Output of commands: results to standard output, flushed at once, and messages for people to standard error.

All text is escaped for the terminal, whoever wrote it: see `robolink.system.terminal`.
"""

from __future__ import annotations

import sys
from typing import Any

from robolink.exceptions import NameValidationException
from robolink.system.terminal import fit, shown, styled

LONGEST_LINE = 2000
"""Upper bound of an error's length, in characters: an argument that it names can be as long as a file."""

_NAME = "robolink:"
"""Beginning of notes and errors."""

_CLEAR = "\x1b[H\x1b[2J"
"""Control sequence that clears a terminal."""


def say(text: str, *, colours: bool = False) -> None:
    """Write lines to standard output, and flush it; with `colours`, sequences that set colours are not escaped."""
    _write(fit(text, colours=colours))


def say_json(value: Any) -> None:
    """Write a value as one line of JSON to standard output, and flush it."""
    import msgspec

    try:
        text = msgspec.json.encode(value).decode()
    except UnicodeEncodeError:  # a surrogate: the name of a file that is not UTF-8, for example
        import json

        text = json.dumps(msgspec.to_builtins(value))
    say(text)


def clear() -> None:
    """Clear the terminal."""
    _write(_CLEAR)


def tell(text: str, *, colours: bool = False) -> None:
    """Write lines for people to standard error; with `colours`, sequences that set colours are not escaped.

    A note that begins with robolink's name has that in yellow on a terminal; an error has it in red: see `complain`.
    """
    if sys.stderr is not None:
        text = fit(text, colours=colours)
        if text.startswith(_NAME):
            text = styled(_NAME, "33", sys.stderr) + text.removeprefix(_NAME)
        sys.stderr.write(text + "\n")
        sys.stderr.flush()


def complain(error: object, code: int = 1, place: str = "") -> int:
    """Print an error as one line on standard error, with its `place` (``file:line``) if known; return `code`."""
    if isinstance(error, NameValidationException):  # its text has a line for the caret
        error = f"invalid {error.name_type} '{error.name[:200]}': {error.error_msg} (at index {error.invalid_index})"
    text = " ".join(str(error).split("\n"))
    if len(text) > LONGEST_LINE:
        text = f"{text[: LONGEST_LINE // 2]} ... {text[-LONGEST_LINE // 4 :]}"
    line = shown(text, len(text))
    at = f" (at {place})" if place else ""
    head = styled(_NAME, "1;31", sys.stderr)
    print(f"{head} {line}{at}", file=sys.stderr)  # noqa: T201 - this is what the user is told
    return code


def _write(text: str) -> None:
    if sys.stdout is not None:  # it is None where it was closed from the start
        sys.stdout.write(text + "\n")
        sys.stdout.flush()
