"""The world panel beside a navigation: particles, paths, costmaps and footprint; poses are sent in the frame map."""

from __future__ import annotations

import itertools
import math
import random

import numpy as np
import pytest

from robolink.interfaces.geometry_msgs.msg import (
    Point32,
    PolygonStamped,
    PoseStamped,
    PoseWithCovarianceStamped,
)
from robolink.interfaces.nav2_msgs.msg import Particle, ParticleCloud
from robolink.interfaces.nav_msgs.msg import OccupancyGrid, Odometry, Path
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.message import Message
from robolink.node import Node
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened, spun
from tests.support.spins import spin_until
from tests.view.page.test_page_world import LATCHED, WORLD, colour, transform

pytestmark = [pytest.mark.processes, needs_chromium]

CELL = 0.05
WIDTH, HEIGHT = 160, 120
"""Cells of the map, which begins at (0, 0): eight by six metres."""

ROBOT = (2.0, 1.5, 0.5)
"""Pose of the robot in the frame map; the frame odom is turned in it."""

ODOM = (0.5, -0.3, 0.2)
GOAL = (6.8, 4.8)
COSTMAPS = ("/global_costmap/costmap", "/local_costmap/costmap")


def walls() -> np.ndarray:
    """Cells of a room with a wall in it, true where they are occupied, in rows from the bottom."""
    cells = np.zeros((HEIGHT, WIDTH), dtype=bool)
    cells[[0, -1], :] = cells[:, [0, -1]] = True
    cells[:70, 78:82] = True
    return cells


def costs(cells: np.ndarray) -> np.ndarray:
    """Cost of each cell by its distance from the next occupied one, as an OccupancyGrid has it: 0 to 100."""
    rows, columns = np.nonzero(cells)
    y, x = np.mgrid[: cells.shape[0], : cells.shape[1]]
    nearest = np.full(cells.shape, np.inf)
    for row, column in zip(rows, columns, strict=True):
        nearest = np.minimum(nearest, np.hypot(y - row, x - column) * CELL)
    found = np.where(nearest < 0.55, 98 * np.exp(-3.0 * np.maximum(0.0, nearest - 0.2)), 0.0)
    return np.where(nearest == 0.0, 100, np.where(nearest <= 0.2, 99, found)).astype(np.int8)


def grid(frame: str, cells: np.ndarray, x: float = 0.0, y: float = 0.0) -> OccupancyGrid:
    made = OccupancyGrid()
    made.header.frame_id = frame
    made.info.resolution, made.info.width, made.info.height = CELL, cells.shape[1], cells.shape[0]
    made.info.origin.position.x, made.info.origin.position.y = x, y
    made.data = cells.ravel().tolist()
    return made


def path(*places: tuple[float, float]) -> Path:
    made = Path()
    made.header.frame_id = "map"
    for (x, y), (x1, y1) in itertools.pairwise(places):
        for share in (0.0, 0.5, 1.0):
            stamped = PoseStamped()
            stamped.pose.position.x, stamped.pose.position.y = x + share * (x1 - x), y + share * (y1 - y)
            made.poses.append(stamped)
    return made


def cloud(count: int) -> ParticleCloud:
    """Particles around the robot; those that are farther away weigh less."""
    dice, made = random.Random(33), ParticleCloud()
    made.header.frame_id = "map"
    for _ in range(count):
        particle, (dx, dy, turn) = Particle(), (dice.gauss(0.0, each) for each in (0.25, 0.15, 0.15))
        place, yaw = particle.pose.position, ROBOT[2] + turn
        place.x, place.y = ROBOT[0] + dx, ROBOT[1] + dy
        particle.pose.orientation.z, particle.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        particle.weight = math.exp(-8.0 * (dx * dx + dy * dy)) / count
        made.particles.append(particle)
    return made


def estimate() -> PoseWithCovarianceStamped:
    made = PoseWithCovarianceStamped()
    made.header.frame_id = "map"
    made.pose.pose.position.x, made.pose.pose.position.y = ROBOT[:2]
    made.pose.pose.orientation.z, made.pose.pose.orientation.w = math.sin(ROBOT[2] / 2), math.cos(ROBOT[2] / 2)
    made.pose.covariance[0], made.pose.covariance[7], made.pose.covariance[35] = 0.0625, 0.0225, 0.0225
    return made


def in_odom(x: float, y: float) -> tuple[float, float]:
    """A place of the frame map in the frame odom."""
    dx, dy, cos, sin = x - ODOM[0], y - ODOM[1], math.cos(ODOM[2]), math.sin(ODOM[2])
    return cos * dx + sin * dy, cos * dy - sin * dx


def in_map(x: float, y: float) -> tuple[float, float]:
    """A place of the frame odom in the frame map."""
    cos, sin = math.cos(ODOM[2]), math.sin(ODOM[2])
    return ODOM[0] + cos * x - sin * y, ODOM[1] + sin * x + cos * y


def publish(node: Node, message: Message, topic: str) -> None:
    node.create_publisher(type(message), topic, LATCHED).publish(message)


def navigate(node: Node) -> None:
    """Publish once what the nodes of a navigation publish."""
    cells, (x, y) = walls(), in_odom(*ROBOT[:2])
    known = np.where(cells, 100, 0).astype(np.int8)
    known[80:, 100:130] = -1
    local = np.zeros((60, 60), dtype=bool)
    local[20:40, 50:53] = True
    footprint = PolygonStamped()
    footprint.header.frame_id = "odom"
    corners = ((0.22, 0.18), (-0.22, 0.18), (-0.22, -0.18), (0.22, -0.18))
    turn = ROBOT[2] - ODOM[2]
    footprint.polygon.points = [
        Point32(x=x + a * math.cos(turn) - b * math.sin(turn), y=y + a * math.sin(turn) + b * math.cos(turn))
        for a, b in corners
    ]
    odometry = Odometry(child_frame_id="base_link")
    odometry.header.frame_id = "odom"
    odometry.pose.pose.position.x, odometry.pose.pose.position.y = x, y
    publish(node, grid("odom", costs(local), x - 1.5, y - 1.5), "/local_costmap/costmap")
    publish(node, grid("map", costs(cells)), "/global_costmap/costmap")
    publish(node, grid("map", known), "/map")
    publish(node, path(ROBOT[:2], (3.0, 3.9), (4.0, 4.1), (5.0, 4.2), GOAL), "/plan")
    publish(node, path(ROBOT[:2], (2.5, 2.7)), "/local_plan")
    publish(node, footprint, "/local_costmap/published_footprint")
    publish(node, odometry, "/odom")
    publish(node, TFMessage(transforms=[transform("map", "odom", *ODOM)]), "/tf_static")
    publish(node, TFMessage(transforms=[transform("odom", "base_link", x, y, turn)]), "/tf")
    publish(node, estimate(), "/amcl_pose")
    publish(node, cloud(2000), "/particle_cloud")


def look(page: Page, scale: float = 80.0) -> None:
    """Wait for all of the navigation, and look at the middle of the map from always the same height."""
    for name in (*COSTMAPS, "/map", "/plan", "/local_plan", "/particle_cloud"):
        page.wait_for_topic(name)
    page.browser.wait("robolink.tf.lookup('base_link') && robolink.tf.lookup('odom')")
    page.browser.wait(f"{WORLD}.scene.drawn.length == 1")
    page.browser.js(f"{WORLD}.view.auto = false; {WORLD}.view.look(4, 3, {scale})")
    page.browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def show(page: Page, *names: str) -> None:
    """Show these layers alone."""
    page.browser.js(
        f"(() => {{ const {{ scene }} = {WORLD};"
        f" for (const name of ['grid', 'trails', ...scene.layers.keys()])"
        f" scene.show(name, {list(names)}.includes(name)); }})()"
    )
    for name in names:
        page.browser.wait(f"{WORLD}.scene.layers.get('{name}').seen")
    page.browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def without_robots(page: Page) -> None:
    """Draw no robots: they would be above what is looked at."""
    page.browser.js(f"{WORLD}.scene.robots = () => []; {WORLD}.scene.dirty = true")
    page.browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def near(page: Page, name: str, x: float, y: float) -> bool:
    """True if a pixel near a place has the colour of the palette with a name."""
    found = page.browser.js(
        f"(() => {{ const {{ view, canvas }} = {WORLD}, wanted = robolink.colour('{name}');"
        f" const {{ data }} = canvas.getContext('2d').getImageData(view.toX({x}) - 3, view.toY({y}) - 3, 7, 7);"
        " const parts = [1, 3, 5].map((at) => parseInt(wanted.slice(at, at + 2), 16));"
        " const isLike = (i) => parts.every((part, k) => Math.abs(part - data[4 * i + k]) < 4);"
        " return Array.from({ length: data.length / 4 }, (_, i) => isLike(i)).includes(true); })()"
    )
    return bool(found)


def test_a_navigation_is_drawn(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        look(page)
        for theme in ("dark", "light"):
            browser.js(f"document.documentElement.dataset.theme = '{theme}'; robolink.emit('theme')")
            browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            page.picture(f"navigation_{theme}")


def test_the_path_to_the_goal_and_that_of_the_next_seconds_have_colours_of_their_own(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        look(page)
        show(page, "/plan", "/local_plan")
        assert near(page, "path", 4.5, 4.15)
        assert near(page, "local", 2.3, 2.22)
        assert not near(page, "path", 2.3, 2.22), "the nearer path lies above the other"


def test_particles_are_where_they_are_and_fainter_with_less_weight(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        look(page)
        show(page, "/particle_cloud")
        empty = colour(page, 5.0, 2.0)
        steps = browser.js(f"{WORLD}.scene.layers.get('/particle_cloud').layer.steps.map((each) => each.length)")
        assert sum(steps) == 2000
        assert all(steps)
        without_robots(page)
        assert near(page, "particles", *ROBOT[:2])
        assert colour(page, 2.0, 3.0) == empty, "none is far from the robot"
        browser.move(page.world(ROBOT[0], ROBOT[1]))
        browser.wait(f"{WORLD}.status.textContent.includes('/particle_cloud 2000')")


def test_a_flood_of_particles_is_thinned(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        publish(page.node, cloud(20_000), "/many")
        look(page)
        browser.wait(f"{WORLD}.scene.layers.get('/many')?.layer.poses?.length == 5000")


def test_costmaps_lie_on_the_map_which_is_seen_through_them(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        look(page)
        show(page, "/map")
        free, wall = colour(page, 6.0, 2.0), colour(page, 4.0, 2.0)
        show(page, "/map", "/global_costmap/costmap")
        assert colour(page, 6.0, 2.0) == free, "no cost, no colour"
        lethal, inscribed, unknown = (colour(page, x, y) for x, y in ((4.0, 2.0), (4.2, 2.0), (5.5, 4.5)))
        assert lethal != wall
        assert lethal[1] > 0, "the wall shines through"
        assert inscribed[0] < inscribed[1] == pytest.approx(inscribed[2], abs=8), "cyan"
        show(page, "/map")
        assert colour(page, 5.5, 4.5) == unknown, "what is unknown is not coloured"


def test_a_local_costmap_moves_with_its_frame(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        look(page)
        show(page, "/local_costmap/costmap")
        x, y = in_odom(*ROBOT[:2])
        there = (x - 1.5 + 51.5 * CELL, y - 1.5 + 30.5 * CELL)  # lethal, in odom
        floor = colour(page, 6.0, 2.0)
        assert colour(page, *in_map(*there)) != floor
        moved = (ODOM[0] + 2.0, ODOM[1] + 0.5, ODOM[2])
        publish(page.node, TFMessage(transforms=[transform("map", "odom", *moved)]), "/tf_static")
        browser.wait(f"robolink.tf.lookup('odom').x > {ODOM[0] + 1.0}")
        browser.js(f"{WORLD}.slow = undefined")
        browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        assert colour(page, *in_map(*there)) == floor
        px, py = in_map(*there)
        assert colour(page, px + 2.0, py + 0.5) != floor


def test_the_footprint_and_the_covariance_are_around_the_robot(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        look(page)
        show(page, "/local_costmap/published_footprint")
        turn, inside = ROBOT[2], colour(page, *ROBOT[:2])
        corner = (ROBOT[0] + 0.22 * math.cos(turn), ROBOT[1] + 0.22 * math.sin(turn))
        without_robots(page)
        assert colour(page, *corner) != inside
        show(page, "/amcl_pose")
        assert near(page, "particles", ROBOT[0] + 2 * 0.25, ROBOT[1]), "two standard deviations along x"
        assert near(page, "particles", ROBOT[0], ROBOT[1] + 2 * 0.15), "and along y"


@pytest.mark.parametrize(
    ("key", "topic", "kind"), [("g", "goal_pose", PoseStamped), ("i", "initialpose", PoseWithCovarianceStamped)]
)
def test_a_pose_is_sent_in_the_frame_map_whatever_is_fixed(browser: Browser, key: str, topic: str, kind: type) -> None:
    with opened(browser, "world", settings={"fixed": "odom"}) as page:
        heard: list[PoseStamped | PoseWithCovarianceStamped] = []
        navigate(page.node)
        page.node.create_subscription(kind, topic, heard.append, 10)
        look(page)
        browser.wait("robolink.tf.fixed == 'odom'")
        browser.click("[data-tab=world]")
        browser.press(key)
        browser.wait(f"{WORLD}.tool")
        browser.drag(page.world(*in_odom(4.5, 4.5)), page.world(*in_odom(4.5, 5.5)))
        browser.wait("document.querySelector('.note')?.textContent.includes('90° in map')")
        with spun(page.node) as executor:
            spin_until(executor, lambda: bool(heard))
        (found,) = heard
        pose = found.pose.pose if isinstance(found, PoseWithCovarianceStamped) else found.pose
        assert found.header.frame_id == "map"
        assert (pose.position.x, pose.position.y) == pytest.approx((4.5, 4.5), abs=0.03)
        assert 2 * math.atan2(pose.orientation.z, pose.orientation.w) == pytest.approx(math.pi / 2, abs=0.03)
        if isinstance(found, PoseWithCovarianceStamped):
            assert {i: each for i, each in enumerate(found.pose.covariance) if each} == {0: 0.25, 7: 0.25, 35: 0.0685}
            assert not browser.js(f"{WORLD}.scene.shows('/initialpose')"), "the estimate takes its place"


def test_a_goal_that_fails_is_told_and_taken_away(browser: Browser) -> None:
    with opened(browser, "world") as page:
        navigate(page.node)
        logger = page.node.get_logger()
        logger.error("an old error")
        page.node.create_subscription(PoseStamped, "goal_pose", lambda _: logger.error("it is in a wall"), 10)
        look(page)
        browser.wait("robolink.connection.graph.subscribed.get('/goal_pose')?.length")
        browser.click(".tool-goal")
        browser.drag(page.world(4.0, 2.0), page.world(4.0, 3.0))
        browser.wait(f"{WORLD}.scene.layers.has('/goal_pose') && !{WORLD}.scene.layers.get('/goal_pose').layer.reached")
        with spun(page.node) as executor:
            told = "document.querySelector('.note.error')?.textContent"
            spin_until(executor, lambda: browser.js(told) == "it is in a wall")
        assert browser.js(f"{WORLD}.scene.layers.get('/goal_pose').layer.reached")


def test_without_a_map_a_goal_is_in_the_fixed_frame(browser: Browser) -> None:
    with opened(browser, "world") as page:
        heard: list[PoseStamped] = []
        publish(page.node, TFMessage(transforms=[transform("odom", "base_link", 0.0, 0.0)]), "/tf")
        page.node.create_subscription(PoseStamped, "goal_pose", heard.append, 10)
        browser.wait("robolink.tf.fixed == 'odom'")
        browser.wait("robolink.connection.graph.subscribed.get('/goal_pose')?.length")
        browser.click(".tool-goal")
        browser.drag(page.world(1.0, 0.5), page.world(1.0, 1.5))
        browser.wait("document.querySelector('.note')?.textContent.includes('in odom')")
        with spun(page.node) as executor:
            spin_until(executor, lambda: bool(heard))
        assert heard[0].header.frame_id == "odom"
        assert heard[0].pose.position.x == pytest.approx(1.0, abs=0.03)
