"""robolink interface show: ros2's texts of types."""

from __future__ import annotations

import functools
import io
import json
import sys
from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.interface.show import _without_comment, as_data, lines, prototype
from robolink.interfaces import KINDS, find, names
from robolink.message import text, type_hash
from robolink.message.building import build
from robolink.message.definition import parse
from tests.support.shown_types import OUTER, Workspace, refused, shown

Captured = pytest.CaptureFixture[str]


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
        ("a/b/c/d", "'a/b/c/d' is not a type name"),
        ("../../etc/passwd", "is not a type name"),
        ("x" * 5000, "it has 5000 characters"),
    ],
)  # fmt: skip
def test_show_of_what_is_no_type(workspace: Workspace, capsys: Captured, name: str, said: str) -> None:
    found = refused(capsys, "show", name)
    assert said in found
    assert len(found) < 400


def test_a_definition_that_is_wrong_is_named_with_its_place(workspace: Workspace, capsys: Captured) -> None:
    workspace("Broken.msg", "int32 ok\nflot64 x\n")
    assert "Broken.msg:2:1: 'flot64' is not a type" in refused(capsys, "show", "lab_msgs/msg/Broken")


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


@pytest.mark.slow
@pytest.mark.usefixtures("_sources_read_once")
@pytest.mark.parametrize("kind", KINDS)
def test_every_standard_type_can_be_shown(kind: str) -> None:
    for name in names(kind):
        cls = find(name, kind)
        assert all("\n" not in line for line in lines(cls, comments=True, nested_comments=True))
        assert json.dumps(as_data(cls))
        assert prototype(cls)


@pytest.mark.slow
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
