"""The page itself: STOP, connection, languages, themes, layout, timeline, keyboard and phone."""

from __future__ import annotations

import gzip
import posixpath
import re
from pathlib import Path

import pytest

import robolink.view
from robolink.bag.reader import open_bag
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import Int32
from robolink.view.server import Settings, View
from robolink.view.server.access import find
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages, write
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened, spun
from tests.support.spins import spin_until

FILES = Path(str(robolink.view.__file__)).with_name("page")
MOST = 90_000
"""Most bytes that the page loads as it opens with a robot that drives, gzipped."""
MOST_OF_ALL = 98_000
EXERCISES = ("panels/learn.js", "panels/learn_track.js", "panels/learn.css")
"""Files of the panel of exercises, which only `robolink learn view` asks for: they are not counted into the others."""
MOST_OF_EXERCISES = 8_000
IMPORTED = re.compile(r'from "(\.[^"]*)"')

browsing = [pytest.mark.processes, needs_chromium]


def test_the_page_weighs_at_most_90_kb_as_it_opens() -> None:
    found = {path: find(f"/{path}") for path in (each.relative_to(FILES).as_posix() for each in FILES.rglob("*"))}
    sizes = {path: len(gzip.compress(file.body)) for path, file in found.items() if file is not None}
    assert len(sizes) > 30
    opening = sum(sizes[path] for path in opened_with("world", "topics", "plot", "log", "teleop"))
    exercises = {path: sizes.pop(path) for path in EXERCISES}
    assert opening <= MOST, sizes
    assert sum(sizes.values()) <= MOST_OF_ALL, sizes
    assert sum(exercises.values()) <= MOST_OF_EXERCISES, exercises


def opened_with(*panels: str) -> set[str]:
    """Return the paths of all files that the page loads when it opens with these panels."""
    known = {each.relative_to(FILES).as_posix() for each in FILES.iterdir() if each.is_file()}
    left = [*known, *(f"panels/{name}.js" for name in panels)]
    while left:
        path = left.pop()
        known.add(path)
        if path.endswith(".js"):
            text = (FILES / path).read_text(encoding="utf-8")
            names = {
                posixpath.normpath(posixpath.join(posixpath.dirname(path), each)) for each in IMPORTED.findall(text)
            }
            left += names - known
    return known


class TestInTheBrowser:
    """Actions of a person."""

    pytestmark = browsing

    @pytest.mark.parametrize("way", ["button", "key"])
    def test_stop_sends_zeros_to_every_cmd_vel(self, browser: Browser, way: str) -> None:
        with opened(browser) as page:
            heard: list[tuple[str, float]] = []
            other = page.node.create_publisher(Twist, "/r2/cmd_vel", 10)
            for topic in ("/cmd_vel", "/r2/cmd_vel"):
                page.node.create_subscription(
                    Twist, topic, lambda twist, topic=topic: heard.append((topic, twist.linear.x)), 10
                )
            browser.wait("robolink.drivable().size == 2")
            if way == "button":
                browser.click("#stop")
            else:
                browser.press(" ")
            with spun(page.node) as executor:
                spin_until(executor, lambda: {("/cmd_vel", 0.0), ("/r2/cmd_vel", 0.0)} <= set(heard))
            browser.wait("document.getElementById('stopped').textContent.includes('/r2/cmd_vel')")
            page.picture(f"stop_{way}")
            other.destroy()

    def test_without_the_token_the_page_looks_and_does_not_act(self, browser: Browser) -> None:
        with opened(browser, token=False):
            browser.wait("document.getElementById('state').textContent == 'read-only'")
            assert browser.js("document.getElementById('stop').disabled")
            browser.press("g")

    def test_a_lost_connection_is_told_and_comes_back_by_itself(self, browser: Browser) -> None:
        with opened(browser, "topics") as page:
            page.node.create_publisher(Int32, "count", 10)
            browser.wait("document.querySelector('tr[data-topic=\"/count\"]')")
            browser.js("robolink.connection._socket.close()")
            browser.wait("document.getElementById('state').textContent.includes('lost')", 2)
            browser.wait("document.getElementById('state').textContent == 'connected'")
            browser.wait(f"{page.topic('/count')}.channel")

    def test_portuguese_by_a_click_and_remembered(self, browser: Browser) -> None:
        with opened(browser, "world", "topics") as page:
            browser.click("#language")
            browser.wait("document.getElementById('stop').textContent == 'PARAR'")
            assert browser.js("document.documentElement.lang") == "pt"
            browser.wait("document.querySelector('[data-tab=world]').textContent == 'Mundo' && robolink.layout.isReady")
            page.picture("portuguese")
            browser.open(page.view.address)
            browser.wait("document.getElementById('stop')?.textContent == 'PARAR'")

    def test_all_words_are_there_in_both_languages(self, browser: Browser) -> None:
        with opened(browser):
            missing = browser.js(
                "import('/words.js').then(({ WORDS: { en, pt } }) =>"
                " [...Object.keys(en).filter((k) => !(k in pt)), ...Object.keys(pt).filter((k) => !(k in en))])"
            )
            assert missing == []

    def test_every_panel_in_portuguese_in_the_dark_and_on_a_phone(self, browser: Browser) -> None:
        names = ["plot", "log", "teleop", "services", "parameters", "images", "graph", "actions"]
        with opened(browser, *names, settings={"language": "pt", "theme": "dark"}) as page:
            missing = browser.js(
                "import('/words.js').then(({ WORDS: { en, pt } }) => Object.keys(en).filter((key) => !pt[key]))"
            )
            assert missing == []
            page.picture("panels_portuguese")
            browser.resize(400, 800, phone=True)
            try:
                for number, name in enumerate(names):
                    browser.click(f".tabs button:nth-child({number + 1})")
                    browser.wait(f"document.querySelector('.panel-{name}').clientWidth > 380")
                    assert browser.js("document.documentElement.scrollWidth") <= 400, name
                page.picture("panels_phone")
            finally:
                browser.resize(1280, 720)

    def test_dark_and_light(self, browser: Browser) -> None:
        with opened(browser) as page:
            ground = "getComputedStyle(document.body).backgroundColor"
            before = browser.js(ground)
            browser.press("t")
            browser.wait(f"{ground} != {before!r}")
            page.picture("dark")
            browser.click("#theme")
            browser.wait(f"{ground} == {before!r}")

    def test_panels_are_added_moved_and_removed_and_remembered(self, browser: Browser) -> None:
        with opened(browser, "world") as page:
            browser.choose("#add", "topics")
            browser.wait("document.querySelectorAll('.column').length == 2 && robolink.layout.panel('topics')")
            browser.click(".cell:has(.panel-topics) button[title=move]")
            browser.wait("document.querySelectorAll('.column').length == 1")
            browser.click(".cell:has(.panel-topics) button[title=move]")
            browser.wait("document.querySelectorAll('.column').length == 2")
            before = browser.js("document.querySelector('.panel-world').clientWidth")
            x, y = page.browser.place(".splitter.vertical")
            browser.drag((x, y), (x + 150, y))
            browser.wait(f"document.querySelector('.panel-world').clientWidth > {before} + 120")
            browser.open(page.view.address)
            browser.wait("globalThis.robolink?.layout?.isReady")
            assert browser.js("document.querySelectorAll('.column').length") == 2
            assert browser.js("document.querySelector('.panel-world').clientWidth") > before + 120
            browser.click(".cell:has(.panel-topics) button[title='remove panel']")
            browser.wait("document.querySelectorAll('.panel').length == 1")

    def test_nonsense_in_the_browser_s_memory_is_forgotten(self, browser: Browser) -> None:
        with opened(browser, layout={"columns": 7}, settings=[1]):
            browser.wait("document.querySelector('.panel-topics')")

    def test_shortcuts_are_listed_by_a_question_mark(self, browser: Browser) -> None:
        with opened(browser, "world", "topics") as page:
            browser.press("?")
            browser.wait("document.querySelector('dialog[open] dt')")
            page.picture("help")
            browser.press("Escape")
            browser.wait("!document.querySelector('dialog')")
            browser.press("2")
            browser.wait("document.activeElement.dataset.panel == 'topics'")

    def test_the_last_minute_is_scrubbed(self, browser: Browser) -> None:
        with opened(browser, "topics") as page:
            publisher = page.node.create_publisher(Int32, "count", 10)
            browser.wait("document.querySelector('tr[data-topic=\"/count\"]')")
            browser.click("tr[data-topic='/count'] button")
            page.wait_for_reader(publisher)
            publisher.publish(Int32(data=1))
            browser.wait(f"{page.topic('/count')}.latest?.data == 1")
            browser.js("new Promise((done) => setTimeout(done, 1000))")
            middle = browser.js("robolink.clock()")
            browser.js("new Promise((done) => setTimeout(done, 1000))")
            publisher.publish(Int32(data=2))
            browser.wait("document.querySelector('[data-path=data]').innerText.includes('2')")
            browser.press("p")
            browser.wait("!robolink.time.live")
            scrub(page, middle)
            browser.wait("document.querySelector('[data-path=data]').innerText.includes('1')")
            page.picture("timeline")
            publisher.publish(Int32(data=3))
            browser.press("l")
            browser.wait("document.querySelector('[data-path=data]').innerText.includes('3')")

    def test_a_bag_is_played_paused_sought_and_at_another_speed(self, browser: Browser, tmp_path: Path) -> None:
        write(tmp_path / "bag", ten_messages())
        with (
            open_bag(tmp_path / "bag") as bag,
            View(BagSource(bag), Settings(port=0)) as view,
            opened(browser, "topics", view=view) as page,
        ):
            browser.click("tr[data-topic='/chatter'] button")
            browser.wait("document.querySelector('[data-path=data]') && robolink.timeline.bag.playing")
            browser.wait("robolink.timeline.bag.time > robolink.timeline.bag.start + 300")  # it shows how far it is
            browser.wait("Number(document.getElementById('scrub').value) > 0.03")
            browser.press("p")
            browser.wait("!robolink.timeline.bag.playing")
            x, y = browser.place("#scrub")
            browser.click((x, y))
            begin, end = browser.js("[robolink.timeline.bag.start, robolink.timeline.bag.end]")
            browser.wait(f"Math.abs(robolink.timeline.bag.time - {(begin + end) / 2}) < 200")
            browser.wait("document.querySelector('[data-path=data]').innerText.includes('4')")
            browser.wait("document.getElementById('when').textContent == '0:04.5 / 0:09.0'")
            page.picture("bag")
            browser.choose("#rate", "8")
            browser.wait("robolink.timeline.bag.speed == 8")
            browser.click("#pause")
            browser.wait("document.querySelector('[data-path=data]').innerText.includes('8')")

    def test_on_a_phone_one_panel_at_a_time(self, browser: Browser) -> None:
        browser.resize(390, 800, phone=True)
        try:
            with opened(browser, "world", "topics") as page:
                assert browser.js("document.querySelector('.panel-topics').clientHeight") == 0
                page.picture("phone_world")
                browser.click(".tabs button:nth-child(2)")
                browser.wait("document.querySelector('.panel-topics').clientHeight > 300")
                assert browser.js("document.documentElement.scrollWidth") <= 390, "nothing sticks out"
                assert browser.js("document.getElementById('stop').getBoundingClientRect().right") <= 390
                page.picture("phone_topics")
        finally:
            browser.resize(1280, 720)

    def test_the_keyboard_reaches_everything_in_order(self, browser: Browser) -> None:
        with opened(browser, "world", "topics"):
            seen = []
            for _ in range(40):
                browser.press("Tab")
                seen.append(browser.js("document.activeElement.id || document.activeElement.className"))
            wanted = ["add", "theme", "language", "help", "stop", "world", "fit", "splitter vertical", "pause", "scrub"]
            assert [each for each in seen if each in wanted][: len(wanted)] == wanted


def scrub(page: Page, at: float) -> None:
    """Drag the timeline's handle to a time in milliseconds."""
    find = "document.getElementById('scrub').getBoundingClientRect()"
    left, width, y = page.browser.js(f"(({{left, width, top, height}}) => [left, width, top + height / 2])({find})")
    now, shown = page.browser.js("[robolink.clock(), robolink.time.at]")
    thumb = 16
    start, end = (left + thumb / 2 + (width - thumb) * (1 - (now - each) / 60_000) for each in (shown, at))
    page.browser.drag((start, y), (end, y))
