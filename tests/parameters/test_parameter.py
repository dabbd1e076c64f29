"""Parameters: types from values, messages and back, values from text, dictionaries from files."""

from __future__ import annotations

import array
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.interfaces.rcl_interfaces.msg import ParameterType, ParameterValue
from robolink.parameter import (
    Parameter,
    get_parameter_value,
    parameter_dict_from_yaml_file,
    parameter_value_to_python,
)

Type = Parameter.Type

scalars: dict[Type, st.SearchStrategy[Any]] = {
    Type.BOOL: st.booleans(),
    Type.INTEGER: st.integers(-(2**63), 2**63 - 1),
    Type.DOUBLE: st.floats(allow_nan=False),
    Type.STRING: st.text(),
}
items: dict[Type, st.SearchStrategy[Any]] = {
    Type.BYTE_ARRAY: st.binary(min_size=1, max_size=1),
    Type.BOOL_ARRAY: scalars[Type.BOOL],
    Type.INTEGER_ARRAY: scalars[Type.INTEGER],
    Type.DOUBLE_ARRAY: scalars[Type.DOUBLE],
    Type.STRING_ARRAY: scalars[Type.STRING],
}
typed_values = st.one_of(
    st.just((Type.NOT_SET, None)),
    *(st.tuples(st.just(type_), value) for type_, value in scalars.items()),
    *(st.tuples(st.just(type_), st.lists(item, min_size=1, max_size=4)) for type_, item in items.items()),
)


@given(typed_values)
def test_a_value_has_one_type_and_comes_back_from_its_message(typed: tuple[Type, Any]) -> None:
    type_, value = typed
    parameter: Parameter[Any] = Parameter("a.b", value=value)
    assert (parameter.type_, parameter.value) == (type_, value)
    assert type_.check(value)
    message = parameter.to_parameter_msg()
    assert (message.name, message.value.type) == ("a.b", type_.value)
    back: Parameter[Any] = Parameter.from_parameter_msg(message)
    assert (back.name, back.type_) == ("a.b", type_)
    assert parameter_value_to_python(message.value) == value


@pytest.mark.parametrize(
    ("value", "type_"),
    [
        ((1, 2), Type.INTEGER_ARRAY),
        (array.array("i", [1]), Type.INTEGER_ARRAY),
        (array.array("d", [1.0]), Type.DOUBLE_ARRAY),
        (("a",), Type.STRING_ARRAY),
        ([True, 1], Type.INTEGER_ARRAY),
        ([], Type.BYTE_ARRAY),
    ],
)
def test_tuples_and_arrays_are_arrays(value: object, type_: Type) -> None:
    assert Type.from_parameter_value(value) is type_
    assert type_.check(value)


@pytest.mark.parametrize(
    ("type_", "value"),
    [
        (Type.NOT_SET, 42),
        (Type.BOOL, 1),
        (Type.DOUBLE, 1),
        (Type.STRING, 1),
        (Type.BOOL_ARRAY, 42),
        (Type.BYTE_ARRAY, [b"ab"]),
        (Type.STRING_ARRAY, array.array("i", [1])),
        (Type.DOUBLE_ARRAY, [1.0, 1]),
    ],
)
def test_type_and_value_must_agree(type_: Type, value: object) -> None:
    with pytest.raises(ValueError, match=r"parameter 'x': the type .* do not agree"):
        Parameter("x", type_, value)


@pytest.mark.parametrize("value", [{"a": 1}, [1, "a"], object(), b"bytes", [[1]]])
def test_a_value_of_no_type_is_refused(value: object) -> None:
    with pytest.raises(TypeError, match="allowed types"):
        Parameter("x", value=value)


def test_a_type_must_be_one() -> None:
    with pytest.raises(TypeError, match=r"Parameter\.Type, got 'double'"):
        Parameter("x", "double", 1.0)  # type: ignore[call-overload]  # the point of the test
    with pytest.raises(ValueError, match="99"):
        Parameter.from_parameter_msg(ParameterMsg(value=ParameterValue(type=99)))
    with pytest.raises(RuntimeError, match="unexpected parameter type 99"):
        parameter_value_to_python(ParameterValue(type=99))


def test_it_shows_what_it_is_and_can_be_annotated() -> None:
    parameter: Parameter[float] = Parameter("speed", Type.DOUBLE, 0.5)
    assert repr(parameter) == "Parameter(name='speed', type_=DOUBLE, value=0.5)"
    assert Parameter[float] is not None


@pytest.mark.parametrize(
    ("text", "type_", "value"),
    [
        ("True", ParameterType.PARAMETER_BOOL, True),
        ("42", ParameterType.PARAMETER_INTEGER, 42),
        ("1e3", ParameterType.PARAMETER_STRING, "1e3"),
        ("1.5", ParameterType.PARAMETER_DOUBLE, 1.5),
        ("12:30", ParameterType.PARAMETER_INTEGER, 750),
        ("99999999999999999999", ParameterType.PARAMETER_STRING, "99999999999999999999"),
        ("[]", ParameterType.PARAMETER_BOOL_ARRAY, []),
        ("[null]", ParameterType.PARAMETER_STRING, "[null]"),
        ("2020-99-99", ParameterType.PARAMETER_STRING, "2020-99-99"),
        ("foo", ParameterType.PARAMETER_STRING, "foo"),
        ("'42'", ParameterType.PARAMETER_STRING, "42"),
        ("", ParameterType.PARAMETER_STRING, ""),
        (" ", ParameterType.PARAMETER_STRING, " "),
        ("2024-01-01", ParameterType.PARAMETER_STRING, "2024-01-01"),
        ("[1, 2]", ParameterType.PARAMETER_INTEGER_ARRAY, [1, 2]),
        ("[1, 2.5]", ParameterType.PARAMETER_STRING, "[1, 2.5]"),
        ("[1, a]", ParameterType.PARAMETER_STRING, "[1, a]"),
        ("a: b", ParameterType.PARAMETER_STRING, "a: b"),
        ("[1", ParameterType.PARAMETER_STRING, "[1"),
    ],
)
def test_a_value_is_guessed_from_text(text: str, type_: int, value: object) -> None:
    found = get_parameter_value(text)
    assert (found.type, parameter_value_to_python(found)) == (type_, value)


@given(st.text())
def test_any_text_gives_some_value(text: str) -> None:
    assert get_parameter_value(text).type != ParameterType.PARAMETER_NOT_SET


FILE = """
/**: {ros__parameters: {a: 1, b: 1}}
/ns/talker: {ros__parameters: {b: 2, d: {e: '3'}}}
listener: {ros__parameters: {c: [1.0, 2.0]}}
"""


def read(tmp_path: Path, **options: Any) -> dict[str, object]:
    """Read FILE into plain values."""
    (tmp_path / "params.yaml").write_text(FILE)
    messages = parameter_dict_from_yaml_file(tmp_path / "params.yaml", **options)
    assert all(message.name == name for name, message in messages.items())
    return {name: parameter_value_to_python(message.value) for name, message in messages.items()}


def test_a_file_is_read_into_messages(tmp_path: Path) -> None:
    assert read(tmp_path) == {"b": 2, "d.e": "3", "c": [1.0, 2.0]}
    assert read(tmp_path, use_wildcard=True) == {"a": 1, "b": 2, "d.e": "3", "c": [1.0, 2.0]}
    assert read(tmp_path, target_nodes=["/ns/talker"]) == {"b": 2, "d.e": "3"}
    assert read(tmp_path, target_nodes=["listener"], use_wildcard=True) == {"a": 1, "b": 1, "c": [1.0, 2.0]}
    assert read(tmp_path, target_nodes=["/listener"], namespace="x.") == {"x.c": [1.0, 2.0]}


def test_a_node_that_a_file_does_not_have_is_a_runtime_error(tmp_path: Path) -> None:
    with pytest.raises(RuntimeError, match=r"no parameters for node '/ns/talkr' \(did you mean '/ns/talker'\?\)"):
        read(tmp_path, target_nodes=["/ns/talkr"])
    (tmp_path / "empty.yaml").write_text("")
    with pytest.raises(RuntimeError, match="no parameters for the nodes asked for"):
        parameter_dict_from_yaml_file(tmp_path / "empty.yaml")
    with pytest.raises(FileNotFoundError):
        parameter_dict_from_yaml_file("unknown_file")


def test_a_node_that_a_file_does_not_have_beside_others_is_told(tmp_path: Path) -> None:
    with pytest.warns(RuntimeWarning, match="no parameters for node '/zz'"):
        assert read(tmp_path, target_nodes=["/zz"], use_wildcard=True) == {"a": 1, "b": 1}
