"""Language option of commands that speak English or Portuguese: `--language`, the student's folder, or the locale."""

from __future__ import annotations

import typer

from robolink.exceptions import nearest
from robolink.grading.languages import LANGUAGES, Language, language_here


def language_of(requested: str | None) -> Language | None:
    """Return the language of an option; None for an empty one. Raises a usage error for an unknown word."""
    if not requested:
        return None
    for each in LANGUAGES:
        if requested == each:
            return each
    short = requested[:100]
    raise typer.BadParameter(f"'{short}' is none of {', '.join(LANGUAGES)}{nearest(short, LANGUAGES)}")


def spoken(requested: str | None) -> Language:
    """Return the language of an option, else of the student's folder, else of the locale."""
    return language_of(requested) or language_here()
