"""Every text of the page has a contrast of 4.5:1 to its ground (3:1 if it is large), in both themes, on each page."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from robolink.learn.page import PageExercises
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages, write
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import opened
from tests.view.page.test_page_errands import robot_scene
from tests.view.page.test_page_learn import begun, failing, learning

pytestmark = [pytest.mark.processes, needs_chromium]

PALE = (Path(__file__).parents[2] / "support" / "pale_texts.js").read_text(encoding="utf-8")
"""JavaScript: how many texts there are, and those that are too pale, with element and contrast."""

THEMES = ("dark", "light")
PANELS = ("world", "topics", "plot", "log", "teleop", "services", "parameters", "images", "graph", "actions")


def check(browser: Browser, *, least: int = 8) -> None:
    """Check all texts that are there."""
    count, pale = browser.js(PALE)
    assert count >= least
    assert not pale, "\n".join(pale)


@pytest.mark.parametrize("theme", THEMES)
def test_all_panels_of_a_robot(browser: Browser, tmp_path: Path, theme: str) -> None:
    with (
        robot_scene(tmp_path) as scene,
        opened(browser, *PANELS, view=scene.view, settings={"theme": theme}),
    ):
        browser.wait("document.querySelectorAll('svg.graph text').length > 3 && document.querySelector('.log li')")
        browser.wait("document.querySelector('[data-parameter]') && document.querySelector('.call')")
        browser.click("tr[data-topic='/odom'] button")
        browser.click("[data-path=pose]")
        browser.js("robolink.emit('pick', '/odom', 'pose.pose.position.x')")
        browser.js("robolink.tell('a note'), robolink.tell('an error', true)")
        browser.click(".layers-button")
        check(browser, least=100)
        browser.press(" ")
        browser.wait("!document.getElementById('stopped').hidden && robolink.stopping.held")
        browser.js("document.activeElement.blur()")
        check(browser, least=100)
        browser.js("document.activeElement.blur()")
        browser.press("?")
        browser.wait("document.querySelector('dialog.help')")
        check(browser, least=100)
        browser.press("Escape")
        browser.press("/")
        browser.wait("document.querySelector('#found button')")
        check(browser, least=100)


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("phone", [False, True])
def test_a_robot_with_a_camera_as_it_opens(browser: Browser, tmp_path: Path, theme: str, phone: bool) -> None:
    browser.resize(*((390, 844) if phone else (1440, 900)), phone=phone)
    try:
        with robot_scene(tmp_path) as scene, opened(browser, view=scene.view, settings={"theme": theme}):
            browser.wait("robolink.layout.kind == 'camera' && robolink.layout.isReady")
            browser.wait("document.querySelectorAll('.panel').length >= 2")
            check(browser)
            if phone:
                browser.click("#more")
                check(browser)
    finally:
        browser.resize(1280, 720)


@pytest.mark.parametrize("theme", THEMES)
def test_a_bag(browser: Browser, tmp_path: Path, theme: str) -> None:
    write(tmp_path / "lap", ten_messages())
    with (
        open_bag(tmp_path / "lap") as bag,
        View(BagSource(bag), Settings(port=0)) as view,
        opened(browser, view=view, settings={"theme": theme}),
    ):
        browser.wait("robolink.layout.kind == 'bag' && document.querySelector('tr[data-topic]')")
        check(browser)


@pytest.mark.parametrize("theme", THEMES)
def test_nothing_runs_and_the_connection_is_lost(browser: Browser, theme: str) -> None:
    with opened(browser, settings={"theme": theme}) as page:
        page.node.destroy_node()
        browser.wait("robolink.layout.kind == 'empty' && document.querySelector('.nothing')")
        check(browser)
        browser.js("robolink.connection.open = () => {}; robolink.connection._socket.close()")
        browser.wait("document.getElementById('state').className === 'bad'")
        check(browser)


@pytest.mark.parametrize("theme", THEMES)
def test_exercises(browser: Browser, tmp_path: Path, theme: str) -> None:
    exercises = PageExercises(begun(tmp_path / "course", "hello"), check=failing)
    with learning(browser, exercises, settings={"theme": theme}):
        browser.wait("document.querySelector('.findings li')")
        check(browser)
