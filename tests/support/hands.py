"""A person's hands on the page: steps by mouse, by keyboard or by finger, each of which is counted."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from tests.support.browser import Browser


class Step(NamedTuple):
    """What one does, and how many clicks, keys, taps or drags it takes."""

    act: Callable[[Browser, bool], object]
    cost: int = 1


def click(selector: str) -> Step:
    """Click an element, or tap it."""
    return Step(lambda browser, phone: _tap(browser, browser.place(selector)) if phone else browser.click(selector))


def click_at(selector: str, across: float, down: float) -> Step:
    """Click or tap a place within an element, in shares of its size."""
    return Step(
        lambda browser, phone: (_tap if phone else Browser.click)(browser, inside(browser, selector, across, down))
    )


def drag(selector: str, start: tuple[float, float], end: tuple[float, float], *, hold: bool = False) -> Step:
    """Drag within an element, between places in shares of its size; with `hold` the finger or button stays down."""

    def act(browser: Browser, phone: bool) -> None:
        browser.place(selector)
        first, last = (inside(browser, selector, *each) for each in (start, end))
        if phone:
            browser.touch(first)
            browser.touch(last)
        else:
            browser.grab(first, last)
        if not hold:
            let_go(browser, phone, last)

    return Step(act)


def choose(selector: str, value: str) -> Step:
    """Choose from a menu: one opens it, and takes an entry."""
    return Step(lambda browser, phone: browser.choose(selector, value), 2)


def key(name: str) -> Step:
    """Press a key."""
    return Step(lambda browser, phone: browser.press(name))


def hold(name: str) -> Step:
    """Press a key, and keep it down."""
    return Step(lambda browser, phone: browser.press(name, hold=True))


def text(typed: str) -> Step:
    """Type a text where the keyboard is."""
    return Step(lambda browser, phone: browser.type(typed))


def see(condition: str) -> Step:
    """Wait until one sees something, as JavaScript has it: this costs nothing."""
    return Step(lambda browser, phone: browser.wait(condition), 0)


def inside(browser: Browser, selector: str, across: float, down: float) -> tuple[float, float]:
    """The place within an element, in pixels."""
    box = f"document.querySelector({selector!r}).getBoundingClientRect()"
    left, top, width, height = browser.js(f"((r) => [r.left, r.top, r.width, r.height])({box})")
    return left + across * width, top + down * height


def let_go(browser: Browser, phone: bool, at: tuple[float, float] = (0, 0)) -> None:
    """Take the finger away, or let go of the mouse's button."""
    if phone:
        browser.touch()
    else:
        browser.let_go(at)


def do(browser: Browser, steps: list[Step], *, phone: bool) -> int:
    """Do all steps, and return how many clicks, keys, taps and drags they took."""
    for each in steps:
        each.act(browser, phone)
    return sum(each.cost for each in steps)


def _tap(browser: Browser, at: tuple[float, float]) -> None:
    browser.touch(at)
    browser.touch()
