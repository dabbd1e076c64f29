"""The commands of a ROS 2 course, typed in its order with `shim ros2` and `shim colcon`, end with 0.

What a reader types differently is in the table of the page about the course, which is read here. As in test_course.py
the text is not a part of this repository.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from robolink.cli.main import main
from tests.rclpy.test_course import NODES, PACKAGE, PLAIN, PROGRAMS, TEXT, WEBOTS, WEBOTS_WORLD, pytestmark
from tests.support.commands import Command
from tests.support.domains import free_domain
from tools.docs_site.pages import DOCS

pytestmark = [
    *pytestmark,
    pytest.mark.skipif(sys.platform == "win32", reason="the course's commands are bash's"),
]
PAGE = DOCS / "learn/ros2_course.md"
FIRST_WORDS = "sudo|wget|pip|python3?|cd|mkdir|source|echo|ros2|colcon|webots|rm|robo_env"
TYPED = re.findall(rf"^(?:{FIRST_WORDS})\b.*", TEXT, re.MULTILINE)
OTHERWISE = re.findall(r"^\| (`.*`) \| (.*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
"""Rows of the page's table: what the course types, in one or more code spans, and what is typed instead."""
OF_PYTHON = re.compile(r"pip install|python3? -m venv|source robo_env|cd C:|robo_env")
"""Commands that make an environment of Python: robolink is installed in one already."""


def instead(line: str) -> str:
    """Return the command that the page has its reader type for a line of the course; '' for none."""
    for shown, typed in OTHERWISE:
        for each in re.findall("`(.+?)`", shown):
            pattern = re.escape(each).replace(re.escape("..."), ".*")
            if re.fullmatch(pattern, line):
                return line if "same" in typed else "".join(re.findall("`(.+?)`", typed))
    return line


LINES = [typed for each in TYPED if not OF_PYTHON.match(each) and (typed := instead(each))]


def test_the_text_types_what_this_test_knows() -> None:
    assert LINES == [
        "python --version",
        "pip --version",
        "mkdir -p ~/robotica",
        "cd ~/robotica",
        "ros2 --help",
        "mkdir -p ~/ros2_ws/src",
        "cd ~/ros2_ws/src",
        "ros2 pkg create --build-type ament_python meu_robo_py",
        "cd meu_robo_py",
        "cd ~/ros2_ws",
        "colcon build --packages-select meu_robo_py",
        "source install/setup.bash",
        "ros2 run meu_robo_py primeiro_node",
        "robolink run world -p world:=meu_mundo.wbt",
        "source ~/ros2_ws/install/setup.bash",
        "ros2 run meu_robo_py webots_controller",
        'ros2 topic pub /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.5}, angular: {z: 0.0}}"',
        "cd ~/ros2_ws",
        "rm -rf build install log",
        "colcon build",
        "ros2 node list",
        "echo $ROS_DOMAIN_ID",
    ]


class Terminal:
    """A shell with a folder and variables, which each line finds as the one before left them."""

    def __init__(self, stack: ExitStack, domain: int, home: Path, scripts: Path) -> None:
        self.stack, self.domain, self.home, self.state = stack, domain, home, home / f".state{id(self)}"
        found = os.pathsep.join([str(scripts), str(Path(sys.executable).parent), os.environ["PATH"]])
        fonts = os.environ.get("MPLCONFIGDIR", str(Path.home() / ".cache/matplotlib"))  # to list them takes seconds
        self.environ = {"HOME": str(home), "PATH": found, "MPLBACKEND": "Agg", "MPLCONFIGDIR": fonts}
        self.state.write_text(f"cd {shlex.quote(str(home))}\n", encoding="utf-8")

    def start(self, line: str) -> Command:
        """Type a line that goes on until Ctrl-C."""
        return self._typed(f"{self._before()} exec {line}")

    def enter(self, line: str) -> str:
        """Type a line that ends, with 0; return what it prints."""
        state = shlex.quote(str(self.state))
        keep = f"keep() {{ local code=$?; {{ printf 'cd %q\\n' \"$PWD\"; export -p; }} > {state}; exit $code; }}"
        command = self._typed(f"{self._before()} {keep}; trap keep EXIT; {line}")
        code = command.end()
        printed = "\n".join(each.text for each in command.lines)
        assert code == 0, f"'{line}' ended with {code}: {printed}"
        return printed

    def _before(self) -> str:
        return f". {shlex.quote(str(self.state))};"

    def _typed(self, script: str) -> Command:
        program = ("bash", "-c", script)
        return self.stack.enter_context(
            Command(self.domain, program=program, merged=True, folder=self.home, environ=self.environ)
        )


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Terminal]:
    home, scripts = tmp_path / "josé da silva", tmp_path / "bin"
    for each in (home, scripts):
        each.mkdir()
    for name in ("ros2", "colcon"):
        assert main(["shim", name, "--folder", str(scripts)]) == 0
    (scripts / "robolink").symlink_to(shutil.which("robolink", path=Path(sys.executable).parent) or "")
    with ExitStack() as stack, free_domain() as domain:
        yield Terminal(stack, domain, home, scripts)


def save_programs(package: Path) -> None:
    """Save the course's programs where it says, and add its entry points to setup.py."""
    for name, text in NODES.items():
        (package / PACKAGE / f"{name}.py").write_text(text, encoding="utf-8")
    entry_points = re.search(r"^entry_points=\{.*?^\},$", TEXT, re.MULTILINE | re.DOTALL)
    assert entry_points
    setup = (package / "setup.py").read_text(encoding="utf-8")
    text, count = re.subn(r"^ *entry_points=\{.*?^    \},$", entry_points[0], setup, flags=re.MULTILINE | re.DOTALL)
    assert count == 1
    (package / "setup.py").write_text(text, encoding="utf-8")


def ends_at_ctrl_c(command: Command) -> None:
    command.interrupt()
    assert command.end() == 0, command.lines


def test_the_course_runs_from_its_first_line_to_its_last(terminal: Terminal) -> None:
    left = list(LINES)
    others = [Terminal(terminal.stack, terminal.domain, terminal.home, Path()) for _ in range(2)]
    for other in others:
        other.environ = terminal.environ
    simulator, commander = others

    def until(last: str) -> None:
        """Type the course's lines up to this one."""
        while left:
            terminal.enter(line := left.pop(0))
            if line == last:
                return
        raise AssertionError(f"the course does not type '{last}'")

    until("cd meu_robo_py")
    save_programs(terminal.home / "ros2_ws/src" / PACKAGE)
    until("source install/setup.bash")
    node = terminal.start(left.pop(0))
    node.wait_for("[primeiro_node]: Olá do ROS 2! Contador: 1")
    ends_at_ctrl_c(node)

    (terminal.home / WEBOTS_WORLD).write_text(WEBOTS, encoding="utf-8")
    world = simulator.start(left.pop(0))
    terminal.enter("cd ~")  # a terminal that was opened for this: only what it sources tells where the package is
    until("source ~/ros2_ws/install/setup.bash")
    controller = terminal.start(left.pop(0))
    driver = commander.start(left.pop(0))
    controller.wait_for("Motores: E=0.50, D=0.50")
    until("colcon build")
    while "/webots_controller" not in terminal.enter("ros2 node list").splitlines():
        pass
    until("ros2 node list")
    assert terminal.enter(left.pop(0)) == str(terminal.domain)
    assert left == []
    driver.interrupt()
    assert driver.end() == 130  # as shells count: it would have gone on for ever
    for each in (controller, world):
        ends_at_ctrl_c(each)


def test_its_other_programs_run_beside_the_world_that_the_page_names_first(terminal: Terminal) -> None:
    shown = re.search(r"^robolink run world -p world:=(\w+)$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    assert shown
    terminal.enter("ros2 pkg create --build-type ament_python meu_robo_py > /dev/null")
    save_programs(terminal.home / PACKAGE)
    world = terminal.start(shown[0])
    world.wait_for("")
    words = {
        "controle_reativo": "Caminho livre",
        "robo_publisher": "linear=0.20",
        "seguidor_parede": "Distância direita",
        "sensor_subscriber": "Caminho livre",
    }
    assert {*words, "primeiro_node", "webots_controller"} == set(NODES)
    nodes = {name: terminal.start(f"ros2 run {PACKAGE} {name}") for name in words}
    for name, node in nodes.items():
        node.wait_for(words[name])
    for each in (*nodes.values(), world):
        ends_at_ctrl_c(each)


OF_PYTHON_ALONE = [each for each in PROGRAMS if each in PLAIN or ("matplotlib" in each and "rclpy" not in each)]


@pytest.mark.parametrize("number", range(len(OF_PYTHON_ALONE)))
def test_its_exercises_without_ros_run_in_both_ways(number: int, terminal: Terminal) -> None:
    text = OF_PYTHON_ALONE[number]
    if "matplotlib" in text:
        pytest.importorskip("matplotlib")
    (terminal.home / "exercicio.py").write_text(text, encoding="utf-8")
    printed = {terminal.enter(f"{each} exercicio.py") for each in ("python", "robolink run")}
    assert len(printed) == 1
    assert printed.pop()
