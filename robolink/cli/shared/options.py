"""Options that several commands take: seconds, how messages are printed, one of a few names, and the enclave."""

from __future__ import annotations

import math
from typing import Annotated, Any

import typer

LONGEST_WAIT = 1e9
"""Upper bound of any duration, in seconds (about 31 years)."""


def seconds(flag: str, text: str, *, short: str = "") -> Any:
    """Return an option that takes a duration of 0 to LONGEST_WAIT seconds; `short` is a flag, too."""

    def check(value: float | None) -> float | None:
        if value is not None and not (math.isfinite(value) and 0 <= value <= LONGEST_WAIT):
            raise typer.BadParameter(f"expected 0 to {LONGEST_WAIT:g} seconds, got {value:g}")
        return value

    flags = (flag, short) if short else (flag,)
    return typer.Option(*flags, metavar="S", help=text, callback=check)


# How messages are printed

FullLength = Annotated[bool, typer.Option("--full-length", "-f", help="Print arrays and strings at full length.")]
Length = Annotated[
    int,
    typer.Option(
        "--truncate-length", "-l", metavar="N", help="Length to which arrays and strings are truncated.", min=0
    ),
]
NoArr = Annotated[bool, typer.Option("--no-arr", help="Print only type and length of arrays.")]
NoStr = Annotated[bool, typer.Option("--no-str", help="Print only the length of strings.")]
Flow = Annotated[bool, typer.Option("--flow-style", help="Print YAML in flow style, on one line.")]

GRAPH_FORMATS = ["mermaid", "dot"]
"""Formats of a graph as text: Mermaid for Markdown, DOT for Graphviz."""


def choice(flag: str, choices: list[str], text: str, *, short: str = "") -> Any:
    """Return an option that takes one of these names; the error for another one lists them; `short` is a flag, too."""

    def check(value: str) -> str:
        if value and value not in choices:
            from robolink.exceptions import nearest

            close = nearest(value[:100], choices)
            raise typer.BadParameter(f"'{value[:100]}' is none of {', '.join(choices)}{close}")
        return value

    flags = (flag, short) if short else (flag,)
    return typer.Option(
        *flags, metavar="NAME", help=f"{text}: {', '.join(choices)}.", callback=check, autocompletion=lambda: choices
    )


def enclave(text: str) -> Any:
    """Return the option that names an enclave; `text` is its help."""

    def check(value: str) -> str:
        if value:
            from robolink.exceptions import SecurityError
            from robolink.security.keystore import checked_enclave

            try:
                checked_enclave(value)
            except SecurityError as error:
                raise typer.BadParameter(str(error)) from None
        return value

    return typer.Option("--enclave", metavar="NAME", help=text, callback=check)


Enclave = Annotated[str, enclave("Security enclave of the node; / by default.")]
"""Option of commands that have one session."""
