"""The ends of the learn pages: each names its exercises, all are named once, and each leads to the next page."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest

from robolink.learn.exercise import read_course
from tools.docs_site.pages import LANGUAGES, Page, pages

WORDS = {"en": ("Exercises", "Next: ["), "pt": ("Exercícios", "Próxima página: [")}
COURSE = [each.name for each in read_course()]
LEARN = {language: [each for each in pages(language) if each.address.startswith("learn/")] for language in LANGUAGES}


def named(page: Page) -> list[str]:
    """Return the exercises that a page names: the first in a command, the others alone."""
    (line,) = re.findall(rf"^{WORDS[page.language][0]}: (`.*`)\.$", page.text(), re.MULTILINE)
    first, *others = re.findall(r"`([^`]+)`", line)
    assert first.startswith("robolink learn check "), line
    return [first.removeprefix("robolink learn check "), *others]


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_exercise_is_named_by_one_page(language: str) -> None:
    found = [name for page in LEARN[language] for name in named(page)]
    assert sorted(found) == sorted(COURSE)


@pytest.mark.parametrize("page", LEARN["en"], ids=lambda page: page.address)
def test_a_page_names_its_exercises_in_their_order_in_both_languages(page: Page) -> None:
    other = next(each for each in LEARN["pt"] if each.address == page.address)
    assert named(page) == named(other) == sorted(named(page), key=COURSE.index)


@pytest.mark.parametrize("language", LANGUAGES)
def test_each_page_ends_with_the_way_to_the_next(language: str) -> None:
    for page, following in pairwise(LEARN[language]):
        last = page.text().rstrip().splitlines()[-1]
        assert last.startswith(WORDS[language][1])
        assert f"({following.address.removeprefix('learn/')})" in last
    last = LEARN[language][-1].text().rstrip().splitlines()[-1]
    assert last.startswith(WORDS[language][1])
