"""The record button: a bag of what is heard while it runs, and why it is off where it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.std_msgs.msg import Int32
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import opened
from tests.support.view_clients import until

pytestmark = [pytest.mark.processes, needs_chromium]


def test_a_bag_is_recorded_by_a_click_and_ended_by_another(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with opened(browser, "topics") as page:
        publisher = page.node.create_publisher(Int32, "count", 10)
        browser.click("#record")
        browser.wait("document.getElementById('record').ariaPressed == 'true'")
        until(lambda: publisher.get_subscription_count() > 0)
        for number in range(20):
            publisher.publish(Int32(data=number))
        browser.wait("/[1-9]\\d* s/.test(document.getElementById('record').textContent)")
        page.picture("record")
        browser.click("#record")
        browser.wait("document.querySelector('.note')?.textContent.includes('rosbag2_')")
        browser.wait("document.getElementById('record').textContent == '● Rec'")
        page.picture("recorded")
    (folder,) = tmp_path.iterdir()
    bag = open_bag(folder)
    assert bag.counts["/count"] == 20
    bag.close()


def test_without_the_token_nothing_is_recorded(browser: Browser) -> None:
    with opened(browser, "topics", token=False):
        browser.wait("document.getElementById('record').disabled")
        assert "without the token" in browser.js("document.getElementById('record').title")
