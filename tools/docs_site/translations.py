"""Catalogues of translations: Portuguese for the English texts from which the reference's pages are generated."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Iterator
from typing import Any

import yaml

from tools.docs_site.pages import DOCS

FOLDER = DOCS / "pt" / "reference"
"""Folder of the catalogues: a file for each page, with lists of pairs, `en` and `pt`."""


@functools.cache
def catalogue(page: str) -> dict[str, str]:
    """Return the translations of a page by their English text.

    Args:
        page: Name of the page, such as cli.
    """
    parts: dict[str, list[dict[str, str]]] = yaml.safe_load((FOLDER / f"{page}.yaml").read_text(encoding="utf-8"))
    return {each["en"]: each["pt"] for pairs in parts.values() for each in pairs}


def translated(page: str, text: str, language: str) -> str:
    """Return a text in a language; English, if there is no translation (a test names those).

    Args:
        page: Name of the page whose catalogue is looked into.
        text: The English text; that of a docstring, without its indentation.
        language: en or pt.
    """
    return text if language == "en" else catalogue(page).get(text, text)


def command_texts(leaves: Iterator[tuple[list[str], Any]]) -> Iterator[str]:
    """Yield the texts of all commands, and of all their options and arguments.

    Args:
        leaves: The commands, each with its path.
    """
    for _, command in leaves:
        yield help_of(command)
        yield from (help_of(param) for param in shown_options(command))


def shown_options(command: Any) -> list[Any]:
    """Return the options and arguments of a command that its help shows."""
    return [each for each in command.params if not getattr(each, "hidden", False) and each.name != "help"]


def help_of(thing: Any) -> str:
    """Return the help text of a command or an option; '' if it has none."""
    return inspect.cleandoc(getattr(thing, "help", None) or "")
