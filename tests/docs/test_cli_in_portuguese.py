"""The page of commands in Portuguese: each help text has a translation, with the same names, numbers and code."""

from __future__ import annotations

import re
from functools import cache

from robolink.cli.root import command
from tools.docs_site.reference import leaves, text
from tools.docs_site.translations import catalogue, command_texts

KEPT = re.compile(r"`[^`]*`|--[a-z][a-z-]*|/\w[\w/]*|\b[A-Z_]{3,}\b|\d+|(?<!\w)'[^' ]+[^']*'|\n\n")
"""What a translation has as the English text has it: code, options, topics, names in capitals, numbers, paragraphs."""


@cache
def english() -> set[str]:
    return set(command_texts(leaves(command(), []))) - {""}


def test_each_help_text_has_a_translation() -> None:
    missing = english() - set(catalogue("cli"))
    assert sorted(missing) == [], "add them to docs/pt/reference/cli.yaml, or change the ones that were reworded"


def test_no_translation_is_of_a_text_that_is_gone() -> None:
    assert sorted(set(catalogue("cli")) - english()) == []


def test_translations_keep_names_and_numbers() -> None:
    changed = {
        each: portuguese
        for each, portuguese in catalogue("cli").items()
        if sorted(KEPT.findall(portuguese)) != sorted(KEPT.findall(each)) or not portuguese.strip()
    }
    assert changed == {}


def test_the_page_is_portuguese() -> None:
    page = text("cli", "pt")
    assert "Grava topics em um bag até Ctrl-C" in page
    assert [each for each in english() if len(each.split()) > 4 and f"| {each} |" in page] == []
