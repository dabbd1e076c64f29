"""The programs of a ROS 2 course run as they stand in its text, beside the simulated world.

The text is not a part of this repository: ../shared/course, or what ROBOLINK_COURSE names. Where it is absent
these tests are skipped. What it does with Webots runs in the simulated world, which reads its world file. Not run are
its programs that draw with matplotlib, which opens windows and is no dependency of robolink.
"""

from __future__ import annotations

import ast
import math
import os
import re
import shlex
from collections.abc import Iterator, Mapping
from contextlib import ExitStack
from pathlib import Path

import pytest

from robolink.sim import load_world
from robolink.testing import System
from robolink.workspace import find_world
from tests.support.commands import BUSY_ROBOLINK, Command
from tests.support.domains import free_domain
from tests.support.witness import Watched, watched

COURSE = Path(os.environ.get("ROBOLINK_COURSE") or Path(__file__).parents[3] / "shared" / "course")
TEXT = "\n".join(each.read_text(encoding="utf-8") for each in sorted(COURSE.glob("*.txt")))

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(not TEXT, reason=f"the course's text is not at {COURSE} (ROBOLINK_COURSE names another place)"),
]

LONGEST_GAP = 6
"""Of so many paragraphs at most, some may be Python only together with the next: a call's arguments, a docstring."""

PACKAGE = "meu_robo_py"
PACKAGE_XML = "<package format='3'><name>{name}</name><version>0.0.0</version></package>\n"
SETUP = "from setuptools import setup\n\nsetup(\n    name='{name}',\n    packages=['{name}'],\n    {entry_points}\n)\n"


# --- What is in the text ----------------------------------------------------------------------------------------------


def is_program(text: str) -> bool:
    """Whether this is Python that does something, and none of the prose around it."""
    try:
        statements = ast.parse(text).body
    except SyntaxError:
        return False
    words = any(isinstance(each, ast.Expr) and isinstance(each.value, ast.Name) for each in statements)
    calls = any(isinstance(node, ast.Call) for each in statements for node in ast.walk(each))
    return calls and not words


def programs(text: str) -> Iterator[str]:
    """The Python programs of a text that marks them by nothing: the longest runs of paragraphs that are Python."""
    paragraphs = re.split(r"\n\n+", text)
    at = 0
    while at < len(paragraphs):
        end, tried = at, at + 1
        while tried <= min(end + LONGEST_GAP, len(paragraphs)):
            if is_program("\n\n".join(paragraphs[at:tried])):
                end = tried
            tried += 1
        if end > at:
            yield "\n\n".join(paragraphs[at:end]) + "\n"
        at = max(end, at + 1)


PROGRAMS = list(programs(TEXT))
NODES = {
    found[1]: text for text in PROGRAMS if "import rclpy" in text and (found := re.search(r"__init__\('(\w+)'\)", text))
}
"""By node name: the rclpy program."""

WEBOTS_WORLD = "meu_mundo.wbt"
found_world = re.search(r"^#VRML_SIM.*?^}$(?=\n\nController)", TEXT, re.MULTILINE | re.DOTALL)
WEBOTS = found_world[0] + "\n" if found_world else ""
"""The world that the text has its readers save as meu_mundo.wbt."""

PLAIN = [text for text in PROGRAMS if "import rclpy" not in text and "print(" in text and "matplotlib" not in text]
COMMANDS = [shlex.split(each) for each in re.findall(r"^ros2 (.*)$", TEXT, re.MULTILINE)]


def commands(*beginning: str) -> list[list[str]]:
    """What the text types after `ros2`, where it begins so."""
    return [each for each in COMMANDS if tuple(each[: len(beginning)]) == beginning]


def test_the_text_has_the_programs_that_these_tests_know() -> None:
    assert sorted(NODES) == [
        "controle_reativo",
        "primeiro_node",
        "robo_publisher",
        "seguidor_parede",
        "sensor_subscriber",
        "webots_controller",
    ]
    assert len(PLAIN) >= 4


# --- Running it -------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A colcon workspace as the course makes it, with its package and all its nodes."""
    top, name = tmp_path_factory.mktemp("ros2_ws"), PACKAGE
    folder = top / "src" / name
    (folder / name).mkdir(parents=True)
    (folder / name / "__init__.py").touch()
    (folder / "package.xml").write_text(PACKAGE_XML.format(name=name))
    entry_points = re.search(r"^entry_points=\{.*?^\},$", TEXT, re.MULTILINE | re.DOTALL)
    assert entry_points
    (folder / "setup.py").write_text(SETUP.format(name=name, entry_points=entry_points[0]), encoding="utf-8")
    for node, text in NODES.items():
        (folder / name / f"{node}.py").write_text(text, encoding="utf-8")
    (top / WEBOTS_WORLD).write_text(WEBOTS, encoding="utf-8")
    return top


class Scene:
    """A simulated world, somebody who watches its robot, and the nodes of the course that run beside them."""

    def __init__(self, stack: ExitStack, folder: Path, world: str, *nodes: str) -> None:
        self._stack, self._folder = stack, folder
        self.domain = stack.enter_context(free_domain())
        self.robot: Watched = stack.enter_context(watched(self.domain))
        self.run("run", "world", "-p", f"world:={world}")
        self.nodes = [self.run("run", f"src/{PACKAGE}/{PACKAGE}/{each}.py") for each in nodes]

    def run(self, *arguments: str) -> Command:
        """Run a command of robolink in the workspace."""
        return self._stack.enter_context(Command(self.domain, *arguments, merged=True, folder=self._folder))


SCENES = {
    "drive": ("classroom", "robo_publisher", "sensor_subscriber"),
    "react": ("classroom", "controle_reativo"),
    "follow": ("classroom", "seguidor_parede"),
    "command": ("classroom",),
    "webots": (WEBOTS_WORLD, "webots_controller"),
}


@pytest.fixture(scope="module")
def scenes(workspace: Path) -> Iterator[Mapping[str, Scene]]:
    """All scenes, which go on at the same time."""
    with ExitStack() as stack:
        yield {name: Scene(stack, workspace, *each) for name, each in SCENES.items()}


def ends_quietly(*nodes: Command) -> None:
    """Press Ctrl-C; nothing but what the program says has been printed."""
    for each in nodes:
        each.interrupt()
    for each in nodes:
        assert each.end() == 0
        assert [line.text for line in each.lines if not re.match(r"\[(INFO|WARN)\] ", line.text)] == []


def drives(robot: Watched) -> None:
    """Wait until the robot has gone a way."""
    there = robot.find(lambda each: each.speed > 0.2)
    robot.find(lambda each: math.dist(each[1:3], there[1:3]) > 0.3)


def test_the_first_node_counts(scenes: Mapping[str, Scene], workspace: Path) -> None:
    (run,), (node_list,) = commands("run", PACKAGE, "primeiro_node"), commands("node", "list")
    with free_domain() as domain, Command(domain, *run, merged=True, folder=workspace) as node:
        node.wait_for("[primeiro_node]: Primeiro Node inicializado!")
        node.wait_for("Contador: 1")
        with Command(domain, *node_list, program=BUSY_ROBOLINK) as listed:
            assert listed.end() == 0
            assert [line.text for line in listed.lines] == ["/primeiro_node"]
        node.wait_for("Contador: 2")
        ends_quietly(node)


def test_the_publisher_drives_and_the_subscriber_sees(scenes: Mapping[str, Scene]) -> None:
    publisher, subscriber = scenes["drive"].nodes
    for speed in ("0.00", "0.10", "0.20", "0.30"):
        publisher.wait_for(f"Publicado: linear={speed}, angular=0.00")
    subscriber.wait_for("Caminho livre. Mínimo: ")
    drives(scenes["drive"].robot)
    ends_quietly(publisher, subscriber)


def test_the_reactive_controller_drives_until_something_is_near(scenes: Mapping[str, Scene]) -> None:
    (controller,) = scenes["react"].nodes
    controller.wait_for("Caminho livre - Andando...")
    drives(scenes["react"].robot)
    controller.wait_for("m - Girando!")
    ends_quietly(controller)


def test_the_wall_follower_drives(scenes: Mapping[str, Scene]) -> None:
    (follower,) = scenes["follow"].nodes
    follower.wait_for("Distância direita: ")
    drives(scenes["follow"].robot)
    ends_quietly(follower)


def farthest_of_the_walls(world: str, path: list[tuple[float, float]]) -> float:
    """How far in metres a way keeps from that point of a world's first wall, a closed one, that it leaves out most."""
    corners = load_world(find_world(world)).walls[0].polyline
    points = [
        ((1 - part / 10) * x1 + part / 10 * x2, (1 - part / 10) * y1 + part / 10 * y2)
        for (x1, y1), (x2, y2) in zip(corners, (*corners[1:], corners[0]), strict=True)
        for part in range(10)
    ]
    return max(min(math.dist(point, place) for place in path) for point in points)


@pytest.mark.parametrize(("world", "comes_round"), [("classroom", True), ("corners", False)])
def test_the_wall_follower_comes_round_every_wall_of_the_classroom(
    world: str, comes_round: bool, workspace: Path, system: System
) -> None:
    """It takes the first quarter of its ranges for its right side: so it is with 180 degrees, and not with 360."""
    system.start("world", parameters={"world": world})
    truths = system.messages("ground_truth")
    system.start(workspace / "src" / PACKAGE / PACKAGE / "seguidor_parede.py")
    system.run(240.0)
    path = [(each.pose.pose.position.x, each.pose.pose.position.y) for each in truths]
    assert (farthest_of_the_walls(world, path) < 1.0) is comes_round
    assert system.robot().driven > 50.0
    assert system.robot().contacts == 0


def test_what_the_course_types_works_with_robolink_in_ros2s_place(scenes: Mapping[str, Scene]) -> None:
    (pub,), scene = commands("topic", "pub"), scenes["command"]
    assert "ros2 topic list" in TEXT
    scene.robot.find(lambda each: True)
    driver = scene.run(*pub)
    drives(scene.robot)
    topics = scene.run("topic", "list")
    assert topics.end() == 0
    assert {"/cmd_vel", "/odom", "/scan"} <= {line.text for line in topics.lines}
    driver.interrupt()
    driver.end()
    assert "Traceback" not in "".join(line.text for line in driver.lines)


def test_the_webots_controller_turns_the_motors_of_its_world(scenes: Mapping[str, Scene]) -> None:
    (controller,), (pub,) = scenes["webots"].nodes, commands("topic", "pub")
    assert f"webots {WEBOTS_WORLD}" in TEXT
    controller.wait_for("[webots_controller]: Webots controller iniciado!")
    driver = scenes["webots"].run(*pub)
    controller.wait_for("Motores: E=0.50, D=0.50")
    robot = scenes["webots"].robot
    turning = robot.find(lambda each: each.speed > 0.05)
    ahead = robot.find(lambda each: each.x > turning.x + 0.1)
    assert abs(ahead.y) < 0.001
    assert max(each.speed for each in robot.samples) < 0.1  # the motors' speed, not the one that cmd_vel asks for
    driver.interrupt()
    driver.end()
    ends_quietly(controller)
    robot.wait(lambda each: each.speed < 0.001)
