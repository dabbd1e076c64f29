"""The layout: what each kind of system opens with, what a person changes of it, tabs, sizes, and the keyboard."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.geometry_msgs.msg import TransformStamped, Twist, TwistStamped
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages, write
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened

pytestmark = [pytest.mark.processes, needs_chromium]

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
NARROWEST, LOWEST = 260, 150
"""Least width and height of a panel's cell, in pixels: less is a strip."""

PANELS = """[...document.querySelectorAll('main > .column')].map((column) => [...column.querySelectorAll('.cell')].map(
  (cell) => [...cell.querySelectorAll('[role=tab]')].map((tab) => tab.dataset.tab).join('|')).join(' / '))"""
"""JavaScript for the panels that are there: a text a column, with its cells and their tabs."""
CELLS = "[...document.querySelectorAll('.cell')].map((cell) => [cell.clientWidth, cell.clientHeight])"
DRIVE = ["world", "topics|log|teleop / plot"]


def frames(node: Node, *names: str) -> None:
    """Place frames on the map."""
    message = TFMessage()
    for name in names:
        message.transforms.append(TransformStamped(child_frame_id=name))
        message.transforms[-1].header.frame_id = "map"
    node.create_publisher(TFMessage, "/tf_static", LATCHED).publish(message)


def kind(page: Page, name: str) -> None:
    """Wait until the page shows a kind of system."""
    page.browser.wait(f"robolink.layout.kind == '{name}' && robolink.layout.isReady")


def driving(page: Page, command: str = "/cmd_vel", of: type[Any] = Twist) -> None:
    """Let a robot be there that obeys a topic, and wait for its page."""
    page.node.create_subscription(of, command, lambda _: None, 10)
    frames(page.node, "base_link")
    kind(page, "drive")


def test_the_layout_follows_what_is_there(browser: Browser) -> None:
    with opened(browser) as page:
        page.node.destroy_node()
        kind(page, "empty")
        text = browser.js("document.querySelector('.nothing').innerText")
        assert "robolink launch wander" in text
        assert "domain 0 of network localhost" in text
        page.picture("layout_empty")
        node = Node("other", context=page.system.new_context())
        node.create_publisher(String, "chatter", 10)
        kind(page, "topics")
        assert browser.js(PANELS) == ["topics", "graph / log"]
        assert browser.js("document.querySelector('.nothing')") is None
        node.create_subscription(TwistStamped, "/robot/cmd_vel", lambda _: None, 10)
        frames(node, "base_link")
        kind(page, "drive")
        browser.wait(f"({PANELS})[0] == 'world'")
        assert browser.js(PANELS) == DRIVE
        assert browser.js("document.querySelector('.detail h3').textContent") == "/robot/cmd_vel"
        assert browser.js("robolink.layout.panel('plot').series.map(({ name }) => name)") == [
            "/robot/cmd_vel twist.linear.x",
            "/robot/cmd_vel twist.angular.z",
        ]
        assert 0.6 < browser.js("document.querySelector('.panel-world').clientWidth / innerWidth") < 0.7
        world = "robolink.layout.panel('world')"
        browser.js(f"void (globalThis.before = {world})")
        node.create_publisher(Image, "image", 10)
        kind(page, "camera")
        assert browser.js(PANELS) == ["world / plot", "images / topics|log|teleop"]
        frames(node, "r1/base_link", "r2/base_link")
        kind(page, "robots")
        assert browser.js(PANELS) == ["world", "topics|log|teleop|images"]
        assert browser.js(f"before === {world}"), "a panel that stays is not made anew"


def test_what_one_changes_stays_and_is_remembered_for_that_kind(browser: Browser) -> None:
    with opened(browser) as page:
        driving(page)
        browser.choose("#add", "parameters")
        browser.wait("robolink.layout.panel('parameters')")
        changed = browser.js(PANELS)
        assert changed != DRIVE
        browser.click(".cell:has(.panel-world) button[title='whole page']")
        browser.wait("document.querySelector('.panel-world').clientWidth > 0.9 * innerWidth")
        page.node.create_publisher(Image, "image", 10)
        browser.wait("robolink.layout._next.startsWith('camera')")  # it has seen that
        assert browser.js(PANELS) == changed, "what one has just changed does not go"
        browser.open(page.view.address)
        browser.wait("globalThis.robolink?.layout?.kind == 'camera'")
        assert browser.js(PANELS) == ["world / plot", "images / topics|log|teleop"]
        browser.js("robolink.drivable = () => new Map(); robolink.layout.reset()")
        assert "parameters" in browser.js("localStorage['robolink.layouts']"), "of another kind it stays"
        browser.choose("#add", "services")
        browser.click(".cell:has(.panel-services) button[title='whole page']")
        browser.choose("#add", "reset")
        browser.wait(f"!({PANELS}).join().includes('services')")
        browser.wait("document.querySelector('.cell').clientHeight > 100")


def test_what_a_panel_shows_is_remembered_though_the_layout_follows(browser: Browser) -> None:
    with opened(browser) as page:
        driving(page)
        browser.wait("robolink.layout.panel('plot')")
        browser.click(".panel-plot .chip button[title^='remove']")
        browser.wait("document.querySelectorAll('.chip').length == 1")
        browser.open(page.view.address)
        browser.wait("document.querySelectorAll('.chip').length == 1")
        assert browser.js(PANELS) == DRIVE


def test_a_panel_that_one_added_to_two_kinds_shows_in_each_what_was_chosen_there(browser: Browser) -> None:
    def layout(**options: Any) -> dict[str, Any]:
        return {"changed": True, "columns": [{"cells": [{"tabs": [{"id": "world", "options": options}]}]}]}

    with opened(browser, layouts={"topics": layout(), "drive": layout(off=["/scan"])}) as page:
        kind(page, "topics")
        assert browser.js("robolink.layout.panel('world').scene.shows('/scan')") is True
        driving(page)
        assert browser.js("robolink.layout.panel('world').scene.shows('/scan')") is False
        kept = browser.js("JSON.parse(localStorage['robolink.layouts']).drive.columns[0].cells[0].tabs[0].options.off")
        assert kept == ["/scan"]


def test_a_panel_that_two_kinds_remember_alike_goes_on_as_it_is(browser: Browser) -> None:
    tab = {"id": "world", "options": {"off": ["/scan"]}}
    with opened(browser, layout={"columns": [{"cells": [{"tabs": [tab]}]}]}) as page:
        kind(page, "topics")
        browser.js("void (globalThis.before = robolink.layout.panel('world'))")
        browser.js("before.scene.show('/map', false)")
        driving(page)
        assert browser.js("robolink.layout.panel('world') === before")
        assert browser.js("robolink.layout.panel('world').scene.shows('/map')") is False


def test_an_address_opens_its_panels(browser: Browser) -> None:
    with opened(browser) as page:
        browser.open(f"{page.view.address}#log+images:/camera/image")
        browser.wait("globalThis.robolink?.layout?.kind.startsWith('#') && robolink.layout.isReady")
        assert browser.js(PANELS) == ["log", "images"]
        assert browser.js("robolink.layout.panel('images').topic") == "/camera/image"


def test_tabs_by_keys_and_by_dragging(browser: Browser) -> None:
    with opened(browser) as page:
        driving(page)
        assert browser.js("document.querySelector('.panel-teleop')") is None, "what was never seen is not loaded"
        browser.js("document.querySelector('[data-tab=topics]').focus()")
        browser.press("ArrowRight")
        browser.wait("document.activeElement.dataset.tab == 'log' && robolink.layout.panel('log')")
        assert browser.js("document.querySelector('.panel-topics').getClientRects().length") == 0
        browser.press("ArrowLeft")
        browser.press("ArrowLeft")
        browser.wait("document.activeElement.dataset.tab == 'teleop' && robolink.layout.panel('teleop')")
        page.picture("layout_tabs")
        browser.press("Delete")
        browser.wait("!robolink.layout.has('teleop') && document.activeElement.dataset.tab == 'log'")
        browser.drag_data("[data-tab=log]", ".cell:has(.panel-plot)")
        browser.wait(f"({PANELS})[1] == 'topics / plot|log'")
        browser.wait("document.querySelector('.panel-log').clientHeight > 100")
        browser.click(".cell:has(.panel-log) button[title='remove panel']")
        browser.wait(f"({PANELS})[1] == 'topics / plot' && document.querySelector('.panel-plot').clientHeight > 100")


@pytest.mark.parametrize(("width", "height"), [(1440, 900), (1024, 700)])
def test_six_more_panels_leave_none_a_strip(browser: Browser, width: int, height: int) -> None:
    browser.resize(width, height)
    try:
        with opened(browser) as page:
            driving(page)
            for name in ("parameters", "services", "actions", "images", "graph", "turtlesim"):
                browser.choose("#add", name)
                browser.wait(f"document.querySelector('.panel-{name}')?.clientHeight > 100")
                assert browser.js(f"document.querySelector('.panel-{name}').contains(document.activeElement)")
            assert all(w >= NARROWEST and h >= LOWEST for w, h in browser.js(CELLS)), browser.js(CELLS)
            page.picture(f"layout_six_more_{width}")
            browser.choose("#add", "teleop")  # there already, as a tab
            browser.wait("document.querySelector('.stick')")
            assert browser.js("document.querySelectorAll('[data-tab=teleop]').length") == 1
            inside = "(({ top, bottom }) => top >= 0 && bottom <= innerHeight)"
            assert browser.js(f"{inside}(document.querySelector('.cell:has(.stick)').getBoundingClientRect())")
    finally:
        browser.resize(1280, 720)


def test_a_low_cell_shows_the_message_and_the_list_when_it_is_closed(browser: Browser) -> None:
    tab = {"id": "topics", "options": {"topic": "/cmd_vel", "open": True}}
    columns = [{"width": 50, "cells": [{"height": 70, "tabs": [{"id": "log"}]}, {"height": 30, "tabs": [tab]}]}]
    with opened(browser, layout={"columns": columns}) as page:
        page.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
        list_ = "document.querySelector('table.topics').getClientRects().length"
        browser.wait("document.querySelector('.detail').getClientRects().length")
        assert browser.js(list_) == 0
        page.picture("layout_low_topics")
        browser.click(".detail button")
        browser.wait(list_)


def test_many_columns_scroll(browser: Browser) -> None:
    names = ["plot", "log", "topics", "services", "parameters", "graph", "actions"]
    with opened(browser, *names):
        sizes = browser.js(CELLS)
        assert len(sizes) == len(names)
        assert all(w >= NARROWEST - 2 for w, _ in sizes), sizes  # the border is not counted


def test_a_split_is_moved_by_keys_and_never_makes_a_strip(browser: Browser) -> None:
    with opened(browser, "world", "topics"):
        browser.js("document.querySelector('.splitter').focus()")
        before = browser.js(CELLS)[0][0]
        browser.press("ArrowLeft")
        assert browser.js(CELLS)[0][0] == pytest.approx(before - 40, abs=3)
        for _ in range(20):
            browser.press("ArrowLeft")
        assert browser.js(CELLS)[0][0] >= NARROWEST - 3


def test_keys_open_the_stick_the_goal_and_what_one_finds(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        page.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
        browser.press("d")
        browser.wait("document.activeElement.className == 'stick'")
        browser.press("Escape")
        browser.press("Tab")
        browser.press("g")
        browser.wait("robolink.layout.panel('world')?.tool == 'goal'")
        browser.press("Escape")
        browser.wait("!robolink.layout.panel('world').tool")
        browser.press("1")
        browser.wait("document.activeElement.dataset.panel == 'topics'")
        browser.press("/")
        browser.type("zz")
        browser.wait("document.getElementById('found').innerText == 'nothing has this name'")
        browser.press("Enter")
        browser.press("Escape")
        browser.wait("!document.querySelector('dialog')")
        browser.press("?")
        browser.wait("/\\d+ frames\\/s/.test(document.querySelector('dialog').innerText)")


def test_a_bag_has_its_timeline_first_and_nothing_that_acts(browser: Browser, tmp_path: Path) -> None:
    write(tmp_path / "lap", ten_messages())
    with (
        open_bag(tmp_path / "lap") as bag,
        View(BagSource(bag), Settings(port=0)) as view,
        opened(browser, view=view) as page,
    ):
        kind(page, "bag")
        assert browser.js("document.querySelector('h1').textContent") == "lap"
        tops = "['header', 'footer', 'main'].map((each) => document.querySelector(each).getBoundingClientRect().top)"
        assert browser.js(tops) == sorted(browser.js(tops))
        offered = browser.js("[...document.getElementById('add').options].map(({ value }) => value)")
        assert not {"teleop", "services", "parameters", "actions"} & set(offered)
        for hidden in ("#stop", "#record"):
            assert browser.js(f"document.querySelector('{hidden}')?.getClientRects().length ?? 0") == 0, hidden
        for key in ("d", "g", "i", " "):
            browser.press(key)
        assert browser.js("[robolink.layout.has('teleop'), document.querySelector('.note')]") == [False, None]
        page.picture("layout_bag")


def test_steps_in_a_bag_add_up_before_the_answer_of_the_first_has_come(browser: Browser, tmp_path: Path) -> None:
    write(tmp_path / "lap", ten_messages())
    with (
        open_bag(tmp_path / "lap") as bag,
        View(BagSource(bag), Settings(port=0)) as view,
        opened(browser, view=view) as page,
    ):
        kind(page, "bag")
        browser.js("robolink.connection.playback({ play: false, seek: robolink.timeline.bag.start })")
        browser.wait("(({ playing, time, start }) => !playing && time === start)(robolink.timeline.bag)")
        went = browser.js(
            """(({ timeline, connection }) => {
              const { start } = timeline.bag;
              timeline.step(2);
              timeline.step(2);
              connection.emit("playback", { status: 1, time: start + 2000, speed: 1, didSeek: false, id: "1" });
              connection.emit("time", start + 2000);
              timeline.step(-1);
              return timeline.bag.time - start;
            })(robolink)"""
        )
        assert went == 3000
        browser.wait("robolink.timeline._isAnswered")
        assert browser.js("robolink.timeline.bag.time - robolink.timeline.bag.start") == 3000
