"""The teleop panel: keys, stick, speeds, dead-man, emergency stop, and a page that goes while it drives."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened, spun
from tests.support.spins import spin_until

pytestmark = [pytest.mark.processes, needs_chromium]

STICK = ".panel-teleop .stick"


class Robot:
    """Listener to a robot's cmd_vel."""

    def __init__(self, page: Page, kind: type[Any] = Twist, topic: str = "/cmd_vel") -> None:
        self.page, self.heard = page, list[Any]()
        page.node.create_subscription(kind, topic, self.heard.append, 100)
        page.browser.wait(f"robolink.drivable().has({json.dumps(topic)})")
        page.browser.wait("document.querySelector('.stick').ariaDisabled == 'false'")

    @property
    def last(self) -> tuple[float, float, float]:
        """The last velocities: ahead, sideways, turn."""
        twist = getattr(self.heard[-1], "twist", self.heard[-1])
        return twist.linear.x, twist.linear.y, twist.angular.z

    def spin(self, condition: Callable[[], bool]) -> None:
        with spun(self.page.node) as executor:
            spin_until(executor, lambda: bool(self.heard) and condition())

    def drives(self, *wanted: float) -> None:
        """Wait until these are the velocities."""
        try:
            self.spin(lambda: self.last == pytest.approx(wanted, abs=0.02))
        except AssertionError:
            raise AssertionError(f"never {wanted}, but {self.last if self.heard else 'nothing'}") from None

    def stands(self) -> None:
        self.drives(0, 0, 0)


@contextmanager
def driven(browser: Browser, kind: type[Any] = Twist) -> Iterator[tuple[Page, Robot]]:
    with opened(browser, "teleop") as page:
        yield page, Robot(page, kind)


def test_keys_drive_while_they_are_held(browser: Browser) -> None:
    with driven(browser) as (page, robot):
        browser.click(STICK)
        browser.press("w", hold=True)
        robot.drives(0.5, 0, 0)
        browser.press("a", hold=True)
        robot.drives(0.5, 0, 1)
        page.picture("teleop")
        browser.release("w")
        robot.drives(0, 0, 1)
        browser.release("a")
        robot.stands()
        browser.press("q", hold=True)
        robot.drives(0, 0.5, 0)
        browser.release("q")
        robot.stands()


def test_keys_elsewhere_do_not_drive_and_a_lost_focus_stops(browser: Browser) -> None:
    with driven(browser) as (_, robot):
        browser.press("ArrowUp")
        browser.click(STICK)
        browser.press("ArrowUp", hold=True)
        robot.drives(0.5, 0, 0)
        browser.press("Tab")
        robot.stands()
        assert browser.js("document.activeElement.className") == "estop"
        browser.release("ArrowUp")


def test_the_stick_follows_the_mouse_and_stops_when_it_is_let_go(browser: Browser) -> None:
    with driven(browser) as (page, robot):
        browser.js("document.querySelector('.panel-teleop input.linear').select()")
        browser.click(".panel-teleop input.linear", count=3)
        browser.type("2")
        x, y = browser.place(STICK)
        half = browser.js(f"document.querySelector('{STICK}').offsetHeight") / 2
        browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", buttons=1, clickCount=1)
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y - half / 2, button="left", buttons=1)
        robot.drives(1, 0, 0)
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x - 4 * half, y=y, button="left", buttons=1)
        robot.drives(0, 0, 1)
        page.picture("teleop_stick")
        browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, button="left", clickCount=1)
        robot.stands()


def test_a_finger_on_a_phone_drives_a_robot_of_stamped_twists(browser: Browser) -> None:
    with driven(browser, TwistStamped) as (page, robot):
        browser.resize(400, 800, phone=True)
        browser.call("Emulation.setTouchEmulationEnabled", enabled=True)
        try:
            x, y = browser.place(STICK)
            browser.touch((x, y))
            browser.touch((x, y + 200))
            robot.drives(-0.5, 0, 0)
            assert robot.heard[-1].header.stamp.sec > 1_600_000_000
            page.picture("teleop_phone")
            browser.touch()
            robot.stands()
        finally:
            browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
            browser.resize(1280, 720)


def test_the_emergency_stop_is_stop(browser: Browser) -> None:
    with driven(browser) as (page, robot):
        browser.click(STICK)
        browser.press("w", hold=True)
        robot.drives(0.5, 0, 0)
        browser.click(".estop", count=2)  # of a double click the second half releases nothing
        robot.stands()
        browser.wait("robolink.stopping.held && document.querySelector('.estop').textContent == 'RELEASE'")
        assert browser.js("document.querySelector('.stick').ariaDisabled") == "true"
        browser.click(STICK)
        browser.press("w", hold=True)
        count = len(robot.heard)
        robot.spin(lambda: len(robot.heard) > count + 5)
        assert {each.linear.x for each in robot.heard[count:]} == {0.0}
        page.picture("teleop_stopped")
        browser.release("w")
        browser.js("document.querySelector('.estop').focus()")
        browser.press(" ")  # a key that is hit in a hurry never releases
        browser.js("robolink.stopping.since = -1e9")
        browser.click(".estop")
        browser.wait("!robolink.stopping.held")
        browser.click(STICK)
        browser.press("w", hold=True)
        robot.drives(0.5, 0, 0)
        browser.release("w")


def test_stop_in_the_header_lets_go_of_what_is_held(browser: Browser) -> None:
    with driven(browser) as (_, robot):
        browser.click(STICK)
        browser.press("w", hold=True)
        robot.drives(0.5, 0, 0)
        browser.press(" ")
        robot.stands()
        count = len(robot.heard)
        robot.spin(lambda: len(robot.heard) > count + 10)
        assert {each.linear.x for each in robot.heard[count:]} == {0.0}
        browser.release("w")


@pytest.mark.parametrize("way", ["hangs", "goes"])
def test_a_page_that_hangs_or_goes_stops_its_robot(browser: Browser, way: str) -> None:
    with driven(browser) as (_, robot):
        browser.click(STICK)
        browser.press("w", hold=True)
        robot.drives(0.5, 0, 0)
        if way == "goes":
            browser.open("about:blank")
        else:
            browser.js("setTimeout(() => { for (const end = Date.now() + 2500; Date.now() < end;); }) && 0")
        robot.stands()
        browser.release("w")


def test_a_gamepad_drives_while_a_shoulder_button_is_held(browser: Browser) -> None:
    with driven(browser) as (_, robot):
        browser.js(
            "globalThis.pad = {axes: [0, -1, 0.5, 0], buttons: Array.from({length: 16}, () => ({pressed: false}))};"
            " navigator.getGamepads = () => [pad]; document.hasFocus = () => true; 0"
        )
        browser.click(STICK)
        browser.js("pad.buttons[5].pressed = true")
        robot.drives(0.5, 0, -0.5)
        browser.js("pad.buttons[5].pressed = false")
        robot.stands()


def test_without_the_token_the_panel_says_why_it_does_not_drive(browser: Browser) -> None:
    with opened(browser, "teleop", token=False) as page:
        page.node.create_subscription(Twist, "/cmd_vel", print, 10)
        browser.wait("document.querySelector('.why').textContent.includes('without the token')")
        assert browser.js("document.querySelector('.estop').disabled")
