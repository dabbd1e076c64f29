"""Marks of what is good and bad in what commands print, with one list of their colours where there is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Iterable

from robolink.cli.shared.output import say
from robolink.system.terminal import fit, styled

GOOD, WARNING, BAD, NEXT = "32", "33", "31", "36"
"""Styles (SGR): green, yellow, red, cyan."""

_STYLES = {"✓": GOOD, "✗": BAD, "→": NEXT}
"""Styles of marks at the begin of a line."""

_PLAIN = {"✓": "+", "✗": "x", "→": ">"}
"""Marks for a terminal that lacks the others."""


def say_styled(text: str, style: str, rest: str = "") -> None:
    """Write a text in a style to standard output, and the rest of its last line as it is.

    >>> say_styled("all checks passed", GOOD)  # no terminal
    all checks passed
    """
    say(styled(fit(text), style, sys.stdout) + fit(rest), colours=True)


def say_marked(lines: Iterable[str]) -> None:
    """Write lines whose marks ✓, ✗ and → at the begin have their colours, or letters where the terminal lacks them."""
    for each in lines:
        say(_known(_coloured(fit(each))), colours=True)


def _coloured(line: str) -> str:
    mark = line.lstrip()[:1]
    return line.replace(mark, styled(mark, _STYLES[mark], sys.stdout), 1) if mark in _STYLES else line


def _known(line: str) -> str:
    """Return a line with marks that the terminal has."""
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    for mark, plain in _PLAIN.items():
        try:
            mark.encode(encoding)
        except (UnicodeEncodeError, LookupError):
            line = line.replace(mark, plain)
    return line
