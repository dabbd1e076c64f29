"""Nodes with a lifecycle in ROS 2's launch files: transitions are asked for, and what follows from them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.interfaces.lifecycle_msgs.srv import GetState
from robolink.testing import System
from tests.support.ros_launch import write

LIFE = """
import rclpy
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn


class Life(LifecycleNode):
    def __init__(self):
        super().__init__("life")
        self.declare_parameter("fails", False)

    def on_configure(self, state):
        fails = self.get_parameter("fails").value
        return TransitionCallbackReturn.FAILURE if fails else TransitionCallbackReturn.SUCCESS


def main():
    rclpy.init()
    rclpy.spin(Life())
"""

EVENTS = """
def ask(node, transition):
    return EmitEvent(event=launch_ros.events.lifecycle.ChangeState(
        lifecycle_node_matcher=events.matches_action(node), transition_id=transition))

def generate_launch_description():
    node = LifecycleNode(package="bot", executable="life", name="life", namespace="ns")
    return LaunchDescription([
        node,
        RegisterEventHandler(OnStateTransition(
            target_lifecycle_node=node, start_state="configuring", goal_state="inactive",
            entities=[LogInfo(msg="configured"), ask(node, 3)])),
        RegisterEventHandler(OnStateTransition(target_lifecycle_node=node, goal_state="active", handle_once=True,
            entities=[LogInfo(msg="active"), Node(package="bot", executable="talker")])),
        ask(node, 1),
    ])
"""


@pytest.fixture
def life(package: Path) -> Path:
    (package / "bot" / "life.py").write_text(LIFE)
    setup = package / "setup.py"
    setup.write_text(setup.read_text().replace("['talker", "['life = bot.life:main', 'talker"))
    return package


def state(system: System, node: str) -> str:
    """The state of a node with a lifecycle."""
    label: str = system.call(GetState, f"{node}/get_state").current_state.label
    return label


def test_events_lead_from_state_to_state(life: Path, system: System) -> None:
    system.launch(write(life, EVENTS))
    system.run(2.0)
    assert state(system, "/ns/life") == "active"
    system.expect("chatter")


def test_a_node_may_start_itself_and_go_through_transitions(life: Path, system: System) -> None:
    body = """
    LifecycleNode(package="bot", executable="life", name="auto", namespace="", autostart=True),
    LifecycleNode(package="bot", executable="life", name="still", namespace=""),
    LifecycleNode(package="bot", executable="life", name="led", namespace="ns"),
    LifecycleTransition(lifecycle_node_names=["/ns/led"], transition_ids=["configure", 3, TextSubstitution(text="4")]),
    """
    system.launch(write(life, body))
    system.run(2.0)
    assert state(system, "auto") == "active"
    assert state(system, "still") == "unconfigured"
    assert state(system, "/ns/led") == "inactive"


def test_what_a_node_refuses_is_told(life: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(
        life,
        """
        LifecycleNode(package="bot", executable="life", name="life", namespace="", autostart=True,
                      parameters=[{"fails": True}]),
        LifecycleTransition(lifecycle_node_names=["nobody"], transition_ids=[1]),
        """,
    )
    assert main(["simulate", "bot", "bot", "--duration", "15"]) == 0
    err = capsys.readouterr().err
    assert "/life did not make transition 1\n" in err
    assert "/nobody has no lifecycle yet: it is to make transition 1\n" in err


@pytest.mark.processes
def test_between_processes(life: Path) -> None:
    write(life, EVENTS)
    command = [sys.executable, "-m", "robolink", "launch", "bot", "bot.launch.py"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        lines = [process.stdout.readline() for _ in range(2)]
        process.terminate()
        process.communicate(timeout=30)
    assert lines == ["[launch] configured\n", "[launch] active\n"]
    assert process.returncode == 0
