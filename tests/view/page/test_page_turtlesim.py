"""The turtlesim panel: the window's picture, the choice of turtles, and the keys that drive them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robolink.counterparts.turtlesim.turtlesim_node import TurtleSim
from robolink.image.codecs import png_of
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import CompressedImage
from robolink.interfaces.turtlesim.action import RotateAbsolute
from robolink.interfaces.turtlesim.msg import Pose
from robolink.qos import DurabilityPolicy, QoSProfile
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened, spun
from tests.support.seen_by_commands import spinning
from tests.support.spins import spin_until
from tests.support.waits import wait_until

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PICTURE = CompressedImage(format="png", data=png_of(np.full((500, 500, 3), (69, 86, 255), np.uint8)))

pytestmark = [pytest.mark.processes, needs_chromium]


def turtlesim(page: Page, space: str, *turtles: str) -> dict[str, list[tuple[float, float]]]:
    """Publish what a turtlesim in a namespace does; return the commands that each turtle gets."""
    page.node.create_publisher(CompressedImage, f"{space}/turtlesim/_picture", LATCHED).publish(PICTURE)
    heard: dict[str, list[tuple[float, float]]] = {}
    for turtle in turtles:
        page.node.create_publisher(Pose, f"{space}/{turtle}/pose", 1)
        got = heard[f"{space}/{turtle}"] = []

        def hear(twist: Twist, got: list[tuple[float, float]] = got) -> None:
            got.append((twist.linear.x, twist.angular.z))

        page.node.create_subscription(Twist, f"{space}/{turtle}/cmd_vel", hear, 10)
    return heard


def test_the_arrow_keys_drive_the_turtle_that_is_chosen(browser: Browser) -> None:
    with opened(browser, "turtlesim") as page:
        heard = turtlesim(page, "", "turtle1", "turtle2")
        browser.wait("document.activeElement?.matches('canvas.image')")  # without a click
        assert browser.js("document.querySelector('canvas.image').width") == 500
        assert browser.js("document.querySelector('.panel-turtlesim .picker').hidden")
        browser.wait("document.querySelector('.turtle').options.length == 2")
        with spun(page.node) as executor:
            for key in ("ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"):
                browser.press(key)
            spin_until(executor, lambda: len(heard["/turtle1"]) >= 4)
            assert heard == {"/turtle1": [(2.0, 0.0), (-2.0, 0.0), (0.0, 2.0), (0.0, -2.0)], "/turtle2": []}
            browser.choose(".turtle", "/turtle2")
            browser.press("ArrowUp")
            spin_until(executor, lambda: bool(heard["/turtle2"]))
        assert (heard["/turtle2"], len(heard["/turtle1"])) == ([(2.0, 0.0)], 4)


def test_a_turtlesim_is_seen_and_driven(browser: Browser) -> None:
    with opened(browser, "turtlesim") as page:
        turtlesim = TurtleSim(context=page.system.new_context())
        with spinning(turtlesim):
            browser.wait("document.activeElement?.matches('canvas.image')")
            browser.wait("document.querySelector('.turtle').value == '/turtle1'")
            context = "document.querySelector('canvas.image').getContext('2d')"
            ahead = f"Array.from({context}.getImageData(300, 249, 1, 1).data)"
            assert browser.js(ahead) == [69, 86, 255, 255]
            turtle = turtlesim.turtles["turtle1"].turtle

            def has_passed() -> bool:
                browser.press("ArrowUp")
                return turtle.x > 7.3

            wait_until(has_passed)
            browser.wait(f"{ahead}.join() == '179,184,255,255'")
            page.picture("turtlesim")


def test_letters_turn_it_to_a_heading(browser: Browser) -> None:
    from robolink.action import ActionServer

    goals: list[float] = []

    def execute(goal: Any) -> RotateAbsolute.Result:
        goals.append(goal.request.theta)
        goal.succeed()
        return RotateAbsolute.Result()

    with opened(browser, "turtlesim") as page:
        turtlesim(page, "/a", "turtle1")
        ActionServer(page.node, RotateAbsolute, "/a/turtle1/rotate_absolute", execute)
        browser.wait("robolink.connection.service('/a/turtle1/rotate_absolute/_action/send_goal')")
        browser.wait("document.activeElement?.matches('canvas.image')")
        with spun(page.node) as executor:
            browser.press("e")
            browser.press("d")
            spin_until(executor, lambda: len(goals) == 2)
        assert goals == pytest.approx([2.3562, 3.1416])


def test_each_picture_has_its_own_turtles(browser: Browser) -> None:
    with opened(browser, "turtlesim") as page:
        turtlesim(page, "/turtlesim1", "turtle1")
        turtlesim(page, "/turtlesim2", "turtle1")
        browser.wait("document.querySelector('.panel-turtlesim .picker').options.length == 2")
        browser.choose(".panel-turtlesim .picker", "/turtlesim2/turtlesim/_picture")
        browser.wait("document.querySelector('.turtle').value == '/turtlesim2/turtle1'")
        assert browser.js("document.querySelector('.turtle').options.length") == 1


def test_who_may_only_look_drives_nothing(browser: Browser) -> None:
    with opened(browser, "turtlesim", token=False) as page:
        heard = turtlesim(page, "", "turtle1")
        browser.wait("document.activeElement?.matches('canvas.image')")
        browser.wait("document.querySelector('.turtle').value == '/turtle1'")
        browser.press("ArrowUp")
        browser.wait("document.querySelector('.note.error')")
        assert heard == {"/turtle1": []}
        assert page.node.count_publishers("/turtle1/cmd_vel") == 0
