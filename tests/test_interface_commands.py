"""robolink interface: ros2's lists, texts and prototypes; types of the workspace, and of nodes that run."""

from __future__ import annotations

import functools
import io
import json
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node, type_lookup
from robolink.cli import main
from robolink.cli.interface import _escaped
from robolink.cli.interface.show import _without_comment, as_data, lines, prototype
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces import KINDS, find, names
from robolink.message import from_builtins, text, type_hash
from robolink.message.building import build
from robolink.message.definition import parse
from robolink.workspace import VARIABLE
from robolink.yamlfile import parse as read_yaml
from tests.seen_by_commands import a_node_that_commands_see, made

Captured = pytest.CaptureFixture[str]
Workspace = Callable[[str, str], None]

INNER = """\
# A short type

# A constant
bool BOOL_CONST=true  # is true

# Fields
bool flag true
string<=5 label "a # b"  # the label
bool[<=3] flags  # three at most
"""
OUTER = """\
# A type with another in it

Inner inner  # Comment - 1 of 1
float64[2] pair [0.5, 1.5]
# The end
"""
ASK = "# Request\nInner inner  # asked\n---\n# Response\nbool done  # answered\n"
DO = "# Goal\nOuter outer\n---\nint32 code\n---\nfloat32 progress  # 0 to 1\n"


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Workspace:
    """Write an interface file of the package lab_msgs, in a workspace that is the working directory."""
    (tmp_path / "nodes").mkdir()
    (tmp_path / "configs").mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://nobody")

    def write(name: str, text: str) -> None:
        path = tmp_path / "interfaces" / "lab_msgs" / name.rpartition(".")[2] / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    write("Inner.msg", INNER)
    write("Outer.msg", OUTER)
    write("Ask.srv", ASK)
    write("Do.action", DO)
    return write


def shown(capsys: Captured, *args: str) -> str:
    assert main(["interface", *args]) == 0
    return capsys.readouterr().out


def refused(capsys: Captured, *args: str, code: int = 1) -> str:
    assert main(["interface", *args]) == code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    return captured.err.strip()


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


# --- show -----------------------------------------------------------------------------------------------------------


def test_show_expands_nested_types_without_their_comments(workspace: Workspace, capsys: Captured) -> None:
    assert shown(capsys, "show", "lab_msgs/msg/Outer").splitlines() == [
        "# A type with another in it",
        "",
        "Inner inner  # Comment - 1 of 1",
        "\tbool BOOL_CONST=true",
        "\tbool flag true",
        '\tstring<=5 label "a # b"',
        "\tbool[<=3] flags",
        "float64[2] pair [0.5, 1.5]",
        "# The end",
    ]


def test_show_with_all_comments(workspace: Workspace, capsys: Captured) -> None:
    found = shown(capsys, "show", "lab_msgs/Outer", "--all-comments").splitlines()
    assert found[3:8] == [
        "\t# A short type",
        "",
        "\t# A constant",
        "\tbool BOOL_CONST=true  # is true",
        "",
    ]


def test_show_without_comments(workspace: Workspace, capsys: Captured) -> None:
    assert shown(capsys, "show", "Outer", "--no-comments").splitlines() == [
        "Inner inner",
        "\tbool BOOL_CONST=true",
        "\tbool flag true",
        '\tstring<=5 label "a # b"',
        "\tbool[<=3] flags",
        "float64[2] pair [0.5, 1.5]",
    ]


def test_show_a_service_and_an_action_in_parts(workspace: Workspace, capsys: Captured) -> None:
    assert shown(capsys, "show", "lab_msgs/srv/Ask").splitlines() == [
        "# Request",
        "Inner inner  # asked",
        "\tbool BOOL_CONST=true",
        "\tbool flag true",
        '\tstring<=5 label "a # b"',
        "\tbool[<=3] flags",
        "---",
        "# Response",
        "bool done  # answered",
    ]
    found = shown(capsys, "show", "Do", "--no-comments").splitlines()
    assert (found[0], found[1], found[-4:]) == (
        "Outer outer",
        "\tInner inner",
        ["---", "int32 code", "---", "float32 progress"],
    )


def test_show_reads_the_name_from_a_pipe(capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("std_msgs/msg/String\nstd_msgs/msg/Int32\n"))
    assert "string data" in shown(capsys, "show", "-")
    monkeypatch.setattr(sys, "stdin", io.StringIO(""))
    assert "nothing came from standard input" in refused(capsys, "show", "-", code=2)


def test_show_refuses_what_contradicts_itself(capsys: Captured) -> None:
    assert "exclude each other" in refused(capsys, "show", "String", "--all-comments", "--no-comments", code=2)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("Twits", "no type named 'Twits' (did you mean 'Twist'?)"),
        ("geometry_msgs/Twits", "no type named 'Twits' in geometry_msgs (did you mean 'Twist'?)"),
        ("geometry_msgs/msg/Twits", "no message type named 'Twits' in geometry_msgs (did you mean 'Twist'?)"),
        ("geometry_msg/Twist", "no interface package named 'geometry_msg' (did you mean 'geometry_msgs'?)"),
        ("geometry_msg/msg/Twist", "no interface package named 'geometry_msg' (did you mean 'geometry_msgs'?)"),
        ("Empty", "several types are named 'Empty'"),
        ("a/b/c/d", "'a/b/c/d' is no type name"),
        ("../../etc/passwd", "is no type name"),
        ("x" * 5000, "it has 5000 characters"),
    ],
)  # fmt: skip
def test_show_of_what_is_no_type(workspace: Workspace, capsys: Captured, name: str, said: str) -> None:
    found = refused(capsys, "show", name)
    assert said in found
    assert len(found) < 400


def test_a_definition_that_is_wrong_is_named_with_its_place(workspace: Workspace, capsys: Captured) -> None:
    workspace("Broken.msg", "int32 ok\nflot64 x\n")
    assert "Broken.msg:2:1: 'flot64' is no type" in refused(capsys, "show", "lab_msgs/msg/Broken")


def test_show_as_json_tells_all(workspace: Workspace, capsys: Captured) -> None:
    found = json.loads(shown(capsys, "show", "lab_msgs/msg/Outer", "--json"))
    assert (found["name"], found["kind"], found["text"]) == ("lab_msgs/msg/Outer", "msg", OUTER)
    assert found["hash"] == type_hash(find("lab_msgs/msg/Outer"))
    assert found["fields"] == [
        {"name": "inner", "type": "lab_msgs/Inner", "base": "lab_msgs/msg/Inner", "shape": "one"},
        {"name": "pair", "type": "float64[2]", "base": "float64", "shape": "array", "size": 2, "default": [0.5, 1.5]},
    ]
    inner = found["nested"]["lab_msgs/msg/Inner"]
    assert inner["constants"] == [{"name": "BOOL_CONST", "type": "bool", "base": "bool", "shape": "one", "value": True}]
    assert inner["fields"][1] == {
        "name": "label", "type": "string<=5", "base": "string", "shape": "one", "string_bound": 5, "default": "a # b"
    }  # fmt: skip


def test_show_as_json_has_the_hashes_of_all_parts(workspace: Workspace, capsys: Captured) -> None:
    service = json.loads(shown(capsys, "show", "std_srvs/srv/SetBool", "--json"))
    set_bool = find("SetBool", "srv")
    assert service["hash"] == type_hash(set_bool)
    assert {name: part["hash"] for name, part in service["parts"].items()} == {
        "request": type_hash(set_bool.Request),
        "response": type_hash(set_bool.Response),
        "event": type_hash(set_bool.Event),
    }
    action = json.loads(shown(capsys, "show", "lab_msgs/action/Do", "--json"))
    do = find("Do", "action")
    assert action["hash"] == type_hash(do)
    assert list(action["parts"]) == ["goal", "result", "feedback", "feedback_message"]
    assert action["services"]["send_goal"]["hash"] == type_hash(do.Impl.SendGoalService)


@pytest.fixture(scope="module")
def _sources_read_once() -> Iterator[None]:
    """The comments of a type that many have as a part are read once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text, "_comments", functools.cache(text._comments))
        yield


@pytest.mark.usefixtures("_sources_read_once")
@pytest.mark.parametrize("kind", KINDS)
def test_every_standard_type_can_be_shown(kind: str) -> None:
    for name in names(kind):
        cls = find(name, kind)
        assert all("\n" not in line for line in lines(cls, comments=True, nested_comments=True))
        assert json.dumps(as_data(cls))
        assert prototype(cls)


@pytest.mark.usefixtures("_sources_read_once")
def test_shown_without_comments_a_type_still_means_the_same() -> None:
    for name in names("msg"):
        cls = find(name)
        bare = [line for line in lines(cls, comments=False, nested_comments=False) if not line.startswith("\t")]
        assert type_hash(build(parse("\n".join(bare), name), find)) == type_hash(cls)


@given(st.text(max_size=40).filter(lambda each: not set(each) & set("\r\n")))
def test_any_line_loses_its_comment(line: str) -> None:
    bare = _without_comment(line)
    assert bare == bare.strip()
    assert _without_comment(bare) == bare
    assert line.strip().startswith(bare)


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
