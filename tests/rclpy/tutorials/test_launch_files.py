"""ROS 2's tutorials on launch: the mimic in three languages, substitutions, event handlers and large projects."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.testing import System
from tests.support.commands import Command
from tests.support.tutorial_workspace import TutorialWorkspace

pytestmark = pytest.mark.annex("turtlesim")

TF2 = [
    f"{each} = learning_tf2_py.{each}:main"
    for each in ("turtle_tf2_broadcaster", "turtle_tf2_listener", "fixed_frame_tf2_broadcaster")
]
CIRCLE = Twist(linear=Vector3(x=2.0), angular=Vector3(z=-1.8))


@pytest.fixture
def tutorial(ros2_ws: TutorialWorkspace) -> TutorialWorkspace:
    """The workspace with the package launch_tutorial."""
    ros2_ws.create("launch_tutorial", data="launch config")
    return ros2_ws


@pytest.mark.usefixtures("tutorial")
@pytest.mark.parametrize("kind", ["py", "xml", "yaml"])
def test_one_turtle_mimics_another(system: System, kind: str) -> None:
    system.launch(f"launch_tutorial turtlesim_mimic_launch.{kind}")
    system.run(1.0)
    assert system.nodes == ["/mimic", "/turtlesim1/sim", "/turtlesim2/sim"]
    system.publish("/turtlesim1/turtle1/cmd_vel", CIRCLE)
    system.expect("/turtlesim2/turtle1/pose", lambda pose: pose.theta < -1.6, within=3.0)


def test_arguments_of_the_substitutions(tutorial: TutorialWorkspace) -> None:
    told = tutorial.ros2("ros2 launch launch_tutorial example_substitutions_launch.py --show-args")
    assert told == (
        "turtlesim_ns      (default: turtlesim1)\n"
        "use_provided_red  (default: False)\n"
        "new_background_r  (default: 200)\n"
    )


@pytest.mark.slow
def test_a_large_project(tutorial: TutorialWorkspace, system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    tutorial.create("learning_tf2_py", *TF2, data="launch")
    monkeypatch.setenv("USER", "me")
    system.launch("launch_tutorial launch_turtlesim_launch.py")
    system.expect_log("Successfully spawned turtle2")
    system.run(5.0)
    assert set(system.nodes) == {
        *("/sim", "/turtlesim2/sim", "/turtlesim3/sim", "/mimic"),
        *("/broadcaster1", "/broadcaster2", "/listener", "/me_fixed_broadcaster"),
    }
    for node, red in (("/sim", 0), ("/turtlesim2/sim", 150), ("/turtlesim3/sim", 150)):
        assert system.parameter(node, "background_r") == red
    assert system.parameter("/turtlesim3/sim", "background_g") == 240
    assert system.expect("/turtlesim2/turtle1/cmd_vel", lambda twist: twist.linear.x > 0.0, within=3.0)


@contextmanager
def launched(domain: int, *words: str) -> Iterator[Command]:
    with Command(domain, "launch", "launch_tutorial", *words, merged=True) as command:
        yield command
        command.interrupt()
        assert command.end() == 0


@pytest.mark.processes
@pytest.mark.usefixtures("tutorial")
@pytest.mark.skipif(sys.platform == "win32", reason="shells of Linux and macOS")
def test_substitutions(domain: int) -> None:
    with launched(domain, "example_main_launch.py") as command:
        command.wait_for("turtlesim.srv.Spawn_Response(name='turtle2')")
        command.wait_for("[ros2-3] Set parameter successful")


@pytest.mark.processes
@pytest.mark.usefixtures("tutorial")
@pytest.mark.skipif(sys.platform == "win32", reason="shells of Linux and macOS")
def test_event_handlers(domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("USER", "me")
    words = ("turtlesim_ns:=turtlesim3", "use_provided_red:=True", "new_background_r:=200")
    with launched(domain, "example_event_handlers_launch.py", *words) as command:
        command.wait_for("Turtlesim started, spawning turtle")
        command.wait_for("Spawn request says \"turtlesim.srv.Spawn_Response(name='turtle2')\"")
        command.wait_for("Spawn finished")
        command.wait_for("[ros2-2] Set parameter successful")
        command.wait_for("[ros2-3] Set parameter successful")
    told = [line.text for line in command.lines]
    assert any(line.startswith("[launch] Launch was asked to shutdown: ") for line in told)
    assert "[launch] me closed the turtlesim window" in told
