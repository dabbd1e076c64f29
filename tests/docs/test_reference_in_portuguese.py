"""Generated reference in Portuguese: help texts and first paragraphs have translations, with the same names in them."""

from __future__ import annotations

import re
from functools import cache

import pytest

from robolink.cli.root import command
from tools.docs_site.reference import descriptions, leaves, summaries, text
from tools.docs_site.translations import catalogue, command_texts

KEPT = re.compile(r"`[^`]*`|--[a-z][a-z-]*|/\w[\w/]*|\b[A-Z_]{3,}\b|\d+|(?<!\w)'[^' ]+[^']*'|\n\n")
"""What a translation has as the English text has it: code, options, topics, names in capitals, numbers, paragraphs."""

WAITING = 0.1
"""Share of the docstrings of the API that may wait for a translation, and be English meanwhile: many are reworded."""


@cache
def english(page: str) -> set[str]:
    made = {"api": summaries, "cli": lambda: command_texts(leaves(command(), [])), "files": descriptions}
    return set(made[page]()) - {""}


@pytest.mark.parametrize("page", ["cli", "files"])
def test_each_text_has_a_translation(page: str) -> None:
    missing = english(page) - set(catalogue(page))
    assert sorted(missing) == [], f"add them to docs/pt/reference/{page}.yaml, or change the ones that were reworded"


@pytest.mark.parametrize("page", ["cli", "files"])
def test_no_translation_is_of_a_text_that_is_gone(page: str) -> None:
    assert sorted(set(catalogue(page)) - english(page)) == []


def test_nearly_all_first_paragraphs_of_the_api_have_a_translation() -> None:
    missing = english("api") - set(catalogue("api"))
    assert len(missing) <= WAITING * len(english("api")), f"add to docs/pt/reference/api.yaml: {sorted(missing)}"
    gone = set(catalogue("api")) - english("api")
    assert len(gone) <= WAITING * len(english("api")), f"take out of docs/pt/reference/api.yaml: {sorted(gone)}"


@pytest.mark.parametrize("page", ["api", "cli", "files"])
def test_translations_keep_names_and_numbers(page: str) -> None:
    changed = {
        each: portuguese
        for each, portuguese in catalogue(page).items()
        if sorted(KEPT.findall(portuguese)) != sorted(KEPT.findall(each)) or not portuguese.strip()
    }
    assert changed == {}


def test_the_pages_are_portuguese() -> None:
    page = text("cli", "pt")
    assert "Grava topics em um bag até Ctrl-C" in page
    assert [each for each in english("cli") if len(each.split()) > 4 and f"| {each} |" in page] == []
    page = text("api", "pt")
    assert "Cria um timer, que chama uma função periodicamente." in page
    assert "Create a timer, which calls a function periodically." not in page
    assert "Create a timer, which calls a function periodically." in text("api", "en")
    page = text("files", "pt")
    assert "| Campo de visão em graus. |" in page
    assert [each for each in english("files") if len(each.split()) > 4 and f"| {each} |" in page] == []
