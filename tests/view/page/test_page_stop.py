"""STOP in launched systems: whoever sends commands, the robot stands, and drives on when it is released.

`ROBOLINK_STOP_SECONDS=10` holds it for ten seconds in each way; `python -m tests.view.page.test_page_stop` prints how
soon the robot stood, in each system and each way.
"""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest

from tests.support.browser import Browser, needs_chromium
from tests.support.domains import free_domain
from tests.support.stop_stage import Stage, Stood

pytestmark = [pytest.mark.processes, needs_chromium]

SYSTEMS = ("wander", "follow", "teleop", "track")
WITHIN = 0.3
"""Seconds within which the robot stands."""
BUSY = 3.0
"""More seconds that a machine which runs other tests may take from the press to what is said and heard."""
LONG, SHORT = 10.0, float(os.environ.get("ROBOLINK_STOP_SECONDS", "1"))
"""Seconds for which it stands: once in the first system, and else."""

HOLDS = "robolink.stopping.held && !document.getElementById('stopped').hidden"


@contextmanager
def staged(name: str) -> Iterator[Stage]:
    with free_domain() as domain, Stage(domain, name) as stage:
        yield stage


def open_page(browser: Browser, address: str) -> None:
    browser.open(address)
    browser.wait("globalThis.robolink?.connection.isOpen && robolink.layout?.isReady", 60.0)


def leave(browser: Browser) -> None:
    browser.open("about:blank")
    browser.wait("location.href == 'about:blank'")


def touch(browser: Browser, place: tuple[float, float]) -> None:
    browser.touch(place)
    browser.touch()


def close_at_once(browser: Browser, place: tuple[float, float]) -> None:
    browser.click(place)
    browser.open("about:blank")


def release(browser: Browser) -> None:
    browser.wait(f"{HOLDS} && !document.querySelector('#stopped .release').disabled")
    browser.wait("performance.now() > robolink.stopping.since + 800")
    browser.click("#stopped .release")
    browser.wait("!robolink.stopping.held && document.getElementById('stopped').hidden")


WAYS: dict[str, Callable[[Browser, tuple[float, float]], object]] = {
    "button": lambda browser, place: browser.click(place),
    "key": lambda browser, _: browser.press(" "),
    "phone": touch,
    "closed": close_at_once,
}
"""Ways to press STOP, whose button is at a place."""


def stop_in_every_way(browser: Browser, stage: Stage, long: float, short: float) -> dict[str, Stood]:
    """Press and release STOP in every way; return how soon the robot stood."""
    address = stage.address()
    found = {}
    for way, press in WAYS.items():
        phone = way == "phone"
        browser.resize(*((390, 844) if phone else (1280, 720)), phone=phone)
        browser.call("Emulation.setTouchEmulationEnabled", enabled=phone)
        open_page(browser, address)
        stage.drives()
        at_stop = functools.partial(press, browser, browser.place("#stop"))
        found[way] = stage.stands_after(at_stop, long if way == "closed" else short)
        if way == "closed":
            open_page(browser, address)
        release(browser)
        stage.drives()
    leave(browser)
    return found


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_robot_stands_in_every_way_whoever_sends_commands(browser: Browser, name: str) -> None:
    with staged(name) as stage:
        found = stop_in_every_way(browser, stage, LONG if name == SYSTEMS[0] else SHORT, SHORT)
    late = {way: each for way, each in found.items() if each.simulated > WITHIN or each.pressed > WITHIN + BUSY}
    assert not late


def test_a_server_that_is_killed_leaves_the_robot_standing_and_the_next_one_knows(browser: Browser) -> None:
    with staged("teleop") as stage:
        open_page(browser, stage.address())
        stage.drives()

        def press_and_kill() -> None:
            browser.click("#stop")
            browser.wait(HOLDS)
            stage.kill_view()

        stage.stands_after(press_and_kill, 2.0)
        leave(browser)
        stage.view = stage.open_view()
        open_page(browser, stage.address())
        browser.wait(HOLDS)
        release(browser)
        stage.drives()
        leave(browser)


def main() -> None:
    """Hold each system for ten seconds in each way, and print how soon it stood."""
    with Browser() as browser:
        for name in SYSTEMS:
            with staged(name) as stage:
                found = stop_in_every_way(browser, stage, LONG, LONG)
            for way, stood in found.items():
                since = f"{stood.said:.3f} s since it was said, {stood.simulated:.3f} s of the world's"
                sys.stdout.write(f"{name} {way}: {stood.pressed:.3f} s, {since}\n")
            sys.stdout.flush()


if __name__ == "__main__":
    main()
