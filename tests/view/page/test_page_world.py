"""The world panel, used as a person does: look, move, zoom, follow, switch layers, hover, set a goal."""

from __future__ import annotations

import math
import pathlib
from array import array
from typing import Any

import pytest

from robolink.bag.reader import open_bag
from robolink.bag.topic import BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    Point32,
    PolygonStamped,
    Pose,
    PoseArray,
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3,
)
from robolink.interfaces.nav_msgs.msg import OccupancyGrid, Odometry, Path
from robolink.interfaces.sensor_msgs.msg import LaserScan, PointCloud2, PointField
from robolink.interfaces.std_msgs.msg import ColorRGBA
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.message import encode
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import START
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened, spun
from tests.support.spins import spin_until

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
WORLD = "robolink.layout.panel('world')"

pytestmark = [pytest.mark.processes, needs_chromium]


def transform(parent: str, child: str, x: float, y: float, yaw: float = 0.0) -> TransformStamped:
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id = parent
    made.transform.translation.x, made.transform.translation.y = x, y
    made.transform.rotation.z, made.transform.rotation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return made


def grid(name: str = "map") -> OccupancyGrid:
    """Four by three metres of free floor in a wall, its corner at (-1, -1)."""
    made = OccupancyGrid()
    made.header.frame_id = name
    made.info.resolution, made.info.width, made.info.height = 0.1, 40, 30
    made.info.origin.position.x = made.info.origin.position.y = -1.0
    edge = {0, 39}
    made.data = [100 if x in edge or y in {0, 29} else 0 for y in range(30) for x in range(40)]
    return made


def scan() -> LaserScan:
    """A ring of one metre around base_link, but two metres ahead."""
    made = LaserScan(angle_min=-math.pi, angle_max=math.pi, angle_increment=math.pi / 180, range_min=0.1, range_max=9.0)
    made.header.frame_id = "base_link"
    made.ranges = [2.0 if i == 180 else 1.0 for i in range(360)]
    return made


def cloud() -> PointCloud2:
    names = ("x", "y", "z")
    fields = [PointField(name=name, offset=4 * i, datatype=7, count=1) for i, name in enumerate(names)]
    data = array("f", [2.0, 0.0, 0.1, 2.1, 0.1, 1.0, 2.2, 0.2, 2.0]).tobytes()
    made = PointCloud2(height=1, width=3, fields=fields, point_step=12, row_step=36, data=data, is_dense=True)
    made.header.frame_id = "map"
    return made


def markers() -> MarkerArray:
    wall = Marker(ns="wall", id=1, type=Marker.CUBE, color=ColorRGBA(r=1.0, g=0.0, b=1.0, a=1.0))
    wall.header.frame_id = "map"
    wall.pose.position.x, wall.pose.position.y = 1.0, -0.6
    wall.scale.x, wall.scale.y, wall.scale.z = 1.0, 0.2, 1.0
    text = Marker(
        ns="text", id=2, type=Marker.TEXT_VIEW_FACING, text="dock", color=ColorRGBA(r=1.0, g=1.0, b=1.0, a=1.0)
    )
    text.header.frame_id = "map"
    text.scale.z = 0.3
    text.pose.position.x, text.pose.position.y = 2.3, 1.2
    return MarkerArray(markers=[wall, text])


def publish_all(node: Node) -> None:
    """Publish one message of each kind that the panel draws."""
    odometry = Odometry(child_frame_id="base_link")
    odometry.header.frame_id = "odom"
    path, poses = Path(), PoseArray()
    path.header.frame_id = poses.header.frame_id = "map"
    for x in range(5):
        stamped = PoseStamped()
        stamped.pose.position.x, stamped.pose.position.y = x * 0.5, 0.1 * x * x
        path.poses.append(stamped)
        poses.poses.append(Pose(position=Point(x=x * 0.3, y=1.5)))
    polygon = PolygonStamped()
    polygon.header.frame_id = "base_link"
    polygon.polygon.points = [Point32(x=a, y=b) for a, b in ((0.3, 0.2), (-0.3, 0.2), (-0.3, -0.2), (0.3, -0.2))]
    for message, topic in ((path, "plan"), (poses, "particles"), (polygon, "footprint"), (cloud(), "points")):
        node.create_publisher(type(message), topic, LATCHED).publish(message)
    node.create_publisher(OccupancyGrid, "map", LATCHED).publish(grid())
    node.create_publisher(MarkerArray, "markers", LATCHED).publish(markers())
    node.create_publisher(Odometry, "odom", LATCHED).publish(odometry)
    static = [transform("map", "odom", 0.5, 0.25)]
    node.create_publisher(TFMessage, "/tf_static", LATCHED).publish(TFMessage(transforms=static))
    moving = [transform("odom", "base_link", 0.0, 0.0)]
    node.create_publisher(TFMessage, "/tf", LATCHED).publish(TFMessage(transforms=moving))
    node.create_publisher(LaserScan, "scan", LATCHED).publish(scan())


def look(page: Page, scale: float = 100.0) -> None:
    """Look at (1, 0.5) from always the same height."""
    page.wait_for_topic("/scan")
    page.browser.wait(f"{WORLD}.app.tf.lookup('base_link')")
    page.browser.js(f"{WORLD}.view.auto = false; {WORLD}.view.look(1, 0.5, {scale})")
    page.browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def colour(page: Page, x: float, y: float) -> list[int]:
    """Red, green and blue at a place of the world, in metres."""
    found: list[int] = page.browser.js(
        f"(() => {{ const {{ view, canvas }} = {WORLD};"
        f" return [...canvas.getContext('2d').getImageData(view.toX({x}), view.toY({y}), 1, 1).data].slice(0, 3); }})()"
    )
    return found


def status(page: Page, *words: str) -> str:
    """The text below the world, once it has these words."""
    wanted = " && ".join(f"{WORLD}.status.textContent.includes('{word}')" for word in words)
    return str(page.browser.wait(f"{wanted} && {WORLD}.status.textContent"))


def test_what_robots_publish_is_drawn_where_it_is(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        page.browser.wait(f"{WORLD}.scene.layers.size >= 8")
        page.wait_for_topic("/map")
        page.browser.wait(f"{WORLD}.scene.layers.get('/markers')?.layer.shown.size == 2")
        look(page)
        page.picture("world")
        page.browser.js(f"for (const name of ['tf', 'grid', 'names']) {WORLD}.scene.show(name, false)")
        look(page)
        assert colour(page, 1.0, -0.6) == [255, 0, 255], "the wall's marker"
        assert colour(page, -0.95, 0.0) != colour(page, -0.5, 1.7), "a wall of the map and its floor"
        ring = colour(page, 0.5 - 1.0, 0.25)
        assert ring != colour(page, 0.5 - 0.85, 0.25), "a beam of the scan, in base_link, odom and map"


def test_hovering_tells_places_and_values(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        browser.move(page.world(2.5, 0.25))
        assert "2.000 m (180)" in status(page, "x 2.5", "/scan")
        browser.move(page.world(-0.95, 1.05))
        assert "100 (0, 20)" in status(page, "x -0.95", "/map")
        browser.move(page.world(0.5, 0.25))
        assert "robot (0.50, 0.25, 0°)" in status(page, "robot")


def test_the_view_is_dragged_and_zoomed_and_fits_again(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        browser.drag(page.world(1, 0.5), page.world(2, 1.0))
        assert browser.js(f"[{WORLD}.view.x, {WORLD}.view.y]") == pytest.approx([0.0, 0.0], abs=0.03)
        before = browser.js(f"{WORLD}.view.scale")
        spot = page.world(0.5, 0.25)
        browser.wheel(spot, -200)
        browser.wait(f"{WORLD}.view.scale > {before} * 1.2")
        assert page.world(0.5, 0.25) == pytest.approx(spot, abs=1), "what is under the mouse stays there"
        browser.click(".panel-world .fit")
        browser.wait(f"{WORLD}.view.auto")
        x, y = page.world(-1, -1)
        assert 0 < x < 1280
        assert 0 < y < 720
        browser.press("+")
        browser.click(f"{page.panel('world')} canvas")
        browser.press("ArrowRight")
        browser.wait(f"!{WORLD}.view.auto")


def test_the_view_follows_a_robot(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        browser.click(".layers-button")
        browser.choose("select.follow", "robot")
        browser.wait(f"Math.abs({WORLD}.view.x - 0.5) < 0.01")
        tf = page.node.create_publisher(TFMessage, "/tf", LATCHED)
        tf.publish(TFMessage(transforms=[transform("odom", "base_link", 3.0, 1.0)]))
        browser.wait(f"Math.abs({WORLD}.view.x - 3.5) < 0.01 && Math.abs({WORLD}.view.y - 1.25) < 0.01")


def test_layers_are_switched_and_stay_so(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        browser.wait("robolink.layout.kind == 'drive'")
        browser.click(".layers-button")
        browser.click(".layers input[value='/scan']")
        browser.wait(f"!{page.topic('/scan')}.subscription")
        page.picture("world_layers")
        browser.open(page.view.address)
        browser.wait("globalThis.robolink?.layout?.kind == 'drive' && robolink.layout.isReady")
        page.wait_for_topic("/odom")
        assert browser.js(f"{WORLD}.scene.shows('/scan')") is False
        assert browser.js(f"{page.topic('/scan')}.subscription") == 0


@pytest.mark.parametrize(
    ("key", "topic", "kind"), [("g", "goal_pose", PoseStamped), ("i", "initialpose", PoseWithCovarianceStamped)]
)
def test_a_click_and_a_drag_give_a_pose(browser: Browser, key: str, topic: str, kind: Any) -> None:
    with opened(browser, "world") as page:
        heard: list[Any] = []
        publish_all(page.node)
        page.node.create_subscription(kind, topic, heard.append, 10)
        look(page)
        browser.click("[data-tab=world]")
        browser.press(key)
        browser.wait(f"{WORLD}.tool")
        browser.drag(page.world(1.0, 0.5), page.world(1.0, 1.5))
        browser.wait("document.querySelector('.note')?.textContent.includes('90°')")
        page.picture(f"world_{topic}")
        with spun(page.node) as executor:
            spin_until(executor, lambda: bool(heard))
        pose = heard[0].pose.pose if isinstance(heard[0], PoseWithCovarianceStamped) else heard[0].pose
        assert heard[0].header.frame_id == "map"
        assert (pose.position.x, pose.position.y) == pytest.approx((1.0, 0.5), abs=0.02)
        assert 2 * math.atan2(pose.orientation.z, pose.orientation.w) == pytest.approx(math.pi / 2, abs=0.02)


def test_another_fixed_frame_measures_in_it(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        browser.click(f"{page.panel('world')} canvas")
        browser.press("m")
        browser.wait("document.querySelector('select.fixed')?.options.length > 2")
        browser.choose("select.fixed", "odom")
        browser.wait("robolink.tf.fixed == 'odom'")
        browser.move(page.world(0.0, 0.0))
        assert "robot (0.00, 0.00, 0°)" in status(page, "robot")


def test_frames_that_are_not_connected_are_told(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        lost = scan()
        lost.header.frame_id = "nowhere"
        page.node.create_publisher(LaserScan, "lost", LATCHED).publish(lost)
        look(page)
        browser.wait(f"{WORLD}.note.textContent.includes('nowhere')")


def test_a_bag_that_is_moved_shows_nothing_of_the_time_before(browser: Browser, tmp_path: pathlib.Path) -> None:
    topic = BagTopic("/marks", "visualization_msgs/msg/MarkerArray", "cdr", "", (), message_definition(MarkerArray))
    with BagWriter(tmp_path / "bag") as writer:
        number = writer.add_topic(topic)
        for second in range(10):
            marker = Marker(ns=str(second), scale=Vector3(x=1.0, y=1.0, z=1.0))
            marker.header.frame_id = "map"
            writer.write(number, START + second * 10**9, 0, second, encode(MarkerArray(markers=[marker])))
    names = f"[...{WORLD}.scene.layers.get('/marks').layer.shown.keys()].map((each) => each[0]).join()"
    with (
        open_bag(tmp_path / "bag") as bag,
        View(BagSource(bag), Settings(port=0)) as view,
        opened(browser, "world", view=view),
    ):
        browser.wait("robolink.timeline.bag?.playing && robolink.topics.get('/marks')?.latest")
        assert not browser.js("document.querySelector('.tool-goal')"), "nobody drives in a bag"
        browser.js("robolink.connection.playback({ play: false, seek: robolink.timeline.bag.start + 8500 })")
        browser.wait(f"{names} === '8'")
        browser.js("robolink.connection.playback({ play: false, seek: robolink.timeline.bag.start + 2500 })")
        browser.wait(f"{names} === '2'")
