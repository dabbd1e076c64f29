"""robolink interface: ros2's lists, texts and prototypes; types of the workspace, and of nodes that run."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from robolink import Node, type_lookup
from robolink.cli.interface import _escaped
from robolink.cli.interface.show import prototype
from robolink.documents.yamlfile import parse as read_yaml
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces import KINDS, find, names
from robolink.message import from_builtins, type_hash
from robolink.message.building import build
from robolink.message.definition import parse
from tests.support.seen_by_commands import a_node_that_commands_see, made
from tests.support.shown_types import Workspace, refused, shown

Captured = pytest.CaptureFixture[str]


# --- Lists --------------------------------------------------------------------------------------------------------


def test_list_has_ros2s_sections(workspace: Workspace, capsys: Captured) -> None:
    found = shown(capsys, "list").splitlines()
    assert [each for each in found if not each.startswith("    ")] == ["Messages:", "Services:", "Actions:"]
    for name in ("std_msgs/msg/String", "std_srvs/srv/SetBool", "lab_msgs/msg/Inner", "lab_msgs/action/Do"):
        assert f"    {name}" in found
    services = found[found.index("Services:") + 1 : found.index("Actions:")]
    assert services == sorted(services)


def test_list_of_some_kinds(workspace: Workspace, capsys: Captured) -> None:
    found = shown(capsys, "list", "-s", "-a")
    assert "/msg/" not in found
    assert found.startswith("Services:\n    ")
    assert shown(capsys, "list", "-m").startswith("Messages:\n    ")


def test_list_as_json(capsys: Captured) -> None:
    found = json.loads(shown(capsys, "list", "--json"))
    assert {key: set(names(kind)) for key, kind in zip(found, KINDS, strict=True)} == {
        k: set(v) for k, v in found.items()
    }
    assert list(found) == ["messages", "services", "actions"]


def test_packages(workspace: Workspace, capsys: Captured) -> None:
    every = shown(capsys, "packages").splitlines()
    assert every == sorted(set(every))
    assert {"std_msgs", "std_srvs", "lab_msgs"} <= set(every)
    assert "std_msgs" not in shown(capsys, "packages", "-s").splitlines()
    assert "std_srvs" in json.loads(shown(capsys, "packages", "-s", "--json"))


def test_a_package(workspace: Workspace, capsys: Captured) -> None:
    assert shown(capsys, "package", "lab_msgs") == "\n".join(
        ["lab_msgs/msg/Inner", "lab_msgs/msg/Outer", "lab_msgs/srv/Ask", "lab_msgs/action/Do", ""]
    )
    assert shown(capsys, "package", "lab_msgs", "--only-actions") == "lab_msgs/action/Do\n"
    assert shown(capsys, "package", "std_msgs", "-a") == ""
    assert json.loads(shown(capsys, "package", "lab_msgs", "-s", "--json")) == ["lab_msgs/srv/Ask"]


def test_an_unknown_package_gets_the_nearest(capsys: Captured) -> None:
    assert refused(capsys, "package", "std_msg") == (
        "robolink: no interface package named 'std_msg' (did you mean 'std_msgs'?)"
    )


# --- proto ------------------------------------------------------------------------------------------------------------


def test_proto_is_ros2s(capsys: Captured) -> None:
    twist = "linear:\n  x: 0.0\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 0.0\n"
    assert shown(capsys, "proto", "geometry_msgs/msg/Twist") == f'"{twist}"\n'
    assert shown(capsys, "proto", "Twist", "--no-quotes") == f"{twist}\n"


def test_proto_of_a_service_and_an_action_is_what_one_sends(workspace: Workspace, capsys: Captured) -> None:
    assert shown(capsys, "proto", "SetBool") == '"data: false\n"\n'
    assert shown(capsys, "proto", "lab_msgs/action/Do", "--no-quotes").startswith("outer:\n  inner:\n    flag: true\n")


def test_proto_masks_what_the_shell_would_take() -> None:
    assert _escaped('a "b" $HOME `c` \\') == 'a \\"b\\" \\$HOME \\`c\\` \\\\'


@pytest.mark.slow
def test_every_prototype_can_be_published() -> None:
    for name in names("msg"):
        cls = find(name)
        assert from_builtins(cls, read_yaml(prototype(cls), name=name)) == cls(), name


# --- Types that only a running node has ------------------------------------------------------------------------------


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as found:
        yield found


def custom(text: str, name: str) -> Any:
    """A type that nothing knows by name."""
    return build(parse(text, name), find)


@contextmanager
def spun(node: Node) -> Iterator[None]:
    """Spin a node in the background."""
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    try:
        yield
    finally:
        executor.shutdown()
        thread.join()


def test_a_message_type_that_only_a_running_node_has(robot: Node, capsys: Captured) -> None:
    wheels = custom("float64[<=4] speeds\nstd_msgs/Header header\n", "robot_msgs/msg/Wheels")
    node = Node("wheels", context=robot.context)
    node.create_publisher(wheels, "/wheels", 10)
    with spun(node):
        for name in ("robot_msgs/msg/Wheels", "robot_msgs/Wheels", "Wheels"):
            assert shown(capsys, "show", name).splitlines()[:3] == [
                "float64[<=4] speeds",
                "std_msgs/Header header",
                "\tbuiltin_interfaces/Time stamp",
            ]
        assert json.loads(shown(capsys, "show", "robot_msgs/Wheels", "--json"))["hash"] == type_hash(wheels)
        assert shown(capsys, "proto", "Wheels").startswith('"speeds: []\nheader:\n')


def test_a_service_type_that_only_a_running_node_has(robot: Node, capsys: Captured) -> None:
    node = Node("server", context=robot.context)
    node.create_service(custom("int8 a\n---\nint16 b\n", "robot_msgs/srv/Turn"), "/turn", lambda asked, given: given)
    with spun(node):
        assert shown(capsys, "show", "robot_msgs/srv/Turn") == "int8 a\n---\nint16 b\n"


def test_an_action_type_that_only_a_running_node_has(robot: Node, capsys: Captured) -> None:
    go = custom("int8 a\n---\nint16 b\n---\nint32 c\n", "robot_msgs/action/Go")
    node = Node("server", context=robot.context)
    node.create_service(go.Impl.SendGoalService, "/go/_action/send_goal", lambda asked, given: given)
    node.create_service(go.Impl.GetResultService, "/go/_action/get_result", lambda asked, given: given)
    node.create_publisher(go.Impl.FeedbackMessage, "/go/_action/feedback", 10)
    with spun(node):
        assert shown(capsys, "show", "robot_msgs/action/Go") == "int8 a\n---\nint16 b\n---\nint32 c\n"
        assert json.loads(shown(capsys, "show", "Go", "--json"))["hash"] == type_hash(go)


def test_a_type_that_no_running_node_has_is_unknown_all_the_same(robot: Node, capsys: Captured) -> None:
    assert "no type named 'Wheels'" in refused(capsys, "show", "Wheels")


def test_a_node_that_does_not_tell_its_type_is_named(
    robot: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(type_lookup, "ANSWER_WITHIN", 0.05)  # nobody spins it
    wheels = custom("float64 speed\n", "robot_msgs/msg/Wheels")
    silent = made(robot.context, "silent")
    silent.create_publisher(wheels, "/wheels", 10)
    assert "/silent" in refused(capsys, "show", "robot_msgs/msg/Wheels")


def test_without_a_network_an_unknown_type_is_only_unknown(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setenv("ROBOLINK_NETWORK", "/nowhere.json5")
    assert "no type named 'Wheels'" in refused(capsys, "show", "Wheels")
