"""Reading VRML as Webots writes it: what it may say, and where it says something else."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolink.exceptions import DocumentError
from robolink.sim.webots.vrml import parse
from robolink.sim.webots.vrml_node import DEEPEST, MOST, MOST_NOTES, Node

HEADER = "#VRML_SIM R2023b utf8\n"


def nodes(text: str) -> list[Node]:
    return parse(HEADER + text, "w.wbt")


def node(text: str) -> Node:
    (found,) = nodes(text)
    return found


def refused(text: str) -> str:
    with pytest.raises(DocumentError) as caught:
        parse(text, "w.wbt")
    return str(caught.value)


def test_fields_of_every_kind() -> None:
    found = node(
        """
        EXTERNPROTO "https://example.org/Floor.proto"  # of no account
        IMPORTABLE EXTERNPROTO "Other.proto"
        DEF BODY Solid {
          translation 1, -2.5e-1 .5
          name "a \\"quoted\\" \\\\ name # no comment"
          locked TRUE
          physics NULL
          recognitionColors [ 1 0 0, 0 1 0 ]
          children [ Shape { geometry DEF BOX Box { size 1 2 3 } } Shape { geometry USE BOX castShadows FALSE } ]
          info [ "one" "two" ]
          hidden linearVelocity_0 0 0 1
          mask 0xFF
        }
        """
    )
    assert (found.type, found.defined, found.called) == ("Solid", "BODY", "Solid 'a \"quoted\" \\ name # no comment'")
    assert found.numbers("translation", 0, 0, 0) == (1.0, -0.25, 0.5)
    assert found.all_numbers("recognitionColors") == [1, 0, 0, 0, 1, 0]
    assert found.texts("info") == ["one", "two"]
    assert found.fields["locked"].values == [True]
    assert (found.node("physics"), found.numbers("linearVelocity_0", 0, 0, 0)) == (None, (0, 0, 1))
    first, second = found.nodes("children")
    assert first.node("geometry") is second.node("geometry")
    assert found.number("mask", 0.0) == 255.0
    assert found.number("mass", 7.0) == 7.0


def test_an_empty_world_and_one_with_a_mark_in_front() -> None:
    assert nodes("") == []
    assert parse("\ufeff#VRML_SIM R2024a utf8", "w.wbt") == []
    assert [each.type for each in nodes("Group{}Solid{} NULL E-puck { }")] == ["Group", "Solid", "E-puck"]


@pytest.mark.parametrize(
    ("text", "report"),
    [
        ("", "w.wbt:1:1: a world of Webots begins with '#VRML_SIM R2023b utf8', this with ''"),
        ("world: {}", "1:1: a world of Webots begins with '#VRML_SIM R2023b utf8', this with 'world: {}'"),
        ("#VRML_SIM R2021b utf8", "1:1: written by Webots R2021; R2022 or later is read"),
        (HEADER + "Solid", "2:6: expected '{' after Solid, got the end of the file"),
        (HEADER + "Solid { name", "2:13: expected a value, got the end of the file"),
        (HEADER + 'Solid {\n  name "x', "3:8: this string has no end"),
        (HEADER + "Solid { 3 }", "2:9: expected a field or '}', got '3'"),
        (HEADER + "Solid { size [ 1 2", "2:19: expected a value, got the end of the file"),
        (HEADER + "Solid { size ] }", "2:14: expected a value, got ']'"),
        (HEADER + "Solid } ", "2:7: expected '{' after Solid, got '}'"),
        (HEADER + "[ ]", "2:1: expected the type of a node, got '['"),
        (HEADER + "DEF BALL Solid {} USE BAL", "2:23: no node before this is called 'BAL' (did you mean 'BALL'?)"),
        (HEADER + "DEF A Group { children [ USE A ] }", "2:30: no node before this is called 'A'"),
        (HEADER + "Solid { x 1e999 }", "2:11: '1e999' is too large a number"),
        (HEADER + "EXTERNPROTO Floor", "2:13: expected the address of a PROTO in quotes, got 'Floor'"),
        (HEADER + "IMPORTABLE Floor", "2:12: expected EXTERNPROTO, got 'Floor'"),
        (HEADER + "Group { children [ " * 70, f"more than {DEEPEST} nodes are inside of each other"),
    ],
)
def test_what_is_no_vrml(text: str, report: str) -> None:
    assert report in refused(text)


@pytest.mark.parametrize(
    ("text", "report"),
    [
        ("Box { size 1 2 }", "2:12: Box.size: expected 3 numbers, got 2"),
        ('Box { size "big" }', "2:12: Box.size: expected numbers, got 'big'"),
        ("Box { size Shape {} }", "2:12: Box.size: expected numbers, got a Shape"),
        ("Box { size 1 2 1e13 }", "2:12: Box.size: expected at most 1e+12, got 1e+13"),
        ("Box { size TRUE }", "2:12: Box.size: expected numbers, got TRUE"),
    ],
)
def test_a_field_that_holds_something_else(text: str, report: str) -> None:
    with pytest.raises(DocumentError) as caught:
        node(text).lengths("size", 1.0, 1.0, 1.0)
    assert str(caught.value) == f"w.wbt:{report}"


def test_what_webots_repairs_with_a_warning_is_repaired_with_a_note() -> None:
    found = node("Box {\n size 1 2 0 }")
    assert found.lengths("size", 1.0, 1.0, 2.5) == (1.0, 1.0, 2.5)
    assert list(found.source.notes) == ["w.wbt:3:7: Box.size: expected more than 0, got 0; 1 1 2.5 is used"]
    found = node("Solid { nmae 3 children [ Box { size 1 1 1 sise 2 } Box { sise 3 } ] }")
    assert list(found.source.notes) == [
        "w.wbt:2:9: Solid.nmae: unknown key 'nmae' (did you mean 'name'?): ignored",
        "w.wbt:2:44: Box.sise: unknown key 'sise' (did you mean 'size'?): ignored",
    ]
    many = node("Solid { " + " ".join(f"x{i} 1" for i in range(2 * MOST_NOTES)) + " }")
    assert len(list(many.source.notes)) == MOST_NOTES


def test_text_and_nodes_are_checked_too() -> None:
    with pytest.raises(DocumentError, match=r"2:14: Solid\.name: expected a string, got 3"):
        node("Solid { name 3 }").text("name")
    with pytest.raises(DocumentError, match=r"2:16: Solid\.locked: expected TRUE or FALSE, got 1"):
        node("Solid { locked 1 }").truth("locked", False)
    with pytest.raises(DocumentError, match=r"2:18: Solid\.children: expected a node, got 'x'"):
        node('Solid { children "x" }').nodes("children")


def test_use_neither_nests_nor_multiplies_without_end() -> None:
    chain = "DEF A0 Group { }\n" + "".join(f"DEF A{i + 1} Group {{ children [ USE A{i} ] }}\n" for i in range(70))
    assert f"more than {DEEPEST} nodes are inside of each other" in refused(HEADER + chain)
    doubled = "DEF A0 Group { }\n" + "".join(
        f"DEF A{i + 1} Group {{ children [ USE A{i} USE A{i} ] }}\n" for i in range(40)
    )
    assert f"the nodes before this are more than {MOST}" in refused(HEADER + doubled)
    assert f"this has more than {MOST} nodes" in refused(HEADER + "Group { children [ " + doubled + " ] }")


WORDS = ["Solid", "Group", "{", "}", "[", "]", "DEF", "USE", "A", "NULL", "TRUE", "1", "-2.5", '"s"', ",", "# c\n"]
WORDS += ["children", "geometry", "Box", "size", "EXTERNPROTO", "IMPORTABLE", "hidden", '"', "\\", "1e400", "\x00"]


@given(st.text() | st.lists(st.sampled_from(WORDS)).map(" ".join))
@example("{" * 5000)
@example("Group { children [ " * 5000)
@example('"' + "\\" * 1001)
def test_no_text_gives_anything_but_nodes_or_a_document_error(text: str) -> None:
    for whole in (text, HEADER + text):
        try:
            found = parse(whole, "w.wbt")
        except DocumentError as error:
            report = str(error)
        else:
            report = ""
            assert all(isinstance(each, Node) for each in found)
        assert report == "" or report.startswith("w.wbt:")
