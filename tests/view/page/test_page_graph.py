"""The graph panel: nodes and topics in layers, what is hidden, the ends of one, and looking closer."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.node import Node
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages, write
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened

pytestmark = [pytest.mark.processes, needs_chromium]

Links = list[str]
"""Links of a graph, `node > /topic` or `/topic > node`."""

WORLD = [f"world > /{topic}" for topic in ("ground_truth", "odom", "scan", "world/floor", "world/walls")]
GRAPHS: dict[str, Links] = {
    "wander": [*WORLD, "/scan > driver", "driver > /cmd_vel", "/cmd_vel > world"],
    "lab": [
        *(f"world > /{robot}/{topic}" for robot in ("ada", "bob") for topic in ("scan", "imu", "odom", "bumper")),
        *(f"/{robot}/scan > {robot}_driver" for robot in ("ada", "bob")),
        *(f"{robot}_driver > /{robot}/cmd_vel" for robot in ("ada", "bob")),
        *(f"/{robot}/cmd_vel > world" for robot in ("ada", "bob")),
        "/ada/joint_command > world",
    ],
    "talker": ["talker > /chatter", "/chatter > listener"],
    "many": [*(f"hub > /topic_{i}" for i in range(40)), *(f"/other_{i} > hub" for i in range(40))],
    "cycles": ["a > /x", "/x > a", "/x > b", "b > /y", "/y > a", "/y > c", "c > /x", "c > /z", "/z > c", "/w > a"],
    "ranks": ["a > /1", "/1 > b", "b > /2", "/2 > c", "c > /3", "/3 > d", "/1 > d", "a > /3", "/1 > c", "/2 > d"],
    "long": ["a > /" + "very_long_name/" * 9 + "x", "/" + "very_long_name/" * 9 + "x > b", "a > /y", "/y > c"],
    "islands": ["a > /x", "/y > b", "c > /z", "/z > d"],
    "nothing": [],
}

CROSSED = r"""(() => {
  const all = (selector) => [...document.querySelectorAll(`svg.graph ${selector}`)], wrong = [];
  const boxes = all("g").map((each) => {
    const { e: left, f: top } = each.transform.baseVal.consolidate().matrix;
    const { width, height } = each.querySelector("rect");
    return { key: each.dataset.key, left, top, right: left + width.baseVal.value, bottom: top + height.baseVal.value };
  });
  const isIn = (x, y, { left, right, top, bottom }) => x > left + 0.01 && x < right - 0.01 && y > top && y < bottom;
  for (const edge of all(".edge")) {
    const { from, to } = edge.dataset, length = edge.getTotalLength(), end = edge.getPointAtLength(length);
    const [, name] = /^url\(#(.*)\)$/.exec(edge.getAttribute("marker-end")) ?? [];
    if (document.getElementById(name)?.tagName !== "marker") wrong.push(`${from} > ${to} has no arrowhead`);
    for (let at = 0; at <= length; at += 2) {
      const { x, y } = edge.getPointAtLength(at), box = boxes.find((each) => isIn(x, y, each));
      if (box) wrong.push(`${from} > ${to} crosses ${box.key} at ${x}, ${y}`);
    }
    const { left, top, bottom } = boxes.find(({ key }) => key === to);
    if (Math.hypot(end.x - left, end.y - (top + bottom) / 2) > 0.1) wrong.push(`${from} > ${to} ends elsewhere`);
  }
  boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => {
    const isOn = a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    if (isOn) wrong.push(`${a.key} on ${b.key}`);
  }));
  return wrong.slice(0, 5);
})()"""
"""What is wrong with the drawn graph: edges in boxes, without arrowheads or with ends elsewhere, boxes on boxes."""

DRAW = """(links) => {
  const { graph } = robolink.connection;
  for (const side of ["published", "subscribed"]) graph[side].clear();
  graph.nodes = [];
  for (const link of links) {
    const [a, b] = link.split(" > "), out = b.startsWith("/"), side = graph[out ? "published" : "subscribed"];
    const [node, topic] = out ? [`/${a}`, b] : [`/${b}`, a];
    if (!graph.nodes.includes(node)) graph.nodes.push(node);
    side.set(topic, [...(side.get(topic) ?? []), node]);
  }
  robolink.layout.panel("graph")._set({});
}"""

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
        assert "publishers (1)/robotreliable volatile depth 10" in told
        assert "subscribers (1)/driverreliable volatile depth 10" in told
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


def draw(page: Page, links: Links) -> None:
    """Have the panel draw a graph."""
    page.browser.js(f"({DRAW})({json.dumps(links)})")
    page.browser.wait("!robolink.layout.panel('graph').stale")
    assert page.browser.js("document.querySelectorAll('svg.graph .edge').length") == len(links)


def random_graph(seed: int) -> Links:
    """Links of a graph, most of which close circles or pass over layers."""
    chance = random.Random(seed)
    nodes, topics = [f"n{i}" for i in range(chance.randint(1, 9))], [f"/t{i}" for i in range(chance.randint(1, 12))]
    pairs = [(node, topic) for node in nodes for topic in topics]
    found = {f"{a} > {b}" if chance.random() < 0.5 else f"{b} > {a}" for a, b in chance.sample(pairs, len(pairs) // 3)}
    return sorted(found)


def test_no_edge_runs_behind_a_box_and_each_has_an_arrowhead(browser: Browser) -> None:
    with opened(browser, "graph") as page:
        for name, links in GRAPHS.items():
            draw(page, links)
            assert browser.js(CROSSED) == [], name
            page.picture(f"graph_{name}")
        for seed in range(12):
            draw(page, random_graph(seed))
            assert browser.js(CROSSED) == [], seed


def test_commands_close_the_circles(browser: Browser) -> None:
    with opened(browser, "graph") as page:
        draw(page, GRAPHS["lab"])
        keys = [f"node{each}" for each in ("/world", "/ada_driver", "/bob_driver")]
        left = browser.js(f"{json.dumps(keys)}.map({LEFT})")
        assert left[0] < left[1] == pytest.approx(left[2], abs=1)


def test_a_name_is_whole_where_there_is_room_and_a_finger_pair_zooms(browser: Browser) -> None:
    with opened(browser, "graph") as page:
        draw(page, ["a_node_with_a_rather_long_name > /and/a_topic/of_a/robot"])
        texts = "[...document.querySelectorAll('svg.graph text')].map((each) => each.textContent)"
        assert browser.js(texts) == ["/a_node_with_a_rather_long_name", "/and/a_topic/of_a/robot"]
        draw(page, GRAPHS["long"])
        titles = browser.js("[...document.querySelectorAll('svg.graph title')].map((each) => each.textContent)")
        assert "/" + "very_long_name/" * 9 + "x" in titles
        shortened = [text for text in browser.js(texts) if "…" in text]
        assert len(shortened) == 1
        width = "document.querySelector('svg.graph').viewBox.baseVal.width"
        before = browser.js(width)
        x, y = browser.place("svg.graph")
        browser.touch((x - 50, y), (x + 50, y))
        browser.touch((x - 100, y), (x + 100, y))
        browser.touch()
        assert browser.js(width) == pytest.approx(before / 2)


def test_a_hundred_robots_are_drawn_at_once(browser: Browser) -> None:
    links = [
        link
        for i in range(100)
        for link in (f"world > /r{i}/odom", f"world > /r{i}/scan", f"/r{i}/scan > d{i}", f"d{i} > /r{i}/cmd_vel")
    ] + [f"/r{i}/cmd_vel > world" for i in range(100)]
    with opened(browser, "graph") as page:
        draw(page, links)
        spent = browser.js(
            "(() => { const panel = robolink.layout.panel('graph'), begin = performance.now();"
            " panel._draw(panel._items()); return performance.now() - begin; })()"
        )
        assert spent < 1500  # a tenth of that on a quiet machine


def test_a_graph_that_is_empty_says_why(browser: Browser, tmp_path: Path) -> None:
    hint = "document.querySelector('.panel-graph .empty')"
    with opened(browser, "graph") as page:
        browser.click(".panel-graph input[type=search]")
        browser.type("zebra")
        browser.wait(f"{hint}.textContent.includes(\"'zebra'\") && !{hint}.hidden")
    write(tmp_path / "bag", ten_messages())
    with (
        open_bag(tmp_path / "bag") as bag,
        View(BagSource(bag), Settings(port=0)) as view,
        opened(browser, "graph", view=view) as page,
    ):
        browser.wait(f"{hint}.textContent.startsWith('A bag tells what was sent')")
        page.picture("graph_bag")
