"""robolink component: containers are listed, and nodes are loaded into them and taken out."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.main import main
from robolink.interfaces.composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from robolink.parameter import Parameter
from robolink.testing import System
from robolink.workspace import VARIABLE
from tests.support.domains import free_domain
from tests.support.ros_tree import write_package
from tests.support.seen_by_commands import a_node_that_commands_see, spinning

Captured = pytest.CaptureFixture[str]
CONTAINER = "/ComponentManager"
MAKER = """
from rclpy.node import Node


class Broken(Node):
    def __init__(self):
        super().__init__("broken")
        raise RuntimeError("no camera")
"""


# --- a container ------------------------------------------------------------------------------------------------------


@pytest.fixture
def system(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[System]:
    """A system with a container, in a workspace with a package whose node cannot be made."""
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setattr(sys, "argv", list(sys.argv))
    write_package(tmp_path / "src", "pkg_broken", {"broken.py": MAKER})
    monkeypatch.chdir(tmp_path)
    with System() as made:
        made.start("rclcpp_components component_container")
        yield made


def load(system: System, package: str, plugin: str, **fields: Any) -> LoadNode.Response:
    request = LoadNode.Request(package_name=package, plugin_name=plugin, **fields)
    answer: LoadNode.Response = system.call(LoadNode, f"{CONTAINER}/_container/load_node", request)
    return answer


def test_nodes_are_loaded_named_and_taken_out(system: System) -> None:
    rate = Parameter("unread", value=[1, 2]).to_parameter_msg()
    first = load(
        system, "demo_nodes_py", "talker", node_namespace="lab", remap_rules=["chatter:=words"], parameters=[rate]
    )
    second = load(system, "demo_nodes_cpp", "demo_nodes_cpp::Listener", node_name="ear", log_level=20)
    assert (first.success, first.unique_id, first.full_node_name) == (True, 1, "/lab/talker")
    assert (second.success, second.unique_id, second.full_node_name) == (True, 2, "/ear")
    assert system.expect("/lab/words", lambda text: "1" in text.data, within=3.0)
    listed = system.call(ListNodes, f"{CONTAINER}/_container/list_nodes")
    assert (list(listed.unique_ids), list(listed.full_node_names)) == ([1, 2], ["/lab/talker", "/ear"])
    taken = system.call(UnloadNode, f"{CONTAINER}/_container/unload_node", UnloadNode.Request(unique_id=1))
    assert (taken.success, system.nodes) == (True, [CONTAINER, "/ear"])
    again = system.call(UnloadNode, f"{CONTAINER}/_container/unload_node", UnloadNode.Request(unique_id=1))
    assert (again.success, again.error_message) == (False, "no node has the number 1")


def test_a_component_is_found_by_its_own_name(system: System) -> None:
    answer = load(
        system, "composition", "composition::Talker"
    )  # a package of components, which has no executables here
    assert (answer.error_message, answer.full_node_name) == ("", "/talker")


@pytest.mark.parametrize(
    ("package", "plugin", "reason"),
    [
        ("demo_nodes_py", "tlker", "did you mean 'talker'?"),
        ("compositor", "compositor::Talker", "no package named 'compositor'"),
        pytest.param(
            *("rviz2", "rviz2", "shares no process: ros_programs.py is run by a function (rviz2)"),
            marks=pytest.mark.annex("view"),
        ),
        ("pkg_broken", "broken", "RuntimeError: no camera"),
    ],
)
def test_what_cannot_be_loaded_leaves_the_container_running(
    package: str, plugin: str, reason: str, system: System
) -> None:
    answer = load(system, package, plugin)
    assert (answer.success, reason in answer.error_message) == (False, True)
    assert system.nodes == [CONTAINER]
    assert load(system, "demo_nodes_py", "talker").success


# --- the commands -----------------------------------------------------------------------------------------------------


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[LoadNode.Request]]:
    """The container /lab/robot of another process, and what it is asked to load."""
    requests: list[LoadNode.Request] = []

    def on_load(request: LoadNode.Request, response: LoadNode.Response) -> LoadNode.Response:
        requests.append(request)
        response.success, response.unique_id = request.plugin_name == "talker", 7
        response.full_node_name, response.error_message = "/talker", "no such thing"
        return response

    def on_unload(request: UnloadNode.Request, response: UnloadNode.Response) -> UnloadNode.Response:
        response.success, response.error_message = request.unique_id == 7, "no such number"
        return response

    def on_list(_: ListNodes.Request, response: ListNodes.Response) -> ListNodes.Response:
        response.unique_ids, response.full_node_names = [7], ["/talker"]
        return response

    with a_node_that_commands_see(monkeypatch) as node:
        node.create_service(LoadNode, "~/_container/load_node", on_load)
        node.create_service(UnloadNode, "~/_container/unload_node", on_unload)
        node.create_service(ListNodes, "~/_container/list_nodes", on_list)
        with spinning(node):
            yield requests


@pytest.mark.parametrize(
    ("words", "out"),
    [
        ("list", "/lab/robot\n  7  /talker\n"),
        ("list /lab/robot", "7  /talker\n"),
        ("list --containers-only", "/lab/robot\n"),
        ("load /lab/robot demo talker", "Loaded component 7 into '/lab/robot' container node as '/talker'\n"),
        ("load /lab/robot demo talker -q", "7\n"),
        ("unload /lab/robot 7", "Unloaded component 7 from '/lab/robot' container node\n"),
    ],
)
@pytest.mark.usefixtures("asked")
def test_what_the_commands_say(words: str, out: str, capsys: Captured) -> None:
    assert main(["component", *words.split()]) == 0
    assert capsys.readouterr() == (out, "")


def test_all_that_is_asked_for_is_sent(asked: list[LoadNode.Request]) -> None:
    words = (
        "load lab/robot demo talker -n ear --node-namespace /ns -r a:=b -p rate:=2.5 -e threads:=true --log-level warn"
    )
    assert main(["component", *words.split()]) == 0
    (request,) = asked
    assert (request.package_name, request.node_name, request.node_namespace) == ("demo", "ear", "/ns")
    assert (list(request.remap_rules), request.log_level) == (["a:=b"], 30)
    given = [*request.parameters, *request.extra_arguments]
    read: list[Parameter[Any]] = [Parameter.from_parameter_msg(each) for each in given]
    assert [(each.name, each.value) for each in read] == [("rate", 2.5), ("threads", True)]


@pytest.mark.parametrize(
    ("words", "report"),
    [
        ("list /lab/robo", "(did you mean '/lab/robot'?)"),
        ("load /lab/robot demo tlker", "/lab/robot did not load demo tlker: no such thing"),
        ("load /lab/robot demo talker -p rate", "'rate' is not a parameter: expected NAME:=VALUE"),
        ("unload /lab/robot 8", "/lab/robot did not unload 8: no such number"),
        ("types no_such_package", "no package named 'no_such_package'"),
    ],
)
@pytest.mark.usefixtures("asked")
def test_what_fails_is_one_line(words: str, report: str, capsys: Captured) -> None:
    assert main(["component", *words.split()]) == 1
    err = capsys.readouterr().err
    assert (report in err, err.count("\n")) == (True, 1)


def test_types_are_nodes_that_can_share_a_process(capsys: Captured) -> None:
    assert main(["component", "types", "demo_nodes_cpp"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "demo_nodes_cpp"
    assert "  talker" in lines
    assert "  add_two_ints_client" not in lines  # it is a main()


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="a process there gets no SIGINT from another one")
def test_a_component_runs_in_a_container_of_its_own_until_it_is_interrupted() -> None:
    with free_domain() as domain:
        environ = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
        words = ["demo_nodes_py", "talker", "-n", "ada", "-r", "chatter:=said", "-c", "alone"]
        command = [sys.executable, "-m", "robolink", "component", "standalone"]
        with subprocess.Popen([*command, *words], env=environ, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            assert process.stdout.readline() == "Loaded component 1 into 'alone' container node as '/ada'\n"
            process.send_signal(signal.SIGINT)
            assert process.wait(20) == 0
        refused = subprocess.run(
            [*command, "demo_nodes_py", "tlker", "-c", "alone"],
            env=environ,
            capture_output=True,
            text=True,
            check=False,
        )
    reason = "no executable named 'tlker' in package demo_nodes_py (did you mean 'talker'?)"
    assert refused.stderr.endswith(f"robolink: /alone did not load demo_nodes_py tlker: {reason}\n")
    assert (refused.returncode, refused.stdout) == (1, "")
