"""Interface files in OMG IDL, as rosidl takes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.exceptions import DefinitionError, MessageError
from robolink.interfaces import find
from robolink.message import type_hash
from robolink.message.building import build
from robolink.message.definition import parse
from robolink.message.idl import parse_idl
from robolink.message.text import text_of
from robolink.workspace.interfaces import WorkspaceTypes
from tests.support.ros_test_types import msg as ros


def built(text: str, name: str = "my_msgs/msg/Odd") -> Any:
    return build(parse_idl(text, name, "Odd.idl"), find)


def message(inner: str, before: str = "") -> Any:
    return built(f"module my_msgs {{ module msg {{ {before} struct Odd {{ {inner} }}; }}; }};")


@pytest.mark.parametrize(
    ("idl", "msg"),
    [
        ("boolean x;", "bool x"),
        ("octet x;", "byte x"),
        ("long long x; unsigned long y; short z;", "int64 x\nuint32 y\nint16 z"),
        ("uint8 a, b;", "uint8 a\nuint8 b"),
        ("sequence<double> x;", "float64[] x"),
        ("sequence<string<5>, 3> x;", "string<=5[<=3] x"),
        ("wstring<7> x;", "wstring<=7 x"),
        ("float x[3];", "float32[3] x"),
        ("geometry_msgs::msg::Point x;", "geometry_msgs/Point x"),
        (
            '@verbatim (language="comment", text="of ;{}() kinds") @unit(value="m") @default (value=2.5) double x;',
            "float64 x 2.5",
        ),
        ('@default (value="a\\"b") string x;', 'string x "a\\"b"'),
        ("@default (value=TRUE) boolean x;", "bool x true"),
        ('@default (value="(1, 2)") sequence<long> x;', "int32[] x [1, 2]"),
        ("// note\n/* x;\n*/ #define Y\n long x;", "int32 x"),
    ],
)
def test_a_struct_is_the_message_of_a_msg_file(idl: str, msg: str) -> None:
    found, same = message(idl), build(parse(msg, "my_msgs/msg/Odd"), find)
    assert type_hash(found) == type_hash(same)
    assert found.__ros_defaults__ == same.__ros_defaults__
    assert text_of(found) == text_of(build(parse(text_of(found), "my_msgs/msg/Odd"), find))


def test_typedefs_and_constants() -> None:
    before = """
        typedef double double__36[36];
        module Odd_Constants { const unsigned short MOST = 3; const string WORD = "a" "b"; };
    """
    found = message("double__36 covariance; sequence<long, MOST> few;", before)
    assert found.get_fields_and_field_types() == {"covariance": "double[36]", "few": "sequence<int32, 3>"}
    assert (found.MOST, found.WORD) == (3, "ab")


def test_services_and_actions() -> None:
    parts = "struct Go_Request { long x; }; struct Go_Response { boolean ok; };"
    service = built(f"module p {{ module srv {{ {parts} }}; }};", "p/srv/Go")
    assert service.Request(x=3).x == 3
    parts = "struct Go_Goal { long x; }; struct Go_Result { long y; }; struct Go_Feedback { long z; };"
    action = built(f"module p {{ module action {{ {parts} }}; }};", "p/action/Go")
    assert action.Feedback(z=2).z == 2


def test_the_types_of_ros_that_only_an_idl_file_defines() -> None:
    assert type_hash(ros.KeyedLong) == "RIHS01_660defa556c3c4b1991498e62bca58bf71ac6e13bcf9a476aa998a8b66f650f0"
    assert type_hash(ros.ComplexNestedKey) == (
        "RIHS01_67de37f251f9431ed5f2630507939ff5538ecfaaa4169849be18870c3fbe2de8"
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "Odd.idl:1:1: no struct Odd in the modules my_msgs and its kind; there is none"),
        ("struct Odd {\n long x\n};", "Odd.idl:3:1: expected ';', got '}'"),
        ("struct Odd { long x;", "expected more, got the end of the file"),
        ("struct Odd { char x; };", "'char' is not a type of rosidl"),
        ("struct Odd { long double x; };", "'long double' is not a type of rosidl"),
        ("struct Odd { long x; long x; };", "a second 'x'"),
        ("struct Odd { long maxSpeed; };", "'maxSpeed' is not a field name"),
        ("struct Odd { long x[0]; };", "'0': a size or bound is a whole number from 1"),
        ("struct Odd { long x[2][2]; };", "ROS has no arrays of arrays"),
        ("struct Odd { sequence<sequence<long>> x; };", "ROS has no sequences of sequences"),
        ("struct Odd { my_msgs::msg::Odd x; };", "my_msgs/msg/Odd cannot contain itself"),
        ("struct Odd { no_msgs::msg::None x; };", "Odd.idl:1:14: no interface package named 'no_msgs'"),
        ("struct Odd { @default (value=300) octet x; };", "300 does not fit byte"),
        ("struct Odd { @default (value=1) geometry_msgs::msg::Point x; };", "only primitive types and arrays of them"),
        ("enum Odd { A, B };", "'enum' is not read here"),
        ("module a { " * 20, "modules more than 8 deep"),
        ("const long lower = 3;", "'lower' is not a constant name"),
        ("@verbatim(", "expected more, got the end of the file"),
        ('struct Odd { @default (value="(1") sequence<long> x; };', "is not a default of"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(text: str, said: str) -> None:
    with pytest.raises(DefinitionError) as caught:
        built(text)
    assert said in str(caught.value)
    assert str(caught.value).startswith("Odd.idl:")


def test_a_workspaces_idl_files_are_types(tmp_path: Path) -> None:
    folder = tmp_path / "interfaces" / "my_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "Speed.idl").write_text("module my_msgs { module msg { struct Speed { double value; }; }; };")
    (folder / "Both.msg").write_text("int32 from_msg\n")
    (folder / "Both.idl").write_text("module my_msgs { module msg { struct Both { long from_idl; }; }; };")
    types = WorkspaceTypes()
    types.add(tmp_path)
    assert types.names("msg")["my_msgs"] == ["Both", "Speed"]
    found: Any = types.get("my_msgs", "msg", "Speed")
    assert found(value=0.5).value == 0.5
    both: Any = types.get("my_msgs", "msg", "Both")
    assert list(both.__ros_fields__) == ["from_msg"]
    (folder / "Ring.idl").write_text("module my_msgs { module msg { struct Ring { sequence<Ring> x; }; }; };")
    with pytest.raises(MessageError, match="cannot contain itself"):
        types.get("my_msgs", "msg", "Ring")
