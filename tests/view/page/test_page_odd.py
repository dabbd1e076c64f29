"""The page in odd circumstances: systems that come again, other servers and sizes, an old or forbidden memory."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Int32
from robolink.node import Node
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages, write
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import opened
from tests.support.view_clients import until
from tests.view.page.test_page_errands import robot_scene
from tests.view.page.test_page_layout import driving, frames, kind

pytestmark = [pytest.mark.processes, needs_chromium]

FITS = (
    "((page, stop) => page.scrollWidth <= innerWidth && page.scrollHeight <= innerHeight && stop.left >= 0"
    " && stop.right <= innerWidth && stop.top >= 0)"
    "(document.documentElement, document.getElementById('stop').getBoundingClientRect())"
)
"""JavaScript: nothing sticks out of the page, and STOP is on it."""
FORBIDDEN = (
    "Object.defineProperty(window, 'localStorage', { get() { throw new DOMException('no', 'SecurityError'); } })"
)


def test_a_system_that_is_started_again_goes_on(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        for number in (1, 2):
            context = page.system.new_context()
            node = Node("counter", context=context)
            publisher = node.create_publisher(Int32, "/count", 10)
            if number == 1:
                browser.click("tr[data-topic='/count'] button")
            page.wait_for_reader(publisher)
            publisher.publish(Int32(data=number))
            browser.wait(f"{page.topic('/count')}.latest?.data == {number}")
            context.try_shutdown()
            browser.wait(f"!{page.topic('/count')}.channel")


def test_a_bag_comes_where_a_robot_was(browser: Browser, tmp_path: Path) -> None:
    write(tmp_path / "lap", ten_messages())
    with opened(browser) as page:
        driving(page)
        browser.press(" ")
        browser.wait("robolink.stopping.held")
        port = page.view.port
        page.view.close()
        browser.wait("document.getElementById('state').className === 'bad'")
        assert "true" in browser.js("document.getElementById('stop').ariaPressed"), (
            "it is held until one hears otherwise"
        )
        with open_bag(tmp_path / "lap") as bag, View(BagSource(bag), Settings(port=port)):
            kind(page, "bag")
            assert browser.js("document.querySelector('h1').textContent") == "lap"
            rects = "['stop', 'stopped'].map((id) => document.getElementById(id).getClientRects().length)"
            assert browser.js(rects) == [0, 0]
        browser.problems.clear()  # that there was no server for a while


def test_the_language_is_turned_while_stop_holds(browser: Browser) -> None:
    with opened(browser) as page:
        driving(page)
        browser.press(" ")
        browser.wait("robolink.stopping.held && document.querySelector('#stopped .release')")
        browser.click("#language")
        browser.wait("document.querySelector('#stopped .release').textContent == 'LIBERAR'")
        assert browser.js("document.getElementById('stop').ariaPressed") == "true"
        browser.wait("performance.now() > robolink.stopping.since + 800")
        browser.click("#stopped .release")
        browser.wait("!robolink.stopping.held && document.getElementById('stopped').hidden")


def test_from_a_phone_to_a_screen_and_back(browser: Browser, tmp_path: Path) -> None:
    with robot_scene(tmp_path) as scene:
        browser.resize(390, 844, phone=True)
        try:
            with opened(browser, view=scene.view) as page:
                kind(page, "camera")
                browser.wait("document.querySelector('.stick')")
                for width, height, phone in (
                    (1440, 900, False),
                    (390, 844, True),
                    (844, 390, True),
                    (1280, 720, False),
                ):
                    browser.resize(width, height, phone=phone)
                    browser.wait(f"robolink.layout.isPhone == {str(phone).lower()} && robolink.layout.isReady")
                    browser.wait(FITS)
                    browser.wait("document.querySelector('canvas.world').clientHeight > 150")
        finally:
            browser.resize(1280, 720)


@pytest.mark.parametrize("language", ["en", "pt"])
@pytest.mark.parametrize(("width", "height"), [(1440, 900), (1024, 700), (720, 450), (512, 350)])
def test_small_windows_and_large_letters(browser: Browser, language: str, width: int, height: int) -> None:
    """At 200 % of 1440x900 and 1024x700 a page has half of these sizes."""
    browser.resize(width, height)
    try:
        with opened(browser, settings={"language": language}) as page:
            page.node.create_publisher(Image, "image", 10)
            page.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
            frames(page.node, "base_link")
            kind(page, "camera")
            browser.wait(FITS)
            browser.js("robolink.stopping.press()")
            browser.wait("robolink.stopping.held && document.querySelector('#stopped .release')")
            browser.wait(FITS)
            seen = "((r) => r.bottom <= innerHeight && r.right <= innerWidth)"
            assert browser.js(f"{seen}(document.querySelector('.release').getBoundingClientRect())")
            page.picture(f"odd_{width}_{language}")
    finally:
        browser.resize(1280, 720)


def test_a_panel_may_be_opened_twice(browser: Browser) -> None:
    with opened(browser, "plot") as page:
        publisher = page.node.create_publisher(Int32, "/count", 10)
        browser.choose("#add", "plot")
        browser.wait("document.querySelectorAll('canvas.plot').length == 2 && robolink.layout.isReady")
        browser.wait(f"{page.topic('/count')}")
        browser.js("robolink.emit('pick', '/count', 'data')")
        page.wait_for_reader(publisher)
        browser.js("document.querySelectorAll(\".bar button[title='remove panel']\")[0].click()")
        browser.wait("document.querySelectorAll('canvas.plot').length == 1")
        browser.js("robolink.emit('pick', '/count', 'data')")
        browser.wait("document.querySelectorAll('.chip').length == 1")


@pytest.mark.parametrize(
    "memory",
    [
        {"layout": {"columns": [{"width": 50, "panels": [{"id": "world", "height": 50}]}]}},
        {"layouts": [7], "settings": "dark"},
        {"layouts": {"topics": {"changed": True, "columns": [{"cells": [{"tabs": [{"id": "gone"}, None]}]}]}}},
        {
            "layouts": {
                "topics": {"changed": True, "columns": [{"cells": [{"current": 9, "tabs": [{"id": "topics"}]}]}]}
            }
        },
        {"layouts": {"topics": {"changed": True, "columns": [{"width": -3, "cells": [{"tabs": [{"id": "log"}]}]}]}}},
        {"settings": {"theme": 7, "language": 3, "fixed": {}}},
    ],
)
def test_an_old_or_broken_memory(browser: Browser, memory: dict[str, Any]) -> None:
    with opened(browser, **memory):
        browser.wait("document.querySelectorAll('.panel, .empty').length > 0")


def test_a_memory_that_is_forbidden(browser: Browser) -> None:
    script = browser.call("Page.addScriptToEvaluateOnNewDocument", source=FORBIDDEN)["identifier"]
    try:
        with opened(browser, keep=True) as page:
            driving(page)
            browser.choose("#add", "parameters")
            browser.wait("robolink.layout.panel('parameters')")
            browser.press("t")
            browser.click("#language")
            browser.wait("document.getElementById('stop').textContent == 'PARAR'")
    finally:
        browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)


def test_three_hundred_topics_with_long_names(browser: Browser) -> None:
    with opened(browser) as page:
        made = [
            page.node.create_publisher(Int32, f"/a_fleet/of_many/robots_{i}/with_sensors/and_{'long_' * 12}names", 10)
            for i in range(300)
        ]
        browser.wait("document.querySelectorAll('tr[data-topic]').length >= 300")
        browser.wait(FITS)
        browser.press("/")
        browser.type("robots_299")
        browser.wait("document.querySelector('#found button').innerText.includes('robots_299/')")
        assert browser.js("document.querySelector('.find').scrollWidth <= document.querySelector('.find').clientWidth")
        browser.press("Enter")
        until(lambda: made[299].get_subscription_count() > 0)
        page.picture("odd_many_topics")
