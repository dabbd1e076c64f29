"""The graph panel: nodes and topics in layers, what is hidden, the ends of one, and looking closer."""

from __future__ import annotations

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.node import Node
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import opened

pytestmark = [pytest.mark.processes, needs_chromium]

LEFT = "(key) => document.querySelector(`[data-key='${key}']`)?.getBoundingClientRect().left"


def test_nodes_and_topics_stand_in_the_order_of_what_flows(browser: Browser) -> None:
    with opened(browser, "graph") as page:
        driver = Node("driver", context=page.system.context)
        page.node.create_publisher(LaserScan, "scan", 10)
        driver.create_subscription(LaserScan, "scan", print, 10)
        driver.create_publisher(Twist, "cmd_vel", 10)
        page.node.create_subscription(Twist, "other", print, 10)
        order = "['node/robot', 'topic/scan', 'node/driver', 'topic/cmd_vel']"
        browser.wait(f"{order}.map({LEFT}).every((x, i, all) => x !== undefined && (!i || x > all[i - 1]))")
        assert browser.js("document.querySelector(\"[data-key='topic/rosout']\")") is None
        browser.click("[data-key='topic/scan'] rect")
        ends = "document.querySelector('.ends').textContent"
        browser.wait(f"{ends}.includes('sensor_msgs/msg/LaserScan')")
        told = browser.js(ends)
        assert "publishers (1): /robot" in told
        assert "subscribers (1): /driver" in told
        page.picture("graph")
        browser.js("document.querySelector(\"[data-key='node/driver']\").focus()")
        browser.press("Enter")
        browser.wait(f"{ends}.includes('publishes') && {ends}.includes('/cmd_vel')")
        width = "document.querySelector('svg.graph').viewBox.baseVal.width"
        before = browser.js(width)
        browser.wheel("svg.graph", -100)
        browser.wait(f"{width} < {before}")
        browser.click(".panel-graph label input")
        browser.wait("document.querySelector(\"[data-key='topic/rosout']\")")
        browser.click(".panel-graph input[type=search]")
        browser.type("cmd")
        browser.wait("document.querySelectorAll('svg.graph g').length == 2")
        driver.destroy_node()
        browser.wait("document.querySelectorAll('svg.graph g').length == 0")
