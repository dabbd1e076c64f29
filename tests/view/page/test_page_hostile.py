"""Hostile and broken data: the page shows what it can, goes on, and takes nothing of the network for HTML."""

from __future__ import annotations

import math
from typing import Any

import pytest

from robolink.interfaces.geometry_msgs.msg import Point, PoseWithCovarianceStamped, TransformStamped
from robolink.interfaces.nav_msgs.msg import OccupancyGrid, Odometry
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan, PointCloud2, PointField, Range
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened

WORLD = "robolink.layout.panel('world')"
HTML = "<img src=x onerror='globalThis.hacked = true'><b id=hacked>bold</b>"

pytestmark = [pytest.mark.processes, needs_chromium]


def marker(kind: int, **more: Any) -> Marker:
    made = Marker(type=kind, id=kind, ns=HTML, text=HTML)
    made.header.frame_id = "map"
    made.scale.x, made.color.r, made.color.a = -1.0, math.nan, math.inf
    made.points = [Point(x=math.nan), Point(x=1e300), Point(y=-math.inf)]
    for name, value in more.items():
        setattr(made, name, value)
    return made


def strange() -> dict[str, Any]:
    """Messages by topic that no panel expects."""
    huge = OccupancyGrid()
    huge.info.width = huge.info.height = 2**32 - 1
    short = OccupancyGrid(data=[0, 100])
    short.info.width, short.info.height, short.info.resolution = 50, 40, math.nan
    far, nowhere = Odometry(child_frame_id="far"), Odometry(child_frame_id="nowhere")
    far.pose.pose.position.x, nowhere.pose.pose.position.y = 1e20, math.nan
    back = Range(range=-1.0, field_of_view=0.5, max_range=4.0)
    scan = LaserScan(angle_increment=math.nan, range_max=math.inf, ranges=[math.nan, math.inf, -1.0, 1e30])
    cloud = PointCloud2(width=1000, height=1000, point_step=4, data=b"12345678")
    cloud.fields = [PointField(name=name, offset=2**31, datatype=99) for name in "xyz"]
    pose = PoseWithCovarianceStamped()
    pose.pose.covariance[:] = [math.nan] * 36
    found = {"huge_map": huge, "short_map": short, "far": far, "nowhere": nowhere, "range": back, "scan": scan}
    found |= {
        "cloud": cloud,
        "pose": pose,
        "markers": MarkerArray(markers=[marker(kind) for kind in (*range(-1, 13), 77)]),
    }
    return found


def loop() -> TFMessage:
    made = TFMessage(transforms=[TransformStamped(child_frame_id=name) for name in ("a", "b", HTML)])
    for each, parent in zip(made.transforms, ("b", "a", "far"), strict=True):
        each.header.frame_id = parent
    return made


def test_messages_that_no_panel_expects_leave_the_page_going(browser: Browser) -> None:
    with opened(browser, "world", "topics") as page:
        browser.wait("robolink.topics.get('/parameter_events')")
        for name, message in strange().items():
            page.wait_for_reader(page.node.create_publisher(type(message), name, 10))
        publishers = {each.topic_name: each for each in page.node.publishers}
        for name, message in strange().items():
            publishers[f"/{name}"].publish(message)
            browser.wait(f"robolink.topics.get('/{name}').latest")
        goes_on(page)
        browser.wait(f"Number.isFinite({WORLD}.view.x) && Number.isFinite({WORLD}.view.scale)")
        page.picture("hostile_world")
        browser.click(".toolbar .fit")
        goes_on(page)
        browser.wait(f"Math.hypot({WORLD}.view.x, {WORLD}.view.y) < 100")  # what is nowhere is not looked for
        browser.click("#theme")
        browser.click("#theme")
        goes_on(page)


def test_a_robot_that_is_nowhere_does_not_hang_the_page(browser: Browser) -> None:
    with opened(browser, "world") as page:
        browser.click(".layers-button")
        for place in (1e20, math.inf, math.nan):
            odometry = page.node.create_publisher(Odometry, "odom", 10)
            page.wait_for_reader(odometry)
            message = Odometry(child_frame_id="base_link")
            message.pose.pose.position.x = place
            odometry.publish(message)
            browser.wait("robolink.topics.get('/odom').latest")
            browser.choose(".follow", "odom")
            browser.click(".toolbar .fit")
            goes_on(page)
            odometry.destroy()
            browser.wait("!robolink.topics.get('/odom').subscription")


def test_a_topic_of_another_type_than_its_name_tells_leaves_the_page_going(browser: Browser) -> None:
    with opened(browser, "world", "log") as page:
        for name in ("/tf", "/tf_static", "/clock", "/parameter_events2"):
            wrong = page.node.create_publisher(String, name, 10)
            browser.wait(f"robolink.topics.get('{name}')?.type")
            for _ in range(4):
                wrong.publish(String(data=HTML))
        goes_on(page)
        assert not browser.js("globalThis.hacked || document.querySelector('#hacked, .body img')")


def goes_on(page: Page) -> None:
    """Wait until ten messages, each sent when the one before was seen, have come: more than batches may wait."""
    beat = next((each for each in page.node.publishers if each.topic_name == "/beat"), None)
    beat = beat or page.node.create_publisher(Int32, "beat", 10)
    page.browser.js("globalThis.beats ??= robolink.listen('/beat')")
    page.wait_for_reader(beat)
    start = page.browser.js("robolink.topics.get('/beat').latest?.data ?? 0")
    for number in range(start + 1, start + 11):
        beat.publish(Int32(data=number))
        page.browser.wait(f"robolink.topics.get('/beat').latest?.data === {number}", 10)


def test_names_and_texts_of_the_network_are_never_html(browser: Browser) -> None:
    panels = ("world", "topics", "log", "images", "parameters", "services", "graph")
    with opened(browser, *panels) as page:
        node = page.node
        node.declare_parameter("text", HTML)
        node.declare_parameter(HTML, "named so")
        node.get_logger().error(HTML)
        text, tf = node.create_publisher(String, "text", 10), node.create_publisher(TFMessage, "tf", 10)
        image = node.create_publisher(Image, "image", 10)
        browser.click('tr[data-topic="/text"] button')
        for publisher in (text, tf, image):
            page.wait_for_reader(publisher)
        text.publish(String(data=HTML))
        tf.publish(loop())
        image.publish(Image(width=1, height=1, step=9, encoding=HTML, data=b"123"))
        with page.system.spinning():
            browser.wait("document.querySelector('.tree')?.textContent.includes('onerror')")
            browser.wait("document.querySelector('.log')?.textContent.includes('onerror')")
            browser.wait("document.querySelector('.panel-images .error')?.textContent.includes('onerror')")
            browser.wait("document.querySelector('.panel-parameters')?.textContent.includes('onerror')")
            browser.wait(f"{WORLD}.fixedMenu.textContent.includes('onerror')")
            assert not browser.js("globalThis.hacked || document.querySelector('#hacked, .body img') !== null")
            page.picture("hostile_names")
