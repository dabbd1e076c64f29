"""The topics panel: the list with its figures, filter and order, and the tree of the latest message."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import String
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages, write
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

pytestmark = [pytest.mark.processes, needs_chromium]


def names(page: Page) -> list[str]:
    found: list[str] = page.browser.js("[...document.querySelectorAll('tr[data-topic]')].map((e) => e.dataset.topic)")
    return found


def publish(page: Page) -> None:
    twist = Twist()
    twist.linear.x = 0.5
    scan = LaserScan(ranges=[float(i) for i in range(50)])
    for message, topic in ((twist, "cmd_vel"), (scan, "scan"), (String(data="<b>hello</b>"), "chatter")):
        page.node.create_publisher(type(message), topic, LATCHED).publish(message)
    page.browser.wait("document.querySelectorAll('tr[data-topic]').length >= 4")


def tree(page: Page, *paths: str) -> Any:
    """Texts of the tree's rows, once these paths are there."""
    for path in paths:
        page.browser.wait(f"document.querySelector('[data-path={json.dumps(path)}]')")
    return page.browser.js(
        "[...document.querySelectorAll('.tree > div')].map((each) => each.innerText.replace(/\\s+/g, ' '))"
    )


def test_topics_are_listed_with_their_figures(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        assert names(page)[:2] == ["/chatter", "/cmd_vel"]
        browser.wait("document.querySelector('tr[data-topic=\"/cmd_vel\"] td.publishers').textContent == '1'")
        assert (
            browser.js("document.querySelector('tr[data-topic=\"/scan\"] td.type').title")
            == "sensor_msgs/msg/LaserScan"
        )
        page.picture("topics")


def test_a_filter_and_an_order(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        browser.click("th.topic button")
        browser.wait("document.querySelector('tr[data-topic]').dataset.topic == '/scan'")
        browser.click("input[type=search]")
        browser.type("twist")
        browser.wait("document.querySelectorAll('tr[data-topic]').length == 1")
        assert names(page) == ["/cmd_vel"]


def test_the_tree_shows_the_latest_message(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        publisher = page.node.create_publisher(Twist, "cmd_vel", LATCHED)
        browser.click("tr[data-topic='/cmd_vel'] button")
        browser.click("[data-path=linear]")
        assert tree(page, "linear.x") == ["linear", "x 0.5", "y 0", "z 0", "angular"]
        twist = Twist()
        twist.linear.x = -1.25
        publisher.publish(twist)
        browser.wait("document.querySelector('[data-path=\"linear.x\"]').innerText.includes('-1.25')")
        page.picture("topics_tree")


def test_texts_of_the_network_are_texts(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        browser.click("tr[data-topic='/chatter'] button")
        assert tree(page, "data") == ['data "<b>hello</b>"']


def test_arrays_are_folded_and_shown_by_parts(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        browser.click("tr[data-topic='/scan'] button")
        assert "ranges [50] 0, 1, 2, 3, 4, 5 …" in tree(page, "ranges")
        browser.click("[data-path=ranges]")
        assert "30 more" in tree(page, "ranges[19]")
        browser.click(".tree .more")
        assert "[49] 49" in tree(page, "ranges[49]")


def test_a_number_is_dragged_with_its_topic_and_path_and_picked_by_a_click(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        browser.click("tr[data-topic='/cmd_vel'] button")
        browser.click("[data-path=linear]")
        browser.js("robolink.on('pick', (...all) => { globalThis.picked = all; }) && 0")
        browser.js("addEventListener('drop', (e) => { dropped = e.dataTransfer.getData('text/robolink-field'); })")
        browser.drag_data("[data-path='linear.x']", "header")
        assert json.loads(browser.js("dropped")) == {"topic": "/cmd_vel", "path": "linear.x"}
        browser.click("[data-path='linear.x']")
        assert browser.js("picked") == ["/cmd_vel", "linear.x"]


def test_the_tree_is_walked_by_keys(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        browser.click("tr[data-topic='/cmd_vel'] button")
        browser.wait("document.querySelector('[data-path=linear]')")
        browser.js("document.querySelector('[data-path=linear]').focus()")
        browser.press("ArrowRight")
        tree(page, "linear.x")
        browser.press("ArrowDown")
        assert browser.js("document.activeElement.dataset.path") == "linear.x"


CELLS = "[...document.querySelectorAll('tr[data-topic] :is(td.topic button, td.type)')]"
"""Names and types of all rows."""


def test_names_and_types_are_whole_where_there_is_room(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        publish(page)
        page.node.create_publisher(String, "a_robot_of_many/sensors/which_have/very_long_names/and_types", LATCHED)
        browser.wait("document.querySelectorAll('tr[data-topic]').length >= 5")
        shown = f"{CELLS}.map((each) => each.textContent).join()"
        whole = "robolink.store.list().flatMap((each) => [each.name, each.type]).join()"
        try:
            browser.wait(f"{shown} == {whole}")
            for width in (500, 300):
                browser.resize(width, 600)
                browser.wait(f"{shown}.includes('…')")
                browser.wait(f"{CELLS}.every((each) => each.scrollWidth <= each.clientWidth)")
                browser.wait("document.querySelector('.topics').scrollWidth <= innerWidth")
                titles = browser.js(f"{CELLS}.map((each) => each.title).join()")
                assert titles == browser.js(whole)
                page.picture(f"topics_{width}")
        finally:
            browser.resize(1280, 720)


def test_a_topic_is_opened_with_its_branches_unfolded(browser: Browser) -> None:
    tab = {"id": "topics", "options": {"topic": "/cmd_vel", "open": True}}
    with opened(browser, layout={"columns": [{"width": 50, "cells": [{"tabs": [tab]}]}]}) as page:
        publish(page)
        browser.wait("robolink.layout.kind == 'drive'")
        assert tree(page, "linear.x") == ["linear", "x 0.5", "y 0", "z 0", "angular", "x 0", "y 0", "z 0"]
        assert browser.js("document.querySelector('.detail p').textContent") == "geometry_msgs/msg/Twist"
        browser.click("[data-path=angular]")
        browser.wait("!document.querySelector('[data-path=\"angular.x\"]')")
        options = (
            "JSON.parse(localStorage['robolink.layouts'])[robolink.layout.kind].columns[0].cells[0].tabs[0].options"
        )
        browser.wait(f"{options}.open == 'linear'")  # the browser remembers it
        browser.js("robolink.layout.rebuild()")
        assert tree(page, "linear.x") == ["linear", "x 0.5", "y 0", "z 0", "angular"]


def test_a_bag_has_ages_in_its_time_and_no_publishers(browser: Browser, tmp_path: Path) -> None:
    write(tmp_path / "bag", ten_messages())
    with (
        open_bag(tmp_path / "bag") as bag,
        View(BagSource(bag), Settings(port=0)) as view,
        opened(browser, "topics", view=view) as page,
    ):
        age = "document.querySelector('tr[data-topic=\"/chatter\"] td.age')?.textContent"
        browser.wait(f"/^[0-5]\\.\\d s$/.test({age})")
        assert browser.js("document.querySelector('th.publishers').getClientRects().length") == 0
        page.picture("topics_bag")
