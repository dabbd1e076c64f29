"""The panel of exercises: a student with an editor beside the page, in both themes and languages, and on a phone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from robolink.learn.folder import StudentFolder, start_folder
from robolink.learn.page import PageExercises
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened
from tests.support.view_clients import shown

pytestmark = [pytest.mark.processes, needs_chromium]

SOLUTIONS = Path(__file__).parents[2] / "learn" / "solutions"
FINDINGS = "[...document.querySelectorAll('.findings li')].map((each) => each.innerText.replace(/\\s+/g, ' '))"


def begun(folder: Path, *done: str) -> StudentFolder:
    """A student's folder, in which some exercises are done."""
    made = start_folder(str(folder), language="en")
    made.write()
    for each in done:
        made.finish(made.chosen(each))
    return made


@contextmanager
def learning(browser: Browser, folder: StudentFolder, **options: Any) -> Iterator[Page]:
    """The page of a folder in a browser, as `robolink learn view` serves it."""
    with (
        shown(PageExercises(folder)) as system,
        opened(browser, "learn", view=system.view, **options) as page,
    ):
        browser.wait("document.querySelectorAll('.learn nav li').length > 0")
        yield page


def test_a_student_sees_why_saves_and_goes_on(browser: Browser, tmp_path: Path) -> None:
    folder = begun(tmp_path / "mine", "walk", "hello", "timer", "publisher", "ramp", "square", "subscriber")
    with learning(browser, folder) as page:
        browser.wait(f"{FINDINGS}.length == 2")
        assert browser.js(FINDINGS) == ["✓ it drives while the way is free", "✗ it drove 3.8 m into the wall"]
        assert browser.js("document.querySelector('.learn nav [aria-current=true]').dataset.name") == "stop"
        assert browser.js("document.querySelector('.learn nav p').textContent") == "7 of 28 exercises done"
        browser.wait("!document.querySelector('.film').hidden")
        page.picture("learn_fails")
        browser.wait("robolink.layout.panel('learn').film.at == robolink.layout.panel('learn').film.end")
        page.picture("learn_fails_end")
        browser.click(".learn .row button:nth-child(2)")
        browser.wait("document.querySelector('.tips li')?.innerText.includes('ranges[len(ranges) // 2]')")
        (tmp_path / "mine" / "08_stop.py").write_bytes((SOLUTIONS / "08_stop.py").read_bytes())
        browser.wait("document.querySelector('.learn nav li.done [data-name=stop]')")
        browser.wait(f"{FINDINGS}.length == 3")
        page.picture("learn_done")
        browser.click(".learn .row button:last-child")
        browser.wait("document.querySelector('.learn h3').textContent.startsWith('09_react.py')")
