"""ROS parameter files and values: rcl's reading of YAML, sections for nodes, and errors that say where."""

from __future__ import annotations

import math
import time
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.arguments.overrides import Override, Value, overrides_for
from robolink.arguments.parameter_file import (
    ParameterFileError,
    parse_parameter_file,
    parse_parameter_value,
    parse_scalar,
    read_parameter_file,
)
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError


def values(text: str, node: str = "/n") -> dict[str, Value]:
    """Give the parameters that a file's text has for a node."""
    return overrides_for(parse_parameter_file(text, "f.yaml"), node)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("5", 5),
        ("-5", -5),
        ("+5", 5),
        ("0", 0),
        ("010", 8),
        ("08", 8.0),
        ("0x1F", 31),
        ("-0xff", -255),
        ("9223372036854775807", 2**63 - 1),
        ("9223372036854775808", 2.0**63),
        ("1.", 1.0),
        (".5", 0.5),
        ("1e3", 1000.0),
        ("-2.5E-1", -0.25),
        (".inf", math.inf),
        ("-.INF", -math.inf),
        ("Infinity", math.inf),
        ("yes", True),
        ("On", True),
        ("N", False),
        ("FALSE", False),
        ("tRUE", "tRUE"),
        ("1_000", "1_000"),
        ("12:30", "12:30"),
        ("2024-01-01", "2024-01-01"),
        ("null", "null"),
        ("~", "~"),
        (".infinity", ".infinity"),
        ("1e999", "1e999"),
        ("9" * 5000, "9" * 5000),
        ("0x", "0x"),
        ("", ""),
    ],
)
def test_a_plain_scalar_is_read_as_rcl_does(text: str, value: object) -> None:
    found = parse_scalar(text)
    assert (found, type(found)) == (value, type(value))


@pytest.mark.parametrize("text", [".nan", ".NaN", "nan", "-NAN"])
def test_not_a_number_is_read(text: str) -> None:
    found = parse_scalar(text)
    assert isinstance(found, float)
    assert math.isnan(found)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("'1'", "1"),
        ('"yes"', "yes"),
        ("''", ""),
        ("!!str 1234", "1234"),
        ("!!str yes", "yes"),
        ("!!float 10", 10.0),
        ("!!float '10'", 10.0),
        ("!!float nan # a comment", math.nan),
        ("!<tag:yaml.org,2002:float> 0x10", 16.0),
        ("[!!float 1, 2.5]", [1.0, 2.5]),
        ("!!int 010", 8),
        ('!!bool "on"', True),
        ("!!timestamp 2020-01-01", "2020-01-01"),
        ("!own 5", 5),
        ("yes", True),
        ("word", "word"),
        ("[]", []),
        ("[true, no]", [True, False]),
        ("['1', a]", ["1", "a"]),
        ("[12.1, -2.0, .inf]", [12.1, -2.0, math.inf]),
        ("[1, 2]", [1, 2]),
        ("two words", "two words"),
    ],
)
def test_a_value_is_read(text: str, value: object) -> None:
    found = parse_parameter_value(text)
    assert (repr(found), type(found)) == (repr(value), type(value))


@pytest.mark.parametrize(
    ("text", "what"), [("!!int 1.5", "1.5"), ("!!float abc", "abc"), ("!!bool 1", "1"), ("!!float", "")]
)
def test_a_tag_is_held_to(text: str, what: str) -> None:
    tag = text.split()[0]
    with pytest.raises(ParameterFileError, match=rf"^<value>:1:1: {tag} stands before '{what}', which is not one$"):
        parse_parameter_value(text)


@given(
    st.one_of(
        *(
            st.one_of(item, st.lists(item, max_size=4))
            for item in (
                st.booleans(),
                st.integers(-(2**63), 2**63 - 1),
                st.floats(allow_nan=False, allow_infinity=False, width=32),
                st.text(),
            )
        )
    )
)
def test_what_is_spelled_as_yaml_is_read_back(value: Value) -> None:
    found = parse_parameter_value(spell(value))  # type: ignore[arg-type]  # lists do not vary, values do
    assert (found, type(found)) == (value, type(value))


def test_sections_name_nodes_in_one_key_or_in_nested_ones() -> None:
    text = """
/ns/a: {ros__parameters: {x: 1}}
ns:
  b:
    ros__parameters: {x: 2}
/:
  c: {ros__parameters: {x: 3}}
/ns/:
  d: {ros__parameters: {x: 4}}
"""
    assert [values(text, node) for node in ("/ns/a", "/ns/b", "/c", "/ns/d", "/a")] == [
        {"x": 1},
        {"x": 2},
        {"x": 3},
        {"x": 4},
        {},
    ]


def test_nested_parameters_are_joined_by_dots() -> None:
    text = "n: {ros__parameters: {a: {b: {c: 1}, d: [2.5, 1.0]}, e.f: yes}}"
    assert values(text) == {"a.b.c": 1, "a.d": [2.5, 1.0], "e.f": True}


@pytest.mark.parametrize(
    ("pattern", "fits", "fits_not"),
    [
        ("/**", ["/a", "/a/b/c"], []),
        ("**", ["/a", "/a/b/c"], []),
        ("/*", ["/a"], ["/a/b"]),
        ("*", ["/a"], ["/a/b"]),
        ("/**/n", ["/n", "/a/n", "/a/b/n"], ["/na", "/a/n/b"]),
        ("/a/*", ["/a/b"], ["/a", "/a/b/c", "/b/b"]),
        ("/**/foo/*/bar/n", ["/a/b/c/foo/d/bar/n", "/foo/d/bar/n"], ["/foo/bar/n", "/foo/d/e/bar/n"]),
        ("a/b", ["/a/b"], ["/a/bb", "/a"]),
    ],
)
def test_a_pattern_chooses_nodes(pattern: str, fits: list[str], fits_not: list[str]) -> None:
    override = Override(pattern, "x", 1)
    assert all(override.is_for(node) for node in fits)
    assert not any(override.is_for(node) for node in fits_not)


def test_sections_may_repeat_and_the_last_value_wins() -> None:
    text = """
/**:
  n: {ros__parameters: {x: first, y: first}}
/n: {ros__parameters: {x: second}}
/**:
  ros__parameters: {x: last}
"""
    assert values(text) == {"x": "last", "y": "first"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("n: {ros__parameters: {x: [1, [2]]}}", "f.yaml:1:30: x: a list cannot hold a list"),
        ("n: {ros__parameters: {x: [1, {}]}}", "1:30: x: a list cannot hold a mapping"),
        ("n: {ros__parameters: {a: {x: [1, 'a']}}}", "1:34: a.x: a list holds one type, got str after int"),
        ("n: {ros__parameters: {x: [true, 1]}}", "1:33: x: a list holds one type, got int after bool"),
        ("n:\n  ros__parameters:\n    x:\n", "3:7: x: no value \\(write '' for an empty string\\)"),
        ("n:\n  ros__parameters:\n", "2:19: expected a mapping with parameters, got nothing"),
        ("n:\n  ros__parameters: 3\n", "2:20: expected a mapping with parameters, got '3'"),
        ("ros__parameters: {x: 1}", "1:1: the name of a node must stand above ros__parameters"),
        ("n:\n  ros__parameter:\n    x: 1\n", r"3:5: 'x' must stand below ros__parameters"),
        ("n: {ros_parameters: [1]}", r"1:5: 'ros_parameters' must .* \(did you mean 'ros__parameters'\?\)"),
        ("n: 1", "1:1: 'n' must stand below ros__parameters"),
        ("[1]", "1:1: expected a mapping with a section for each node, got a list"),
        ("n*: {ros__parameters: {x: 1}}", "1:6: node name 'n\\*' above ros__parameters must not contain"),
        ("/a//b: {ros__parameters: {x: 1}}", "node name '' above"),
        ("/: {ros__parameters: {x: 1}}", "node name '' above"),
        ("n: {ros__parameters: {? [1] : 1}}", "1:25: expected a name, got a list"),
        ("n: {ros__parameters: {'': 1}}", "1:23: expected a name, got nothing"),
        ("n: {ros__parameters: {x: &a 1, y: *a}}", "aliases are not allowed"),
        ("n: &a {ros__parameters: {x: 1}, y: *a}", "aliases are not allowed"),
        ('n: {ros__parameters: {x: "\\ud800"}}', "half a surrogate pair"),
        ("n: [", "f.yaml:1:5: "),
        ("n: {\tros__parameters", "f.yaml:1:"),
    ],
)
def test_what_is_no_parameter_file_is_refused_with_its_place(text: str, message: str) -> None:
    with pytest.raises(ParameterFileError, match=message) as caught:
        parse_parameter_file(text, "f.yaml")
    assert str(caught.value).startswith("f.yaml:")
    assert "\n" not in str(caught.value)


def test_an_empty_file_has_no_parameters(tmp_path: Path) -> None:
    file = tmp_path / "empty.yaml"
    file.write_text("# nothing yet\n")
    assert read_parameter_file(file) == []


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    (tmp_path / "params.yaml").write_bytes(b"n: \xff\n")
    with pytest.raises(ParameterFileError, match=r"params.yaml:1:4: not UTF-8"):
        read_parameter_file(tmp_path / "params.yaml")
    with pytest.raises(FileNotFoundError, match=r"parms.yaml' \(did you mean 'params.yaml'\?\)") as caught:
        read_parameter_file(tmp_path / "parms.yaml")
    assert isinstance(caught.value, DocumentError)
    with pytest.raises(ParameterFileError, match="cannot be read"):
        read_parameter_file(tmp_path)


yaml_like = st.lists(
    st.sampled_from(
        ["n", "ros__parameters", ": ", "{", "}", "[", "]", ", ", "1", "&a ", "*a", "\n", "  ", "- ", "'", "!", "? "]
    ),
    max_size=16,
).map("".join)


@given(st.one_of(yaml_like, st.text()))
def test_any_text_is_read_or_refused_with_the_one_error(text: str) -> None:
    with suppress(ParameterFileError):
        assert all(isinstance(each, Override) for each in parse_parameter_file(text, "f"))
    with suppress(ParameterFileError):
        assert isinstance(parse_parameter_value(text), bool | int | float | str | list)


def test_many_wildcards_are_matched_at_once() -> None:
    pattern = "/**/a" * 20
    begin = time.process_time()
    assert not Override(pattern, "x", 1).is_for("/a" * 120 + "/b")
    assert Override(pattern, "x", 1).is_for("/a" * 120)
    assert time.process_time() - begin < 1


def test_a_node_s_name_ends_without_a_slash() -> None:
    with pytest.raises(ParameterFileError, match="'/n/' above ros__parameters ends with a slash, which ROS 2 refuses"):
        values("/n/: {ros__parameters: {x: 1}}")


def test_a_file_for_a_thousand_nodes_is_read_in_both_orders() -> None:
    sections = [f"n{each}: {{ros__parameters: {{x: {each}, all: {each}}}}}" for each in range(1000)]
    wide = "/**: {ros__parameters: {all: -1, wide: 1}}"
    before, after = ("\n".join(lines) for lines in ([wide, *sections], [*sections, wide]))
    assert overrides_for(parse_parameter_file(before, "f"), "/n7") == {"all": 7, "wide": 1, "x": 7}
    assert overrides_for(parse_parameter_file(after, "f"), "/n7") == {"all": -1, "wide": 1, "x": 7}
