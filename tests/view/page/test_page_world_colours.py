"""Colours of the world panel: floor, things and signs as `world draw` has them, and a list equal to what is drawn."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from robolink import Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.geometry.plane import Pose, placed_on
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.sim import load_world
from robolink.sim.colours import Colour, colour_of
from robolink.sim.description import Sign, WorldDescription
from robolink.sim.looks import FLOOR, obstacle_colour, robot_colour
from robolink.sim.scene.floor import painted_floor
from robolink.sim.scene.pictures import read_picture
from robolink.world_node import Shapes, Simulation
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened
from tests.view.page.test_page_world import LATCHED, WORLD, look, publish_all, transform

WORLDS = Path(__file__).parents[3] / "configs" / "worlds"
NEAR = 12
"""Difference of a red, green or blue that counts as the same colour."""

LIKE = 48
"""The same for the picture of a sign, which is made smaller."""

CLEAR = 0.7
"""Distance in metres from things and signs within which the floor is not looked at."""

pytestmark = [pytest.mark.processes, needs_chromium]

READ = """(places) => {{ const {{ view, canvas }} = {world}, context = canvas.getContext("2d");
  return places.map(([x, y]) => [...context.getImageData(view.toX(x), view.toY(y), 1, 1).data].slice(0, 3)); }}"""


def colours_at(page: Page, places: list[tuple[float, float]]) -> list[list[int]]:
    """Red, green and blue at places of the world, in metres."""
    found: list[list[int]] = page.browser.js(f"({READ.format(world=WORLD)})({json.dumps(places)})")
    return found


def colours_around(page: Page, x: float, y: float, pixels: int) -> set[tuple[int, int, int]]:
    """All colours in a square of the canvas around a place, which reaches `pixels` to each side."""
    found = page.browser.js(
        f"(() => {{ const {{ view, canvas }} = {WORLD}, far = {pixels}, side = 2 * far + 1;"
        f" const {{ data }} = canvas.getContext('2d').getImageData("
        f"view.toX({x}) - far, view.toY({y}) - far, side, side);"
        " return Array.from({ length: data.length / 4 }, (_, i) => [...data.slice(4 * i, 4 * i + 3)]); })()"
    )
    return {(red, green, blue) for red, green, blue in found}


def is_like(one: Colour | list[int], other: Colour | list[int], most: int) -> bool:
    return all(abs(a - b) <= most for a, b in zip(one, other, strict=True))


def simulated(page: Page, description: WorldDescription) -> Simulation:
    """A world on the system of a page, after a second, with its markers."""
    context = page.node.context
    node = Node("world", context=context)
    simulation = Simulation(node, description, 0)
    Shapes(node, simulation, Clock(clock_type=ClockType.STEADY_TIME, time_base=context.time))
    page.browser.wait(f"{WORLD}?.scene.layers.get('/world/walls')?.layer.shown.size > 0")
    page.browser.wait("robolink.topics.get('/tf')?.subscription")
    while simulation.world.time_ns < 10**9 or page.browser.js("robolink.tf.nodes.size == 0"):
        simulation.step()
    page.browser.wait(f"{WORLD}.scene.drawn.length > 0")
    return simulation


def floor_places(description: WorldDescription) -> Iterator[tuple[tuple[float, float], Colour]]:
    """Places of a raster where the floor has one colour around them, and that colour as `world draw` has it."""
    settings = description.world.floor
    floor = painted_floor(settings, description.paint, None)
    plain = FLOOR if settings.colour is None else colour_of(settings.colour)
    width, height = description.world.size or (0.0, 0.0)
    things = [(each.start.x, each.start.y) for each in description.obstacles]
    things += [(each.pose.x, each.pose.y) for each in description.robots]
    things += [(each.pose.x, each.pose.y) for each in description.signs]
    walls = [segment for wall in description.walls for segment in wall.segments()]
    for x, y in itertools.product(np.arange(0.3, width - 0.3, 0.1), np.arange(0.3, height - 0.3, 0.1)):
        if any(math.hypot(x - tx, y - ty) < CLEAR for tx, ty in things) or any(
            distance((x, y), *wall) < 0.1 for wall in walls
        ):
            continue
        found = {plain}
        if floor.image is not None:
            column, row = (int((at - low) / floor.resolution) for at, low in zip((x, y), floor.origin, strict=True))
            rows, columns = floor.image.shape[:2]
            if 1 <= row < rows - 1 and 1 <= column < columns - 1:
                part = floor.image[row - 1 : row + 2, column - 1 : column + 2].reshape(-1, 3)
                found = {(int(red), int(green), int(blue)) for red, green, blue in part}
        if len(found) == 1:
            yield (round(float(x), 3), round(float(y), 3)), found.pop()


def distance(place: tuple[float, float], start: tuple[float, float], end: tuple[float, float]) -> float:
    """Distance of a place from the line between two others."""
    (x, y), (x1, y1), (dx, dy) = place, start, (end[0] - start[0], end[1] - start[1])
    share = min(1.0, max(0.0, ((x - x1) * dx + (y - y1) * dy) / ((dx * dx + dy * dy) or 1.0)))
    return math.hypot(x1 + share * dx - x, y1 + share * dy - y)


def all_signs(description: WorldDescription) -> Iterator[tuple[Sign, Pose]]:
    """Signs that stand, each with its place in the world."""
    yield from ((sign, sign.pose.place) for sign in description.signs)
    for each in description.obstacles:
        yield from ((sign, placed_on(each.start.place, sign.pose.place)) for sign in each.signs)


def main_colours(sign: Sign) -> list[Colour]:
    """Colours that fill a tenth of a sign's picture each."""
    if sign.image is None:
        return [(0, 0, 0), (255, 255, 255)]
    pixels = read_picture(sign.image).reshape(-1, 3)
    colours, counts = np.unique(pixels // 8 * 8 + 4, axis=0, return_counts=True)
    return [tuple(map(int, each)) for each, count in zip(colours, counts, strict=True) if count > len(pixels) / 10]  # type: ignore[misc]


@pytest.mark.parametrize("name", ["track", "blobs", "signs"])
def test_a_world_has_the_colours_that_world_draw_has(browser: Browser, name: str) -> None:
    description = load_world(WORLDS / f"{name}.yaml")
    with opened(browser, "world") as page:
        simulated(page, description)
        browser.wait(f"{WORLD}.scene.layers.get('/world/floor').layer.shown.size > 0 && {WORLD}.view.scale > 60")
        for layer in ("/scan", "/odom", "/camera/camera_info", "grid"):  # translucent ones above the floor
            browser.js(f"{WORLD}.scene.show('{layer}', false)")
        places = list(floor_places(description))
        painted = {colour for _, colour in places}
        assert len(painted) == 1 + len({each.colour for each in description.paint})
        for theme in ("dark", "light"):
            browser.js(f"document.documentElement.dataset.theme = '{theme}'; robolink.emit('theme')")
            browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            page.picture(f"colours_{name}_{theme}")
            drawn = colours_at(page, [place for place, _ in places])
            wrong = [
                (place, expected, found)
                for (place, expected), found in zip(places, drawn, strict=True)
                if not is_like(expected, found, NEAR)
            ]
            assert len(wrong) <= len(places) / 200, wrong[:5]  # a pixel of the picture may lie on an edge of the paint
            for each in description.obstacles:
                (found,) = colours_at(page, [(each.start.x, each.start.y)])
                assert is_like(obstacle_colour(each), found, NEAR), (each, found)
            robot = description.robots[0]
            beside = placed_on(robot.pose.place, Pose(-0.8 * (robot.shape.circle or 0.0)))  # its arrow is white
            assert is_like(robot_colour(robot), colours_at(page, [(beside.x, beside.y)])[0], NEAR)
            for sign, place in all_signs(description):
                near = colours_around(page, place.x, place.y, 60)
                missing = [one for one in main_colours(sign) if not any(is_like(one, each, LIKE) for each in near)]
                assert not missing, (sign, place)


def test_the_list_of_layers_has_the_colours_that_are_drawn(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        browser.wait(f"{WORLD}.scene.layers.size >= 8 && {WORLD}.scene.layers.get('/markers').layer.shown.size == 2")
        page.wait_for_topic("/map")
        browser.click(".layers-button")
        browser.wait("document.querySelectorAll('.list canvas').length >= 12")
        drawn = {  # places in the world where each layer is, without another above it
            "/scan": (0.5 - math.cos(0.5), 0.25 - math.sin(0.5)),
            "/plan": (1.5, 0.9),
            "/markers": (1.4, -0.6),
            "/map": (-0.95, 0.3),
        }
        for theme in ("dark", "light"):
            browser.js(f"document.documentElement.dataset.theme = '{theme}'; robolink.emit('theme')")
            browser.js(f"{WORLD}.slow = undefined")
            browser.js("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            page.picture(f"world_legend_{theme}")
            for name, place in drawn.items():
                swatch = browser.js(
                    f"(() => {{ const each = document.querySelector('.list canvas[data-name=\"{name}\"]');"
                    " const { data } = each.getContext('2d').getImageData(0, 0, each.width, each.height);"
                    " return Array.from({ length: data.length / 4 }, (_, i) => [...data.slice(4 * i, 4 * i + 3)]); })()"
                )
                near = colours_around(page, *place, 1)
                assert any(is_like(one, other, 2) for one in near for other in swatch), (theme, name, near)


def test_a_goal_that_nobody_listens_to_is_no_success(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        look(page)
        browser.click(".tool-goal")
        browser.drag(page.world(1.0, 0.5), page.world(1.0, 1.5))
        note = browser.wait("document.querySelector('.note.error')?.textContent")
        assert note == "nobody listens to /goal_pose: start a node that drives there, such as: robolink run goto"
        assert not browser.js(f"{WORLD}.scene.layers.has('/goal_pose')")


def test_a_goal_stays_until_a_robot_has_come_to_it(browser: Browser) -> None:
    with opened(browser, "world") as page:
        publish_all(page.node)
        page.node.create_subscription(PoseStamped, "goal_pose", lambda _: None, 10)
        look(page)
        browser.wait("robolink.connection.graph.subscribed.get('/goal_pose')?.length")
        browser.click(".tool-goal")
        browser.drag(page.world(2.0, -0.2), page.world(2.0, 0.8))
        pink = browser.js("robolink.colour('goal')")
        there = [int(pink[at : at + 2], 16) for at in (1, 3, 5)]
        browser.wait(f"{WORLD}.scene.layers.has('/goal_pose') && !{WORLD}.tool")
        look(page)
        assert colours_at(page, [(2.0, -0.2)]) == [there]
        tf = page.node.create_publisher(TFMessage, "/tf", LATCHED)
        tf.publish(TFMessage(transforms=[transform("odom", "base_link", 1.4, -0.4)]))
        browser.wait(f"{WORLD}.scene.layers.get('/goal_pose').layer.reached")
        look(page)
        assert colours_at(page, [(2.0, -0.2)]) != [there]
