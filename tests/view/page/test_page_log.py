"""The log panel: levels, filters, pause and the count."""

from __future__ import annotations

import pytest

from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened

pytestmark = [pytest.mark.processes, needs_chromium]


def lines(page: Page) -> list[str]:
    found: list[str] = page.browser.js("[...document.querySelectorAll('.log li span')].map((each) => each.textContent)")
    return found


def wait_for_lines(page: Page, *wanted: str) -> None:
    page.browser.wait(f"document.querySelectorAll('.log li').length == {len(wanted)}")
    assert lines(page) == list(wanted)


def test_the_log_is_filtered_by_level_node_and_text(browser: Browser) -> None:
    with opened(browser, "log") as page:
        logger = page.node.get_logger()
        logger.info("ready <b>now</b>")
        logger.warning("battery low")
        logger.error("motor lost")
        logger.get_child("arm").info("arm is up")
        wait_for_lines(page, "ready <b>now</b>", "battery low", "motor lost", "arm is up")
        assert browser.js("document.querySelector('.log .level-error b').textContent") == "ERROR"
        page.picture("log")
        browser.choose(".panel-log select.level", "30")
        wait_for_lines(page, "battery low", "motor lost")
        assert browser.js("document.querySelector('.count').textContent") == "2 of 4"
        browser.choose(".panel-log select.level", "10")
        browser.click(".panel-log input.node")
        browser.type("arm")
        wait_for_lines(page, "arm is up")
        browser.js("document.querySelector('input.node').value = ''")
        browser.click(".panel-log input.text")
        browser.type("LOW")
        browser.click(".panel-log input.node")
        browser.type("robot")
        wait_for_lines(page, "battery low")


def test_a_paused_log_stands_still_and_counts_what_waits(browser: Browser) -> None:
    with opened(browser, "log") as page:
        page.node.get_logger().info("one")
        wait_for_lines(page, "one")
        browser.click(".panel-log button.pause")
        page.node.get_logger().info("two")
        browser.wait("document.querySelector('.count').textContent == '1 more while paused'")
        assert lines(page) == ["one"]
        browser.click(".panel-log button.pause")
        wait_for_lines(page, "one", "two")
        browser.click(".panel-log button[title=clear]")
        wait_for_lines(page)


def test_a_flood_keeps_the_newest_lines(browser: Browser) -> None:
    with opened(browser, "log") as page:
        page.node.get_logger().info("begin")
        wait_for_lines(page, "begin")
        flood = (
            "(() => { const log = robolink.layout.panel('log'); for (let i = 0; i < 20000; i++)"
            " log.fresh.push({level: 20, node: 'a', text: `${i}`, place: '', stamp: Date.now()});"
            " log.frame(); return log.entries.length; })()"
        )
        assert browser.js(flood) == 5000
        assert browser.js("document.querySelectorAll('.log li').length") == 1000
        assert lines(page)[-1] == "19999"


def test_what_was_logged_before_the_page_opened_stands_in_the_order_of_time(browser: Browser) -> None:
    with opened(browser, "log") as page:
        browser.wait("!!robolink.layout.panel('log')")
        take = (
            "(() => { const log = robolink.layout.panel('log'), take = (text, sec) =>"
            " log._take({level: 20, name: 'a', msg: text, stamp: {sec, nanosec: 0}, file: ''}, 0);"
            " for (const [text, sec] of %s) take(text, sec); log.frame(); })()"
        )
        browser.js(take % "[['one', 10], ['four', 40], ['two', 20]]")
        wait_for_lines(page, "one", "two", "four")
        browser.js(take % "[['three', 30]]")  # of another node, whose messages come later
        wait_for_lines(page, "one", "two", "three", "four")


def test_a_narrow_log_breaks_no_words(browser: Browser) -> None:
    with opened(browser, "log") as page:
        try:
            browser.resize(300, 600)
            page.node.get_logger().get_child("a_node_with_a_long_name").info("driving ahead, nearest wall 0.82 m")
            browser.wait("document.querySelector('.log li')")
            assert browser.js(
                "document.querySelector('.log').scrollWidth <= document.querySelector('.log').clientWidth"
            )
            assert browser.js("document.querySelector('.log li').clientHeight") < 90
            page.picture("log_narrow")
        finally:
            browser.resize(1280, 720)
