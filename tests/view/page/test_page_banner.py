"""The banner of STOP: what it says to whom, what presses and what releases, and a connection that is lost meanwhile."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from robolink import Context, Node
from robolink.control.stop_lock import QOS, TOPIC, StopLock
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import Bool
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened
from tests.support.view_clients import until

pytestmark = [pytest.mark.processes, needs_chromium]

HELD = "robolink.stopping.held && !document.getElementById('stopped').hidden"
RELEASED = "!robolink.stopping.held && document.getElementById('stopped').hidden"
TEXT = "document.getElementById('stopped').textContent"
RELEASE = "#stopped .release"


@contextmanager
def held(browser: Browser, *, language: str = "en", theme: str = "light") -> Iterator[Page]:
    """A page with STOP pressed."""
    with opened(browser, "topics", settings={"language": language, "theme": theme}) as page:
        browser.press(" ")
        browser.wait(HELD)
        yield page


def at_once(browser: Browser) -> None:
    """Take away the guard against double clicks."""
    browser.js("robolink.stopping.since = -1e9")


@pytest.mark.parametrize("language", ["en", "pt"])
@pytest.mark.parametrize("width", [320, 390, 1280])
def test_it_says_who_obeys_and_who_does_not_and_what_that_means(browser: Browser, language: str, width: int) -> None:
    browser.resize(width, 720, phone=width < 700)
    try:
        with held(browser, language=language, theme="light" if width == 390 else "dark") as page:
            nobody = {"en": "No robot is known", "pt": "Nenhum robô conhecido"}[language]
            assert nobody in browser.js(TEXT)
            with page.system.spinning():
                StopLock(page.node, lambda _: None)
                browser.wait(f"{TEXT}.includes('/robot: {'obeys' if language == 'en' else 'obedece'}')")
            base = deaf_base(page, [f"/a_robot_with_a_name/number_{i}/cmd_vel" for i in range(8)])
            some = "/a_robot_with_a_name/number_3/cmd_vel and 4 more" if language == "en" else "e mais 4"
            browser.wait(f"{TEXT}.includes('/base') && {TEXT}.includes('{some}')")
            page.picture(f"stopped_{language}_{width}")
            assert browser.js("document.documentElement.scrollWidth") <= width
            right, bottom = browser.js(
                f"(({{right, bottom}}) => [right, bottom])(document.querySelector('{RELEASE}').getBoundingClientRect())"
            )
            assert right <= width
            assert bottom <= 300
            base.try_shutdown()
    finally:
        browser.resize(1280, 720)


def deaf_base(page: Page, topics: list[str]) -> Context:
    """A base that drives and does not listen; its context."""
    context = page.system.new_context()
    node = Node("base", context=context)
    for topic in topics:
        node.create_subscription(Twist, topic, print, 10)
    return context


def test_a_double_click_and_space_release_nothing_and_enter_does(browser: Browser) -> None:
    with opened(browser, "topics"):
        x, y = browser.place("#stop")
        browser.click((x, y), count=2)
        browser.click((x, y), count=2)
        browser.wait(HELD)
        browser.click(RELEASE)  # too soon to be meant
        at_once(browser)
        browser.js(f"document.querySelector('{RELEASE}').focus()")
        browser.press(" ")
        browser.press(" ")
        assert browser.js(HELD)
        browser.press("Enter")
        browser.wait(RELEASED)


def test_stop_is_pressed_when_the_finger_comes_down(browser: Browser) -> None:
    with opened(browser, "topics"):
        x, y = browser.place("#stop")
        browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", buttons=1, clickCount=1)
        browser.wait(HELD)
        browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y + 200, button="left", clickCount=1)
        assert browser.js(HELD)


def test_space_stops_wherever_the_mouse_has_left_the_keyboard(browser: Browser) -> None:
    with opened(browser, "world"):
        browser.click("#theme")
        browser.press(" ")
        browser.wait(HELD)
        browser.click("#theme")  # as it was


def test_other_pages_and_topics_release_it_and_pages_without_the_token_only_look(browser: Browser) -> None:
    with opened(browser, "topics", token=False) as page:
        publisher = page.node.create_publisher(Bool, TOPIC, QOS)
        browser.press(" ")
        publisher.publish(Bool(data=True))
        browser.wait(HELD)
        assert browser.js(f"document.querySelector('{RELEASE}').disabled && document.getElementById('stop').disabled")
        publisher.publish(Bool(data=False))
        browser.wait(RELEASED)
        assert not browser.js("robolink.stopping.pending")


def test_a_press_without_a_connection_is_sent_when_it_is_back(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        lose(browser)
        browser.press(" ")
        browser.wait(f"{TEXT}.includes('not confirmed')")
        page.picture("stop_not_confirmed")
        assert page.view.hub.stopping is not None
        assert not page.view.hub.stopping.held
        browser.js("found()")
        browser.wait(HELD)
        assert page.view.hub.stopping.held


def test_what_was_released_meanwhile_is_told_after_a_lost_connection(browser: Browser) -> None:
    with held(browser) as page:
        lose(browser)
        assert browser.js(f"{HELD} && document.querySelector('{RELEASE}').disabled")
        with page.system.client() as other:
            other.send("stop", held=False)
            assert page.view.hub.stopping is not None
            until(lambda: not page.view.hub.stopping.held)  # type: ignore[union-attr]
        browser.js("found()")
        browser.wait(RELEASED)


def lose(browser: Browser) -> None:
    """Lose the connection until the page calls found()."""
    browser.js(
        "(({connection}) => { const open = connection.open.bind(connection); connection.open = () => {};"
        " globalThis.found = () => { connection.open = open; open(); return 0; };"
        " connection._socket.close(); })(robolink)"
    )
    browser.wait("!robolink.connection.isOpen")
