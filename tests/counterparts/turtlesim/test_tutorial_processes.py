"""The first of ROS 2's tutorials, and the one about bags, in processes: keys of a terminal, remaps, record and play."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.cli.main import main
from robolink.interfaces.turtlesim.msg import Pose
from robolink.interfaces.turtlesim.srv import Spawn
from tests.support.commands import PATIENCE, ROBOLINK, TERMINAL, Command
from tests.support.seen_by_commands import made, spinning
from tests.support.waits import wait_until

pytestmark = [pytest.mark.processes, pytest.mark.skipif(sys.platform == "win32", reason="terminals of Linux and macOS")]

CENTRE = 5.544444561004639
UP, LEFT = "\x1b[A", "\x1b[D"


class Watcher:
    """A node that knows where the turtles are."""

    def __init__(self, node: Node) -> None:
        self.node = node
        self.poses: dict[str, Pose] = {}
        for name in ("turtle1", "turtle2"):
            node.create_subscription(Pose, f"/{name}/pose", lambda pose, name=name: self.poses.update({name: pose}), 10)

    def place(self, name: str) -> tuple[float, float]:
        """Where a turtle is, once it stands."""
        wait_until(lambda: name in self.poses and self.poses[name].linear_velocity == 0.0)
        return self.poses[name].x, self.poses[name].y

    def wait_for_a_move(self, name: str, start: tuple[float, float]) -> None:
        wait_until(lambda: abs(self.poses[name].x - start[0]) + abs(self.poses[name].y - start[1]) > 1.0)


@pytest.fixture
def watcher(domain: int) -> Iterator[Watcher]:
    context = Context()
    context.init(args=[], initialize_logging=False, domain_id=domain)
    with context:
        node = made(context, "watcher")
        found = Watcher(node)
        with spinning(node):
            yield found


@pytest.fixture
def run(domain: int, tmp_path: Path) -> Iterator[Any]:
    """Run commands, until the end of the test, in a folder of its own; with keys on a terminal."""
    with ExitStack() as stack:

        def begin(line: str, keys: bool = False) -> Command:
            program = (sys.executable, "-c", TERMINAL, *ROBOLINK) if keys else ROBOLINK
            command = Command(domain, *shlex.split(line), program=program, has_input=keys, merged=True, folder=tmp_path)
            return stack.enter_context(command)

        yield begin


def test_turtlesim_is_driven_by_keys(run: Any, watcher: Watcher) -> None:
    turtlesim = run("run turtlesim turtlesim_node")
    teleop = run("run turtlesim turtle_teleop_key", keys=True)
    turtlesim.wait_for("[turtlesim]: Starting turtlesim with node name /turtlesim")
    turtlesim.wait_for("Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]")
    turtlesim.wait_for("see the turtles in a browser: http://127.0.0.1:")
    teleop.wait_for("Reading from keyboard")
    teleop.wait_for("'Q' to quit.")
    spawn = watcher.node.create_client(Spawn, "/spawn")
    assert spawn.wait_for_service(PATIENCE)
    answer = spawn.call(Spawn.Request(x=1.0, y=1.0, name="turtle2"), timeout_sec=PATIENCE)
    assert answer is not None
    assert answer.name == "turtle2"

    second = run("run turtlesim turtle_teleop_key --ros-args --remap turtle1/cmd_vel:=turtle2/cmd_vel", keys=True)
    second.wait_for("'Q' to quit.")
    wait_until(lambda: watcher.node.count_publishers("/turtle2/cmd_vel") == 1)
    assert watcher.place("turtle2") == (1.0, 1.0)
    second.press(UP)
    watcher.wait_for_a_move("turtle2", (1.0, 1.0))
    assert watcher.place("turtle1") == (CENTRE, CENTRE)
    teleop.press(UP)
    watcher.wait_for_a_move("turtle1", (CENTRE, CENTRE))

    for each in (teleop, second):
        each.press("q")
        assert each.end() == 0
    turtlesim.interrupt()
    assert turtlesim.end() == 0


def test_what_the_keys_did_is_recorded_and_played(
    run: Any, watcher: Watcher, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    turtlesim = run("run turtlesim turtlesim_node --ros-args --log-level WARN")
    teleop = run("run turtlesim turtle_teleop_key", keys=True)
    recorder = run("bag record -o subset /turtle1/cmd_vel /turtle1/pose")
    teleop.wait_for("'Q' to quit.")
    recorder.wait_for("Recording...")
    wait_until(lambda: watcher.node.count_subscribers("/turtle1/cmd_vel") == 2)
    start = watcher.place("turtle1")
    teleop.press(UP)
    watcher.wait_for_a_move("turtle1", start)
    end = watcher.place("turtle1")
    recorder.interrupt()
    assert recorder.end() == 0
    teleop.press("q")
    assert teleop.end() == 0

    assert main(["bag", "info", str(tmp_path / "subset")]) == 0
    told = capsys.readouterr().out
    assert "Topic: /turtle1/cmd_vel | Type: geometry_msgs/msg/Twist | Count: 1 | Serialization Format: cdr" in told
    assert "Topic: /turtle1/pose | Type: turtlesim/msg/Pose | Count: " in told
    run("bag play subset")
    watcher.wait_for_a_move("turtle1", end)
    turtlesim.interrupt()
    assert turtlesim.end() == 0
    assert not [line for line in turtlesim.lines if "[INFO]" in line.text]
