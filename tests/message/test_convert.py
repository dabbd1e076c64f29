"""Messages from plain data, as YAML and JSON have it: scalars are converted as rosidl_runtime_py does."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.exceptions import EncodeError, MessageError
from robolink.interfaces import find
from robolink.message import from_builtins
from robolink.message.convert import UnknownFieldError


@pytest.mark.parametrize(
    ("name", "given", "held"),
    [
        ("String", 5, "5"),
        ("String", True, "True"),
        ("String", None, "None"),
        ("Int32", "5", 5),
        ("Int32", 5.7, 5),
        ("Int32", "1_000", 1000),
        ("Int32", True, 1),
        ("Float64", "1.5", 1.5),
        ("Float64", 10**20, 1e20),
        ("Float64", "nan", "nan"),
        ("Bool", "on", True),
        ("Bool", "No", False),
        ("Bool", "false", False),
        ("Bool", 2, True),
        ("Byte", 5, b"\x05"),
    ],
)
def test_scalars_are_converted(name: str, given: Any, held: Any) -> None:
    found = from_builtins(find(f"std_msgs/msg/{name}"), {"data": given}).data
    assert (str(found) if held == "nan" else found) == held
    assert type(found) is type(held) or held == "nan"


def test_elements_are_converted() -> None:
    joints = from_builtins(find("JointState"), {"name": [1, "b"], "header": {"frame_id": 5}, "position": [1, 2]})
    assert (joints.name, joints.header.frame_id, list(joints.position)) == (["1", "b"], "5", [1.0, 2.0])
    imu = from_builtins(find("Imu"), {"orientation_covariance": ["1"] * 9})
    assert imu.orientation_covariance.tolist() == [1.0] * 9


@pytest.mark.parametrize(
    ("name", "data", "text"),
    [
        ("std_msgs/msg/Int32", {"data": "x"}, "Int32.data: expected int32, got 'x'"),
        ("std_msgs/msg/Int32", {"data": float("inf")}, "Int32.data: expected int32, got inf"),
        ("std_msgs/msg/Int32", {"data": None}, "Int32.data: expected int32, got None"),
        ("std_msgs/msg/Int32", {"data": 2**31}, "Int32.data: expected int32, got 2147483648"),
        ("std_msgs/msg/Bool", {"data": "maybe"}, "Bool.data: expected bool, got 'maybe'"),
        ("std_msgs/msg/Float64", {"data": [1.0]}, r"Float64.data: expected float64, got \[1.0\]"),
        ("sensor_msgs/msg/JointState", {"name": "ab"}, "JointState.name: expected string.*, got 'ab'"),
        ("sensor_msgs/msg/JointState", {"position": ["1"]}, r"JointState.position.*'1'"),
    ],
)
def test_what_cannot_be_converted_is_refused(name: str, data: Any, text: str) -> None:
    with pytest.raises(EncodeError, match=text):
        from_builtins(find(name), data)


def test_an_unknown_field_is_an_attribute_error_and_no_type_error() -> None:
    with pytest.raises(AttributeError, match=r"no field 'dta' \(did you mean 'data'\?\); it has data") as caught:
        from_builtins(find("String"), {"dta": 1})
    assert isinstance(caught.value, (UnknownFieldError, MessageError))
    assert not isinstance(caught.value, TypeError)
