"""Kinds of options that several commands take: seconds, and one of a few names."""

from __future__ import annotations

import math
from typing import Any

import typer

LONGEST_WAIT = 1e9
"""Seconds; thirty years."""


def seconds(flag: str, text: str) -> Any:
    """Make an option that takes 0 or more seconds, and nothing that is no number."""

    def check(value: float | None) -> float | None:
        if value is not None and not (math.isfinite(value) and 0 <= value <= LONGEST_WAIT):
            raise typer.BadParameter(f"expected 0 to {LONGEST_WAIT:g} seconds, got {value:g}")
        return value

    return typer.Option(flag, metavar="S", help=text, callback=check)


def choice(flag: str, choices: list[str], text: str) -> Any:
    """Make an option that takes one of these names; the error for another one lists them."""

    def check(value: str) -> str:
        if value and value not in choices:
            from robolink.exceptions import nearest

            close = nearest(value[:100], choices)
            raise typer.BadParameter(f"'{value[:100]}' is none of {', '.join(choices)}{close}")
        return value

    return typer.Option(
        flag, metavar="NAME", help=f"{text}: {', '.join(choices)}.", callback=check, autocompletion=lambda: choices
    )
