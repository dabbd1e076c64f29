"""The panel of exercises: a student with an editor beside the page, in both themes and languages, and on a phone."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from robolink.grading.languages import Language
from robolink.grading.mistakes import Mistake
from robolink.learn.exercise import Exercise
from robolink.learn.folder import StudentFolder, start_folder
from robolink.learn.page import PageExercises
from robolink.learn.report import Body, Contact, Line, Report, Track
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened
from tests.support.view_clients import shown

pytestmark = [pytest.mark.processes, needs_chromium]

SOLUTIONS = Path(__file__).parents[2] / "learn" / "solutions"
FINDINGS = "[...document.querySelectorAll('.findings li')].map((each) => each.innerText.replace(/\\s+/g, ' '))"
CHOSEN = "document.querySelector('.learn nav [aria-current=true]').dataset.name"
FILM = "robolink.layout.panel('learn').film"
PIXELS = """((name) => {
  const canvas = document.querySelector('.film canvas'), wanted = document.createElement('canvas').getContext('2d');
  wanted.fillStyle = robolink.colour(name);
  wanted.fillRect(0, 0, 1, 1);
  const [r, g, b] = wanted.getImageData(0, 0, 1, 1).data;
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) count += [r, g, b].every((each, k) => Math.abs(data[i + k] - each) < 4);
  return count;
})"""
"""JavaScript function of a colour's name: how many pixels of the world have it."""
HTML = "<img src=x onerror='globalThis.hacked = true'>"
SQUARE = [(0.2, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.2, -0.2)]
TRACK = Track(
    [(0.0, 0.0, 9.0, 0.0), (9.0, 0.0, 9.0, 2.0), (9.0, 2.0, 0.0, 2.0)],
    [
        Body("ada", True, circle=0.3, path=[value for i in range(80) for value in (1 + i / 10, 1.0, 0.0)]),
        Body(HTML, True, corners=SQUARE, first=20, path=[value for i in range(60) for value in (4.0, i / 40, 1.57)]),
        Body("box", False, corners=SQUARE, path=[6.0, 0.4, 0.3]),
    ],
    0.1,
    [Contact(5.0, 5.5, 1.0)],
)


def begun(folder: Path, *done: str, language: Language = "en") -> StudentFolder:
    """A student's folder, in which some exercises are done."""
    made = start_folder(str(folder), language=language)
    made.write()
    for each in done:
        made.finish(made.chosen(each))
    return made


@contextmanager
def learning(browser: Browser, exercises: PageExercises, **options: Any) -> Iterator[Page]:
    """The page of a folder in a browser, as `robolink learn view` serves it."""
    with shown(exercises) as system, opened(browser, "learn", view=system.view, **options) as page:
        browser.wait("document.querySelectorAll('.learn nav li').length > 0")
        yield page


def failing(exercise: Exercise, file: Path, language: Language, *, stop: threading.Event) -> Report:
    """A check as any other, whose texts are HTML."""
    mistake = Mistake("exception", f"ValueError: {HTML}", 12, f"    f('{HTML}')")
    return Report([Line(True, "it drives"), Line(False, HTML)], mistake, printed=HTML, seconds=0.3, track=TRACK)


def test_a_student_sees_why_saves_and_goes_on(browser: Browser, tmp_path: Path) -> None:
    folder = begun(tmp_path / "mine", "walk", "hello", "timer", "publisher", "ramp", "square", "subscriber")
    with learning(browser, PageExercises(folder)) as page:
        browser.wait(f"{FINDINGS}.length == 2")
        assert browser.js(FINDINGS) == ["✓ it drives while the way is free", "✗ it drove 3.8 m into the wall"]
        assert browser.js(CHOSEN) == "stop"
        assert browser.js("document.querySelector('.learn nav p').textContent") == "7 of 31 exercises done"
        browser.wait(f"{FILM}.at > 1")
        assert browser.js(f"{PIXELS}('bad')") == 0
        way = browser.js(f"{PIXELS}('accent')")
        browser.js(f"{FILM}.slider.focus()")
        browser.press("End")
        browser.wait(f"!{FILM}.changed && {FILM}.at == {FILM}.end")
        assert browser.js(f"{PIXELS}('bad')") > 50, "a cross where it touched the wall"
        assert browser.js(f"{PIXELS}('accent')") > way + 200, "its path"
        page.picture("learn_fails")
        browser.click(".learn .row button:nth-child(2)")
        browser.wait("document.querySelector('.tips li')?.innerText.includes('ranges[len(ranges) // 2]')")
        assert browser.js(f"{FILM}.at == {FILM}.end"), "a hint does not play the path again"
        (tmp_path / "mine" / "08_stop.py").write_bytes((SOLUTIONS / "08_stop.py").read_bytes())
        browser.wait("document.querySelector('.learn nav li.done [data-name=stop]')")
        browser.wait(f"{FINDINGS}.length == 3")
        assert browser.js(FINDINGS)[1] == "✓ it stops before it touches the wall"
        browser.wait(f"{FILM}.playing && {FILM}.at > 3")
        page.picture("learn_done")
        browser.click(".learn .row button:last-child")
        browser.wait("document.querySelector('.learn h3').textContent.startsWith('09_react.py')")


CODE = "[...document.querySelectorAll('.code span')].map((each) => each.textContent)"
"""Lines of the code that is shown."""
FAILED = "[...document.querySelectorAll('.code .failed')].map((each) => each.textContent)"


def test_the_page_shows_path_and_code_with_the_line_that_failed(browser: Browser, tmp_path: Path) -> None:
    def check(exercise: Exercise, file: Path, language: Language, *, stop: threading.Event) -> Report:
        return Report(mistake=Mistake("exception", "ValueError: no", 42, "raise"), seconds=0.1)

    folder = begun(tmp_path)
    file = tmp_path / "01_walk.py"
    given = [*(f"x{i} = {i}" for i in range(40)), HTML, "raise ValueError('no')", *(f"y{i} = {i}" for i in range(40))]
    file.write_text("\n".join(given), encoding="utf-8")
    browser.call("Browser.grantPermissions", permissions=["clipboardReadWrite", "clipboardSanitizedWrite"])
    with learning(browser, PageExercises(folder, check=check)) as page:
        browser.wait(f"{FAILED} == \"raise ValueError('no')\\n\"")
        assert browser.js(CODE) == [f"{line}\n" for line in given]
        assert browser.js("document.querySelector('.path code').textContent") == str(file)
        seen = "((rect, box) => rect.top >= box.top && rect.bottom <= box.bottom)"
        rects = "document.querySelector('.failed').getBoundingClientRect(), document.querySelector('.code')"
        browser.wait(f"{seen}({rects}.getBoundingClientRect())")  # it is scrolled to
        page.picture("learn_code")
        browser.click(".path button")
        browser.wait(f"document.querySelector('.note')?.textContent == 'copied: {file}'")
        for width in (900, 560):
            browser.resize(width, 700)
            browser.wait(f"document.querySelector('.learn').scrollWidth <= {width} && {CODE}.length == {len(given)}")
            page.picture(f"learn_code_{width}")
        browser.resize(1280, 720)
        file.write_text("print(1)\n", encoding="utf-8")
        browser.wait(f"{CODE} == 'print(1)\\n'")
        file.unlink()
        browser.click(".learn .call")
        browser.wait("document.querySelector('.code').textContent.startsWith('This file cannot be read.')")
        assert not browser.js("globalThis.hacked ?? false")


def test_by_keyboard_in_portuguese_in_the_dark_and_on_a_phone(browser: Browser, tmp_path: Path) -> None:
    folder = begun(tmp_path, "walk", language="pt")
    with learning(browser, PageExercises(folder, check=failing), settings={"theme": "dark"}) as page:
        browser.wait("document.getElementById('stop').textContent == 'PARAR'")
        browser.wait(f"document.querySelectorAll('.learn nav li').length && {FINDINGS}.length == 3")
        assert "12 | f(" in browser.js(FINDINGS)[2]
        assert browser.js("document.querySelectorAll('.learn img').length") == 0, "no text is HTML"
        browser.js(f"document.querySelector('.learn nav [data-name=hello]').focus(); {FILM}._go({FILM}.end)")
        page.picture("learn_dark")
        browser.press("ArrowDown")
        browser.wait(f"{CHOSEN} == 'timer' && document.activeElement.dataset.name == 'timer'")
        browser.press("ArrowUp")
        browser.wait(f"{CHOSEN} == 'hello' && !document.querySelector('.learn .row button:nth-child(2)').disabled")
        browser.press("Tab")
        browser.wait("document.activeElement.textContent == 'Testar'")
        browser.press("Tab")
        browser.press(" ")
        browser.wait("document.querySelectorAll('.tips li').length == 1")
        browser.press("Tab")
        browser.press("Enter")
        browser.wait("document.activeElement.textContent == 'Reiniciar mesmo?'")
        assert not (tmp_path / "02_hello.mine.py").exists()
        browser.press("Enter")
        browser.wait("document.querySelector('.note')?.textContent.includes('02_hello.mine.py')")
        browser.wait("robolink.connection.learn.saves == 1 && !robolink.connection.learn.checking")
        browser.resize(390, 800, phone=True)
        try:
            browser.wait(f"{FILM}.canvas.clientWidth < 390 && {FINDINGS}.length == 3")
            assert browser.js("document.documentElement.scrollWidth") <= 390, "nothing sticks out"
            page.picture("learn_phone")
            browser.js(f"document.querySelector('.film').scrollIntoView(); {FILM}._go({FILM}.end)")
            browser.wait(f"!{FILM}.playing && !{FILM}.changed && {PIXELS}('accent') > 100")
            assert browser.js(f"{FILM}.canvas.clientHeight") < 150, "as wide as the world is"
            page.picture("learn_phone_film")
            browser.resize(320, 640, phone=True)
            browser.wait(f"{FILM}.canvas.clientWidth < 320")
            assert browser.js("document.documentElement.scrollWidth") <= 320
            page.picture("learn_phone_small")
        finally:
            browser.resize(1280, 720)
        browser.click("#language")
        browser.wait("document.getElementById('stop').textContent == 'STOP'")
        browser.wait("document.querySelector('.learn nav p')?.textContent == '1 of 31 exercises done'")
        browser.wait("document.querySelector('.learn h3').textContent == '02_hello.py: A first node'")
        page.picture("learn_english")
        assert not browser.js("globalThis.hacked ?? false")


def test_without_the_token_or_without_exercises_it_says_why(browser: Browser, tmp_path: Path) -> None:
    with learning(browser, PageExercises(begun(tmp_path), check=failing), token=False):
        browser.wait(f"{FINDINGS}.length == 3")
        buttons = "[...document.querySelectorAll('.learn .row button')].slice(0, 3)"
        assert browser.js(f"{buttons}.every((each) => each.disabled)")
        assert "token" in browser.js(f"{buttons}[0].title")
    with opened(browser, "learn"):
        browser.wait("document.querySelector('.panel-learn').innerText.includes('robolink learn view')")
