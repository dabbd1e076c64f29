"""The page on a phone: what one drives by stands where thumbs are, and STOP stays in reach."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened
from tests.view.page.test_page_layout import PANELS, frames, kind

pytestmark = [pytest.mark.processes, needs_chromium]

TOLD = '{state: "on", path: "x", seconds: 86_399, bytes: 999e9, messages: 1e9, dropped: 123_456_789}'
BOX = "(({{ left, top, right, bottom }}) => [left, top, right, bottom])({}.getBoundingClientRect())"


@contextmanager
def phone(browser: Browser, width: int = 390, height: int = 844) -> Iterator[Page]:
    """The page of a robot with a camera, on a phone."""
    browser.resize(width, height, phone=True)
    try:
        with opened(browser) as page:
            page.node.create_publisher(Image, "image", 10)
            frames(page.node, "base_link")
            page.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
            kind(page, "camera")
            browser.wait("document.querySelector('.stick')")
            yield page
    finally:
        browser.resize(1280, 720)


def box(browser: Browser, selector: str) -> list[float]:
    """Left, top, right and bottom of an element, in pixels."""
    found: list[float] = browser.js(BOX.format(f"document.querySelector('{selector}')"))
    return found


def test_one_drives_below_the_world_or_the_camera(browser: Browser) -> None:
    with phone(browser) as page:
        assert browser.js(PANELS)[0] == "world|images / teleop"
        pages = browser.js("[...document.querySelectorAll('.tabs button')].map((each) => each.innerText)")
        assert pages == ["Drive", "Plot", "Topics", "Log"]
        left, top, right, bottom = box(browser, ".stick")
        assert right - left >= 150
        assert top > 844 / 2, "where thumbs are"
        assert bottom < box(browser, ".tabs")[1]
        assert box(browser, ".panel-world")[3] <= top
        browser.touch(((left + right) / 2, (top + bottom) / 2))
        browser.touch(((left + right) / 2, top + 2))
        browser.wait("Number(document.querySelector('.velocity').textContent.split(' ')[0]) > 0.3")
        page.picture("phone_drive")
        browser.touch()
        browser.click("[data-tab=images]")
        browser.wait("document.querySelector('.panel-images')?.clientHeight > 200")
        assert box(browser, ".stick")[1] == pytest.approx(top), "the stick stays"
        page.picture("phone_camera")


def test_nothing_sticks_out_and_stop_is_large_on_every_page(browser: Browser) -> None:
    with phone(browser):
        for number in range(1, 5):
            browser.click(f".tabs button:nth-child({number})")
            left, top, right, bottom = box(browser, "#stop")
            assert (right - left >= 100, bottom - top >= 44, right <= 390, top >= 0) == (True,) * 4
            assert browser.js("document.documentElement.scrollWidth") <= 390
            assert browser.js("document.documentElement.scrollHeight") <= 844


def test_the_map_is_free_and_the_rest_is_in_one_menu(browser: Browser) -> None:
    with phone(browser) as page:
        shown = (
            "[...document.querySelectorAll('.panel-world .toolbar > *')].filter((each) => each.getClientRects().length)"
        )
        assert browser.js(f"{shown}.length") <= 3
        assert browser.js("document.getElementById('add').getClientRects().length") == 0
        browser.click("#more")
        browser.wait("document.getElementById('add').getClientRects().length")
        for name in ("add", "record", "theme", "language", "help"):
            left, _, right, bottom = box(browser, f"#{name}")
            assert (left >= 0, right <= 390, bottom <= 844) == (True,) * 3, name
        page.picture("phone_menu")
        browser.choose("#add", "parameters")
        browser.wait("document.querySelector('.panel-parameters')?.clientHeight > 300")
        assert browser.js("document.querySelector('.tabs button:last-child').ariaPressed") == "true"
        browser.click("#more")
        browser.choose("#add", "remove")
        browser.wait("!robolink.layout.has('parameters')")


def test_on_its_side_the_stick_is_beside_the_world(browser: Browser) -> None:
    with phone(browser, 844, 390) as page:
        world, stick, stop = (box(browser, each) for each in (".panel-world", ".stick", "#stop"))
        assert world[2] <= stick[0]
        assert stick[3] <= 390
        assert stop[2] <= 844
        assert world[3] - world[1] > 280
        assert browser.js("document.documentElement.scrollHeight") <= 390
        page.picture("phone_on_its_side")


@pytest.mark.parametrize("language", ["en", "pt"])
@pytest.mark.parametrize("width", [320, 390])
def test_stop_stays_in_reach_whatever_the_header_tells(browser: Browser, language: str, width: int) -> None:
    browser.resize(width, 700, phone=True)
    try:
        with opened(browser, "world", settings={"language": language, "theme": "light"}) as page:
            inside = f"document.getElementById('stop').getBoundingClientRect().right <= {width}"
            browser.js(f"robolink.connection.emit('recording', {TOLD})")
            page.picture(f"phone_recording_{language}_{width}")
            assert browser.js(inside)
            browser.js("robolink.connection.open = () => {}; robolink.connection._socket.close()")
            browser.wait("document.getElementById('state').className === 'bad'")
            page.picture(f"phone_lost_{language}_{width}")
            assert browser.js(inside)
            assert browser.js("document.documentElement.scrollWidth") <= width
    finally:
        browser.resize(1280, 720)
