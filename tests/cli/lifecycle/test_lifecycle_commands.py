"""lifecycle nodes, get, list and set: ros2's output, nodes that are none, that fail, and that do not answer."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import Context, Node
from robolink.cli.lifecycle import ask
from robolink.cli.main import main
from robolink.interfaces.lifecycle_msgs.srv import GetState
from robolink.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from tests.support.commands import BUSY_ROBOLINK, Command
from tests.support.programs import Program
from tests.support.seen_by_commands import a_node_that_commands_see, spinning

CONFIGURE = "- configure [1]\n\tStart: unconfigured\n\tGoal: configuring\n"
SHUTDOWN = "- shutdown [5]\n\tStart: unconfigured\n\tGoal: shuttingdown\n"

Captured = pytest.CaptureFixture[str]


class Camera(LifecycleNode):
    """Its lens cannot be cleaned."""

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        return TransitionCallbackReturn.FAILURE


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as node:
        yield node


@pytest.fixture
def camera(robot: Node) -> Iterator[Camera]:
    """The managed nodes /camera and /_lamp, beside /lab/robot, which is none."""
    camera, lamp = Camera("camera", context=robot.context), LifecycleNode("_lamp", context=robot.context)
    with spinning(camera, lamp):
        yield camera


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nodes"], "/camera\n"),
        (["nodes", "-a"], "/_lamp\n/camera\n"),
        (["nodes", "-c"], "1\n"),
        (["nodes", "-a", "-c"], "2\n"),
        (["nodes", "--json"], '["/camera"]\n'),
        (["get", "/camera"], "unconfigured [1]\n"),
        (["get", "camera"], "unconfigured [1]\n"),
        (["get"], "/camera: unconfigured [1]\n"),
        (["get", "--include-hidden-nodes"], "/_lamp: unconfigured [1]\n/camera: unconfigured [1]\n"),
        (["get", "/_lamp", "--include-hidden-nodes"], "unconfigured [1]\n"),
        (["get", "--json"], '{"/camera":{"id":1,"label":"unconfigured"}}\n'),
        (
            ["list", "/camera"],
            CONFIGURE + SHUTDOWN,
        ),
    ],
)
@pytest.mark.usefixtures("camera")
def test_what_ros2_prints(words: list[str], said: str, capsys: Captured) -> None:
    assert main(["lifecycle", *words]) == 0
    assert capsys.readouterr() == (said, "")


@pytest.mark.usefixtures("camera")
def test_all_transitions_of_a_node(capsys: Captured) -> None:
    assert main(["lifecycle", "list", "/camera", "-a"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 3 * 25
    assert lines[:6] == [
        "- configure [1]",
        "\tStart: unconfigured",
        "\tGoal: configuring",
        "- transition_success [10]",
        "\tStart: configuring",
        "\tGoal: inactive",
    ]
    assert lines[-3:] == ["- transition_error [62]", "\tStart: errorprocessing", "\tGoal: finalized"]
    assert main(["lifecycle", "list", "/camera", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0] == {
        "id": 1,
        "label": "configure",
        "start": "unconfigured",
        "goal": "configuring",
    }


@pytest.mark.usefixtures("camera")
def test_a_life(capsys: Captured) -> None:
    for transition, after in (("configure", "inactive [2]"), ("3", "active [3]"), ("deactivate", "inactive [2]")):
        assert main(["lifecycle", "set", "/camera", transition]) == 0
        assert main(["lifecycle", "get", "/camera"]) == 0
        assert capsys.readouterr() == (f"Transitioning successful\n{after}\n", "")
    assert main(["lifecycle", "set", "/camera", "cleanup"]) == 1
    assert capsys.readouterr() == (
        "",
        "robolink: Transitioning failed: /camera did not cleanup; it is inactive [2] now\n",
    )
    assert main(["lifecycle", "set", "/camera", "shutdown"]) == 0
    assert main(["lifecycle", "set", "/camera", "configure"]) == 1
    assert capsys.readouterr().err == ("robolink: Unknown transition 'configure' requested, available ones are: none\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["get", "/camra"], "no node named '/camra' in domain 7 (did you mean '/camera'?)"),
        (["list", "/lab/robot"], "/lab/robot is not managed: it does not serve /lab/robot/get_state"),
        (
            ["set", "/camera", "noop"],
            "Unknown transition 'noop' requested, available ones are: configure [1], shutdown [5]",
        ),
        (["set", "a\0\n", "configure"], r"no node named '/a\x00\n' in domain 7"),
        (["set", "/camera", "\x1b[2J"], r"Unknown transition '\x1b[2J' requested, available ones are: configure [1]"),
    ],
)
@pytest.mark.usefixtures("camera")
def test_what_cannot_be_is_one_line(words: list[str], said: str, capsys: Captured) -> None:
    assert main(["lifecycle", *words]) == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith(f"robolink: {said}")


def test_no_managed_nodes(robot: Node, capsys: Captured) -> None:
    assert main(["lifecycle", "nodes"]) == 0
    assert main(["lifecycle", "get"]) == 0
    assert capsys.readouterr() == ("", "")
    assert main(["lifecycle", "nodes", "-c"]) == 0
    assert capsys.readouterr() == ("0\n", "")


@pytest.mark.slow
def test_a_node_that_does_not_spin(robot: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    stuck, works = LifecycleNode("stuck", context=robot.context), LifecycleNode("works", context=robot.context)
    told = "robolink: no answer within {} s from /stuck/get_state: does the node spin?\n"
    with spinning(works):
        monkeypatch.setattr(ask._ask, "__defaults__", (2.0,))
        assert main(["lifecycle", "get"]) == 1
        assert capsys.readouterr() == ("/works: unconfigured [1]\n", told.format(2))
        monkeypatch.setattr(ask._ask, "__defaults__", (0.1,))
        assert main(["lifecycle", "get", "/stuck"]) == 1
        assert capsys.readouterr() == ("", told.format(0.1))
    stuck.destroy_node()


def test_a_server_that_has_gone_is_told_at_once(robot: Node, capsys: Captured) -> None:
    robot.create_service(GetState, "robot/get_state", lambda request, response: response)  # and nothing else of a node
    assert main(["lifecycle", "set", "/lab/robot", "configure"]) == 1
    assert capsys.readouterr() == (
        "",
        "robolink: service /lab/robot/get_available_transitions: nobody serves it, or the server went away\n",
    )


def test_a_node_of_another_domain_is_told(robot: Node, capsys: Captured) -> None:
    other = Context(transport=robot.context.transport.url)
    other.init([], domain_id=5)
    with other:
        LifecycleNode("far", context=other)
        assert main(["lifecycle", "get", "/far"]) == 1
    assert capsys.readouterr().err == (
        "robolink: no node named '/far' in domain 7; it is on domain 5: set ROS_DOMAIN_ID=5\n"
    )


PROGRAM = """
import robolink as rclpy
from robolink.lifecycle import Node

rclpy.init()
node = Node("camera")
print("up", flush=True)
rclpy.spin(node)
"""


@pytest.mark.processes
def test_a_process_is_configured_from_another(tmp_path: Path, domain: int) -> None:
    with Program(tmp_path, PROGRAM, domain) as program:
        assert program.line() == "up"
        for words, said in ((["nodes"], "/camera"), (["set", "/camera", "configure"], "Transitioning successful")):
            with Command(domain, "lifecycle", *words, program=BUSY_ROBOLINK) as command:
                assert command.end() == 0
            assert [each.text for each in command.lines] == [said]
        program.interrupt()
        assert (program.end(), program.errors) == (130, [])
