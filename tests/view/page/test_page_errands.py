"""A person's ten errands by mouse, by keyboard alone and on a phone: each is done, in at most five clicks.

A key that is pressed, a text that is typed, a tap and a drag count as one click each; a choice from a menu as two.
`python -m tests.view.page.test_page_errands` prints the table that docs/reference/view.md has.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest

from robolink.bag.reader import open_bag
from robolink.interfaces.geometry_msgs.msg import PoseStamped, TransformStamped, Twist
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rcl_interfaces.msg import FloatingPointRange, Log, ParameterDescriptor
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Bool
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages, write
from tests.support.browser import Browser, needs_chromium
from tests.support.hands import Step, choose, click, click_at, do, drag, hold, key, let_go, see, text
from tests.support.pages import opened
from tests.support.view_clients import shown, until

pytestmark = [pytest.mark.processes, needs_chromium]

MOST = 5
WAYS = ("mouse", "keys", "phone")
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
FIELD = "twist.twist.linear.x"


class Robot:
    """A robot that drives, with a camera, a parameter, a service and a log; it keeps what it was told to do."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.x = self.speed = 0.0
        self.held = False
        self.goals: list[PoseStamped] = []
        self.calls = 0
        node.create_subscription(Twist, "/cmd_vel", lambda twist: setattr(self, "speed", twist.linear.x), 10)
        node.create_subscription(Bool, "/e_stop", lambda told: setattr(self, "held", told.data), LATCHED)
        node.create_subscription(PoseStamped, "/goal_pose", self.goals.append, 10)
        node.create_service(Trigger, "/reset", self._reset)
        node.create_service(Trigger, "/calibrate", lambda request, response: response)
        limits = [FloatingPointRange(from_value=0.0, to_value=2.0)]
        node.declare_parameter("gain", 1.0, ParameterDescriptor(floating_point_range=limits))
        node.declare_parameter("max_speed", 0.5, ParameterDescriptor(floating_point_range=limits))
        self._odometry = node.create_publisher(Odometry, "/odom", 10)
        self._image = node.create_publisher(Image, "/image", 10)
        self._tf = node.create_publisher(TFMessage, "/tf", 10)
        log = node.create_publisher(Log, "/rosout", QoSProfile(depth=200, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        log.publish(Log(level=Log.WARN, name="robot", msg="battery low"))
        for number in range(100):
            log.publish(Log(level=Log.INFO, name="robot", msg=f"step {number}"))
        node.create_timer(0.05, self._step)

    def _reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.calls += 1
        response.success = True
        return response

    def _step(self) -> None:
        self.x += self.speed * 0.05
        odometry = Odometry(child_frame_id="base_link")
        odometry.header.frame_id = "odom"
        odometry.pose.pose.position.x = self.x
        odometry.twist.twist.linear.x = self.speed
        self._odometry.publish(odometry)
        place = TransformStamped(child_frame_id="base_link")
        place.header.frame_id = "odom"
        place.transform.translation.x = self.x
        self._tf.publish(TFMessage(transforms=[place]))
        self._image.publish(Image(width=4, height=3, step=4, encoding="mono8", data=bytes(range(12))))


class Scene:
    """What the page shows, and where its server records."""

    def __init__(self, view: View, folder: Path, robot: Robot | None = None) -> None:
        self.view, self.folder, self._robot = view, folder, robot

    @property
    def robot(self) -> Robot:
        assert self._robot is not None, "there is no robot beside a bag"
        return self._robot

    def bag(self) -> dict[str, int]:
        """How many messages of each topic were recorded."""
        (folder,) = self.folder.glob("rosbag2_*")
        with open_bag(folder) as bag:
            return dict(bag.counts)

    def parameter(self) -> float:
        return float(self.robot.node.get_parameter("max_speed").value)


class Errand(NamedTuple):
    """How it is done in each way, and a condition that it is done."""

    mouse: list[Step]
    keys: list[Step]
    phone: list[Step]
    done: Callable[[Browser, Scene], object]

    def steps(self, way: str) -> list[Step]:
        found: list[Step] = getattr(self, way)
        return found


SHORT = see("((found) => found > 0 && found < 9)(document.querySelectorAll('#found button').length)")


def find(wanted: str) -> list[Step]:
    """Find by the header's button, and click what is found first."""
    return [click("#find"), text(wanted), SHORT, click("#found button")]


def find_by_keys(wanted: str) -> list[Step]:
    return [key("/"), text(wanted), SHORT, key("Enter")]


def is_seen(selector: str) -> str:
    """JavaScript: an element is there, within the page and not covered."""
    return (
        f"((e) => {{ const r = e?.getClientRects()[0]; return r && e.contains(document.elementFromPoint("
        f"r.left + r.width / 2, r.top + r.height / 2)); }})(document.querySelector({selector!r}))"
    )


PULL = drag(".stick", (0.5, 0.5), (0.5, 0.1), hold=True)
SLIDE = drag("input[type=range][aria-label=max_speed]", (0.25, 0.5), (0.75, 0.5))
ON_FIELD = see("document.activeElement.dataset.parameter == 'max_speed'")
ON_CALL = see("document.activeElement.className == 'call' && !document.activeElement.disabled")
IS_OFF = "document.getElementById('record').ariaPressed == 'false'"
IN_HALF = click_at("#scrub", 0.5, 0.5)

ERRANDS = {
    "drive the robot": Errand(
        [click("[data-tab=teleop]"), PULL],
        [key("d"), see("document.activeElement.className == 'stick'"), hold("w")],
        [PULL],
        lambda browser, scene: until(lambda: scene.robot.x > 0.05),
    ),
    "stop it": Errand(
        [click("#stop")],
        [key(" ")],
        [click("#stop")],
        lambda browser, scene: until(lambda: scene.robot.held),
    ),
    "set a goal": Errand(
        [click(".tool-goal"), click_at("canvas.world", 0.3, 0.3)],
        [key("g"), see("robolink.layout.panel('world').scene.wanted"), key("ArrowRight"), key("ArrowUp"), key("Enter")],
        [click(".layers-button"), click(".tool-goal"), click_at("canvas.world", 0.2, 0.7)],
        lambda browser, scene: until(lambda: len(scene.robot.goals) == 1),
    ),
    "see the camera": Errand(
        [],
        [],
        [click("[data-tab=images]")],
        lambda browser, scene: browser.wait(
            f"{is_seen('canvas.image')} && document.querySelector('canvas.image').width == 4"
        ),
    ),
    "plot a field": Errand(
        find(f"odom {FIELD}"),
        find_by_keys(f"odom {FIELD}"),
        find(f"odom {FIELD}"),
        lambda browser, scene: browser.wait(
            f"{is_seen('canvas.plot')} && robolink.layout.panel('plot').series.some("
            f"({{topic, path, times}}) => topic == '/odom' && path == '{FIELD}')"
        ),
    ),
    "change a parameter": Errand(
        [*find("max_speed"), SLIDE],
        [*find_by_keys("max_speed"), ON_FIELD, text("1.25"), key("Enter")],
        [*find("max_speed"), SLIDE],
        lambda browser, scene: until(lambda: 1 < scene.parameter() < 2),
    ),
    "call a service": Errand(
        [*find("/reset"), click("button.call")],
        [*find_by_keys("/reset"), ON_CALL, key("Enter")],
        [*find("/reset"), click("button.call")],
        lambda browser, scene: until(lambda: scene.robot.calls == 1),
    ),
    "record a bag": Errand(
        [click("#record"), see("robolink.recorded > 20"), click("#record")],
        [key("r"), see("robolink.recorded > 20"), key("r")],
        [click("#more"), click("#record"), see("robolink.recorded > 20"), click("#record")],
        lambda browser, scene: browser.wait(f"{IS_OFF} && document.querySelector('.note')") and scene.bag()["/odom"],
    ),
    "go back in a bag": Errand(
        [click("#pause"), IN_HALF],
        [key("p"), see("!robolink.timeline.bag.playing"), key("."), key("."), key(",")],
        [click("#pause"), IN_HALF],
        lambda browser, scene: browser.wait(
            "((bag) => !bag.playing && bag.time - bag.start > 900)(robolink.timeline.bag)"
        ),
    ),
    "find a warning": Errand(
        [click("[data-tab=log]"), choose(".panel-log .level", "30")],
        [*find_by_keys("log"), see("document.querySelector('.panel-log:focus .level')"), key("Tab"), text("w")],
        [click(".tabs button:nth-child(4)"), choose(".panel-log .level", "30")],
        lambda browser, scene: browser.wait(
            f"{is_seen('.log .level-warn span')} && !document.querySelector('.log .level-info')"
        ),
    ),
}


@contextmanager
def robot_scene(folder: Path) -> Iterator[Scene]:
    """A robot, and the view of it."""
    with shown() as system, system.spinning() as node:
        yield Scene(system.view, folder, Robot(node))


@contextmanager
def bag_scene(folder: Path) -> Iterator[Scene]:
    """A bag of nine seconds, and the view of it."""
    write(folder / "lap", ten_messages())
    with open_bag(folder / "lap") as bag, View(BagSource(bag), Settings(port=0)) as view:
        yield Scene(view, folder)


def do_errand(browser: Browser, name: str, way: str) -> int:
    """Do an errand on a page that has just been opened; return the clicks that it took."""
    phone, errand = way == "phone", ERRANDS[name]
    browser.resize(*((390, 844) if phone else (1440, 900)), phone=phone)
    browser.call("Emulation.setTouchEmulationEnabled", enabled=phone)
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        stack.callback(os.chdir, Path.cwd())
        os.chdir(folder)
        is_bag = name == "go back in a bag"
        scene = stack.enter_context((bag_scene if is_bag else robot_scene)(folder))
        stack.enter_context(opened(browser, view=scene.view))
        browser.wait(f"robolink.layout.kind == '{'bag' if is_bag else 'camera'}' && robolink.layout.isReady")
        browser.js("robolink.connection.on('recording', ({messages}) => { robolink.recorded = messages; }) && 0")
        count = do(browser, errand.steps(way), phone=phone)
        assert errand.done(browser, scene)
        if errand.steps(way)[-1:] == [PULL]:
            let_go(browser, phone)
        browser.release("w")
    browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
    browser.resize(1280, 720)
    return count


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", ERRANDS)
def test_an_errand_takes_at_most_five_clicks(browser: Browser, name: str, way: str) -> None:
    assert do_errand(browser, name, way) <= MOST


def table() -> str:
    """The table of clicks, in Markdown."""
    lines = ["| errand | mouse | keyboard | phone |", "|---|---|---|---|"]
    for name, errand in ERRANDS.items():
        counts = (str(sum(each.cost for each in errand.steps(way))) for way in WAYS)
        lines.append(f"| {name} | {' | '.join(counts)} |")
    return "\n".join(lines) + "\n"


def test_the_manual_has_the_counts() -> None:
    manual = Path(__file__).parents[3] / "docs" / "reference" / "view.md"
    assert table() in manual.read_text(encoding="utf-8")


if __name__ == "__main__":
    sys.stdout.write(table())
