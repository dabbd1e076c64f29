"""Who uses the page by keyboard, screen reader or in Portuguese: names of controls, visible focus, dialogs, words."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.browser import Browser, needs_chromium
from tests.support.pages import opened
from tests.view.page.test_page_contrast import PANELS
from tests.view.page.test_page_errands import robot_scene

pytestmark = [pytest.mark.processes, needs_chromium]

CONTROLS = {"button", "textbox", "searchbox", "combobox", "checkbox", "slider", "spinbutton", "tab", "separator"}
CONTROLS |= {"application", "dialog", "menuitem", "option", "listbox", "link", "treeitem", "canvas"}

TEXTS = """(() => {
  const DATA = "script, noscript, table tbody, .tree, .log, .legend, select.picker, select.fixed, svg.graph, .form"
    + ", .parameters > label > span, .panel-images .state";
  const found = new Set(), walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    if (!node.parentElement.closest(DATA)) found.add(node.data.trim());
  }
  for (const each of document.querySelectorAll("[title], [aria-label], [placeholder]")) {
    if (each.closest("table tbody, .parameters, .form")) continue;
    for (const name of ["title", "aria-label", "placeholder"]) found.add((each.getAttribute(name) ?? "").trim());
  }
  return [...found].filter((each) => /[a-z]{3}/i.test(each));
})()"""
"""JavaScript: all texts, tooltips, labels and placeholders of the page that are not data of the system."""

SAME = {
    "Actions",
    "Log",
    "Services",
    "Topics",
    "Turtlesim",
    "action",
    "node",
    "pose",
    "pub",
    "service",
    "topic",
    "robot",
}
SAME |= {"CSV", "PNG", "rad/s", "menu", "esc", "⇥ ←→ del", "8 topics"}
SAME |= {f"{level} +" for level in ("DEBUG", "INFO", "WARN", "ERROR", "FATAL")}
"""Texts that are the same in both languages, as are names with a slash: words of ROS, units and keys."""


@pytest.fixture
def languages(browser: Browser, tmp_path: Path) -> dict[str, set[str]]:
    """The texts of a page with all panels, the shortcuts and Find, in each language."""
    found = {}
    with robot_scene(tmp_path) as scene:
        for language in ("en", "pt"):
            with opened(browser, *PANELS, view=scene.view, settings={"language": language}):
                browser.wait("document.querySelector('[data-parameter]') && document.querySelector('.call')")
                browser.press("?")
                browser.wait("document.querySelector('dialog.help')")
                texts = set(browser.js(TEXTS))
                browser.press("Escape")
                browser.press("/")
                browser.wait("document.querySelector('dialog.find')")
                texts |= set(browser.js(TEXTS))
                browser.press("Escape")
                browser.wait("!document.querySelector('dialog')")
                browser.press(" ")
                browser.wait("robolink.stopping.held && !document.getElementById('stopped').hidden")
                found[language] = texts | set(browser.js(TEXTS))
                browser.js("robolink.connection.send({ op: 'stop', held: false })")
                browser.wait("!robolink.stopping.held")
    return found


def test_portuguese_has_no_english_left(languages: dict[str, set[str]]) -> None:
    both = {
        each for each in languages["en"] & languages["pt"] if each not in SAME and "/" not in each.replace("rad/s", "")
    }
    assert not both, "\n".join(sorted(both))


def test_every_control_has_a_name(browser: Browser, tmp_path: Path) -> None:
    with robot_scene(tmp_path) as scene, opened(browser, *PANELS, view=scene.view):
        browser.wait("document.querySelector('[data-parameter]') && document.querySelector('.call')")
        browser.click("tr[data-topic='/odom'] button")
        browser.wait("document.querySelector('[data-path=pose]')")
        browser.click(".layers-button")
        nodes = browser.call("Accessibility.getFullAXTree")["nodes"]
        shown = [each for each in nodes if not each["ignored"] and each.get("role", {}).get("value") in CONTROLS]
        assert len(shown) > 60
        nameless = [each["role"]["value"] for each in shown if not each.get("name", {}).get("value", "").strip()]
        assert not nameless


def test_the_focus_is_seen_wherever_it_goes(browser: Browser, tmp_path: Path) -> None:
    with robot_scene(tmp_path) as scene, opened(browser, "topics", "plot", "parameters", "log", view=scene.view):
        browser.wait("document.querySelector('[data-parameter]') && document.querySelector('tr[data-topic] button')")
        seen = []
        for _ in range(60):
            browser.press("Tab")
            found = browser.js(
                "((e) => e === document.body ? null : [e.outerHTML.slice(0, 80), getComputedStyle(e).outlineStyle,"
                " e.getClientRects().length])(document.activeElement)"
            )
            if found is None:
                break
            seen.append(found)
        assert len(seen) > 25
        assert not [each for each in seen if each[1] == "none" or not each[2]]


@pytest.mark.parametrize("key", ["?", "/"])
def test_a_dialog_keeps_the_keyboard_and_esc_closes_it(browser: Browser, key: str) -> None:
    with opened(browser, "topics"):
        browser.js("document.getElementById('theme').focus()")
        browser.press(key)
        browser.wait("document.querySelector('dialog[open]')")
        for _ in range(12):
            browser.press("Tab")
            assert browser.js("document.activeElement === document.body || !!document.activeElement.closest('dialog')")
        browser.press("Escape")
        browser.wait("!document.querySelector('dialog')")
        assert browser.js("document.activeElement.id") == "theme", "the keyboard is where it was"


@pytest.mark.parametrize("key", ["?", "/"])
def test_stop_is_in_reach_behind_a_dialog(browser: Browser, key: str) -> None:
    with opened(browser, "topics"):
        browser.press(key)
        browser.wait("document.querySelector('dialog[open]')")
        browser.click("#stop")
        browser.wait("robolink.stopping.held && !document.querySelector('dialog')")
