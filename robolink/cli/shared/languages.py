"""Language option of commands that speak English or Portuguese: `--language`, the student's folder, or the locale."""

from __future__ import annotations

import typer

from robolink.exceptions import nearest
from robolink.learn.folder import find_folder
from robolink.learn.languages import LANGUAGES, Language, default_language


def language_of(asked: str | None) -> Language | None:
    """Return the language that was asked for; None for none. Raises a usage error for any other word."""
    if not asked:
        return None
    for each in LANGUAGES:
        if asked == each:
            return each
    raise typer.BadParameter(f"'{asked[:100]}' is none of {', '.join(LANGUAGES)}{nearest(asked[:100], LANGUAGES)}")


def spoken(asked: str | None) -> Language:
    """Return the language that is spoken here: the one that was asked for, the student's folder's, or the locale's."""
    language = language_of(asked)
    if language is not None:
        return language
    folder = find_folder()
    return default_language() if folder is None else folder.language
