"""The page in a browser beside a system in memory: what tests of panels begin with."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

from robolink.executors import SingleThreadedExecutor
from robolink.node import Node
from robolink.publisher import Publisher
from robolink.view.server import View
from tests.support.browser import Browser
from tests.support.view_clients import Shown, shown, until

PICTURES = Path(os.environ.get("ROBOLINK_PICTURES", Path(tempfile.gettempdir()) / "robolink-pages"))
"""Folder of the screenshots, which are looked at and not compared."""


KINDS = ("empty", "topics", "drive", "camera", "robots", "bag", "learn")
"""Kinds of systems, each of which has a layout of its own: `KINDS` of page/layouts.js."""


class Page:
    """A page that is open: `browser` acts on it, `system` is what it shows."""

    def __init__(self, browser: Browser, system: Shown | None, view: View) -> None:
        self.browser, self._system, self.view = browser, system, view

    @property
    def system(self) -> Shown:
        """The system that is shown."""
        assert self._system is not None, "there is no system beside a bag"
        return self._system

    @property
    def node(self) -> Node:
        """The node of the test."""
        return self.system.node

    def topic(self, name: str) -> str:
        """JavaScript for a topic of the page."""
        return f"robolink.topics.get({json.dumps(name)})"

    def wait_for_topic(self, name: str) -> None:
        """Wait until the page has a message of a topic."""
        self.browser.wait(f"{self.topic(name)}?.latest")

    def wait_for_reader(self, publisher: Publisher[Any]) -> None:
        """Wait until the page has asked for a topic and the server has subscribed for it: nothing is lost.

        For its figures the server may have subscribed before: what it hears then goes to nobody.
        """
        name = publisher.topic_name
        self.browser.wait(f"{self.topic(name)}?.subscription")
        channels = self.system.source.channels
        until(lambda: any(each.topic == name and each.takers for each in list(channels.values())))
        until(lambda: publisher.get_subscription_count() > 0)

    def panel(self, name: str) -> str:
        """CSS selector of a panel."""
        return f".panel[data-panel={name}]"

    def world(self, x: float, y: float) -> tuple[float, float]:
        """Place on the screen of a place in the world, in metres."""
        found = self.browser.js(
            f"(() => {{ const w = robolink.layout.panel('world'), r = w.canvas.getBoundingClientRect();"
            f" return [r.left + w.view.toX({x}) / w.view.ratio, r.top + w.view.toY({y}) / w.view.ratio]; }})()"
        )
        return found[0], found[1]

    def picture(self, name: str) -> None:
        """Take a screenshot."""
        self.browser.screenshot(PICTURES / f"{name}.png")


@contextmanager
def opened(
    browser: Browser, *panels: str, token: bool = True, keep: bool = False, view: View | None = None, **storage: Any
) -> Iterator[Page]:
    """Open the page with panels side by side, by default its own layout. Fails if its console told of an error.

    It is left in any case: it would look for its server, and tell the next test's console that there is none.

    Args:
        browser: Where to open it.
        panels: Names of panels.
        token: False for an address without the token.
        keep: True to keep what an earlier page of the same port has remembered.
        view: View to look at; None makes one of a new system.
        storage: More for the browser's memory: `settings={"language": "pt"}`; `layout` is that of each kind of system.
    """
    browser.problems.clear()
    with shown() if view is None else nullcontext() as system:
        seen = view or system.view  # type: ignore[union-attr]
        browser.call("Network.clearBrowserCookies")
        if not keep:
            _remember(browser, seen, panels, storage)
        try:
            browser.open(seen.address if token else seen.address.partition("?")[0])
            browser.wait("globalThis.robolink?.connection.isOpen && robolink.layout?.isReady")
            yield Page(browser, system, seen)
            assert not browser.problems, browser.problems
        finally:
            browser.open("about:blank")
            browser.wait("location.href == 'about:blank'")


def _remember(browser: Browser, view: View, panels: tuple[str, ...], storage: dict[str, Any]) -> None:
    """Fill the memory that the browser keeps for this address, from a file of it that runs nothing."""
    browser.open(f"http://127.0.0.1:{view.port}/style.css")
    browser.wait("location.pathname == '/style.css' && document.readyState == 'complete'")
    layout = storage.pop("layout", None)
    if panels:
        layout = {"columns": [{"width": 50, "cells": [{"tabs": [{"id": name}]}]} for name in panels]}
    if layout is not None:
        storage["layouts"] = {prefix + kind: {"changed": True, **layout} for kind in KINDS for prefix in ("", "phone.")}
    for name, value in storage.items():
        browser.js(f"localStorage.setItem('robolink.{name}', {json.dumps(json.dumps(value))})")


def spun(*nodes: Node) -> SingleThreadedExecutor:
    """An executor with nodes, for their services and callbacks: `with spun(node) as executor: executor.spin_once()`."""
    executor = SingleThreadedExecutor(context=nodes[0].context)
    for node in nodes:
        executor.add_node(node)
    return executor
