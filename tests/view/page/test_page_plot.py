"""The plot panel: fields that are picked and dragged, two axes, pause, zoom, and what is saved."""

from __future__ import annotations

import itertools
import json
import math
from typing import Any

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened

pytestmark = [pytest.mark.processes, needs_chromium]

SAVED = """globalThis.saved = []; URL.createObjectURL = (blob) => {
  blob.text().then((text) => saved.push([blob.type, blob.size, text]));
  return "#";
}; 0"""
"""A stand-in for the disk: what the page offers as files."""
FILL = """globalThis.fill = (plot) => {
  const now = Date.now();
  for (const each of plot.series) {
    const [part, axis] = each.parts;
    each.clear();
    for (let i = 30000; i--;) each.take(now - i, {[part]: {[axis]: Math.sin(i / 99)}});
  }
  plot._draw();
  const start = performance.now();
  for (let i = 0; i < 5; i++) plot._draw();
  plot.context.getImageData(0, 0, 1, 1);
  return (performance.now() - start) / 5;
}; 0"""
"""Fill a plot with 30 s of 1,000 points a second in each series, and measure a frame of it in milliseconds."""
FIELDS = ["linear.x", "angular.z"]


def wave(page: Page, until: str) -> None:
    """Publish a wave until JavaScript is true."""
    publisher = page.node.create_publisher(Twist, "cmd_vel", 10)
    for i in itertools.count():
        twist = Twist()
        twist.linear.x, twist.angular.z = math.sin(i / 10), 10 * math.cos(i / 10)
        publisher.publish(twist)
        if page.browser.js(until):
            return
        assert i < 4000, until


def points(page: Page) -> int:
    found: int = page.browser.js("robolink.layout.panel('plot').series[0]?.count ?? 0")
    return found


def saved(page: Page, name: str) -> Any:
    page.browser.js(SAVED)
    before = page.browser.js("saved.length")
    page.browser.click(f".panel-plot .row button[title='save as {name}']")
    page.browser.wait(f"saved.length > {before}")
    return page.browser.js("saved.at(-1)")


def test_fields_are_picked_from_the_tree_and_drawn(browser: Browser) -> None:
    with opened(browser, "topics", "plot") as page:
        wave(page, "!!document.querySelector('tr[data-topic=\"/cmd_vel\"]')")
        assert browser.js("document.querySelector('.panel-plot .empty').textContent").startswith("drag a number")
        browser.click("tr[data-topic='/cmd_vel'] button")
        wave(page, f"!!{page.topic('/cmd_vel')}.latest")
        plotted_paths(page)
        wave(page, "robolink.layout.panel('plot')?.series[0]?.count > 150")
        browser.wait("document.querySelector('.chip output').textContent > ''")
        drawn = (
            "(() => { const c = document.querySelector('canvas.plot');"
            " const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; const found = new Set();"
            " for (let i = 0; i < d.length; i += 4) if (d[i + 3] == 255) found.add(`${d[i]},${d[i + 1]},${d[i + 2]}`);"
            " const bytes = (name) => robolink.colour(name).match(/[\\da-f]{2}/g).map((each) => parseInt(each, 16));"
            " return ['c1', 'c2'].every((name) => found.has(bytes(name).join())); })()"
        )
        browser.wait(drawn)
        units = "[...document.querySelectorAll('.chip output')].map((each) => each.textContent.split(' ')[1]).join()"
        browser.wait(f"{units} == 'm/s,rad/s'")
        page.picture("plot")


def plotted_paths(page: Page) -> None:
    for path in FIELDS:
        page.browser.click(f"[data-path={path.split('.')[0]}]")
        page.browser.click(f"[data-path='{path}']")
    page.browser.wait("document.querySelectorAll('.chip').length == 2")


def series(*paths: str) -> dict[str, Any]:
    """A layout with a plot of fields of /cmd_vel."""
    options = {"series": [{"topic": "/cmd_vel", "path": path} for path in paths]}
    return {"columns": [{"width": 50, "cells": [{"tabs": [{"id": "plot", "options": options}]}]}]}


def test_a_field_is_dragged_from_the_tree(browser: Browser) -> None:
    with opened(browser, "topics", "plot") as page:
        wave(page, "!!document.querySelector('tr[data-topic=\"/cmd_vel\"]')")
        browser.click("tr[data-topic='/cmd_vel'] button")
        wave(page, f"!!{page.topic('/cmd_vel')}.latest")
        browser.click("[data-path=linear]")
        browser.drag_data("[data-path='linear.x']", "canvas.plot")
        browser.wait("document.querySelector('.chip')?.dataset.series == '/cmd_vel linear.x'")
        browser.click(".chip button[title^=remove]")
        browser.wait("!document.querySelector('.chip')")


def test_a_click_on_a_number_opens_a_plot_where_there_is_none(browser: Browser) -> None:
    with opened(browser, "topics") as page:
        wave(page, "!!document.querySelector('tr[data-topic=\"/cmd_vel\"]')")
        browser.click("tr[data-topic='/cmd_vel'] button")
        wave(page, f"!!{page.topic('/cmd_vel')}.latest")
        browser.click("[data-path=linear]")
        browser.click("[data-path='linear.x']")
        browser.wait("document.querySelector('.panel-plot .chip')?.dataset.series == '/cmd_vel linear.x'")


def test_two_axes_pause_zoom_and_files(browser: Browser) -> None:
    with opened(browser, layout=series(*FIELDS)) as page:
        wave(page, "robolink.layout.panel('plot')?.series[0]?.count > 100")
        browser.click(".chip:nth-child(2) button[title^=left]")
        assert browser.js("robolink.layout.panel('plot').series.map(({ axis }) => axis)") == [0, 1]
        browser.click(".panel-plot button.pause")
        assert browser.js("document.querySelector('.panel-plot button.pause').ariaPressed") == "true"
        shown = "(({ start, end }) => end - start)(robolink.layout.panel('plot')._range())"
        before = browser.js(shown)
        assert 4_999 < before < 30_000, "no more than there is to see"
        x, y = browser.place("canvas.plot")
        edge = 2 * x - 60
        browser.drag((edge - 60, y), (edge + 20, y))
        zoomed = browser.js(shown)
        assert 0.02 < zoomed / before < 0.3
        browser.wheel((edge, y), -100)
        browser.wait(f"{shown} < {zoomed}")
        page.picture("plot_paused")
        browser.js("document.querySelector('canvas.plot').focus()")
        browser.press("Escape")
        assert browser.js("document.querySelector('.panel-plot button.pause').ariaPressed") == "false"
        kind, _, text = saved(page, "CSV")
        head, *rows = text.splitlines()
        assert (kind, head) == ("text/csv", 'time,"/cmd_vel linear.x","/cmd_vel angular.z"')
        assert len(rows) == points(page)
        values = [float(each) for each in rows[0].split(",")]
        first = browser.js("robolink.layout.panel('plot').series.map(({ values }) => values[0])")
        assert values[1:] == first
        browser.js(FILL)
        browser.js("fill(robolink.layout.panel('plot'))")
        assert browser.js(shown) == pytest.approx(30_000)
        kind, size, _ = saved(page, "PNG")
        assert kind == "image/png"
        assert size > 2_000


def test_a_plot_is_cheap_and_remembered(browser: Browser) -> None:
    many = series(*(f"{part}.{axis}" for part in ("linear", "angular") for axis in "xyz"))
    with opened(browser, layout=many) as page:
        wave(page, "robolink.layout.panel('plot')?.series[5]?.count > 20")
        browser.js(FILL)
        least = min(browser.js("fill(robolink.layout.panel('plot'))") for _ in range(10))  # others use the machine, too
        assert least < 100, "180,000 points in a frame"
        browser.open(page.view.address)
        browser.wait("document.querySelectorAll('.chip').length == 6")
        kept = json.loads(browser.js("localStorage.getItem('robolink.layouts')"))
        assert len(kept[browser.js("robolink.layout.kind")]["columns"]) == 1
