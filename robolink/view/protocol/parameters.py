"""Parameters as Foxglove has them, `/node.parameter` with a JSON value and a type, from and to ROS 2's messages."""

from __future__ import annotations

import base64
import binascii
from typing import Any, NamedTuple

from robolink.interfaces.rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from robolink.view.protocol.requests import ParameterRequest, ProtocolError

KINDS = ParameterType
_FIELDS = {
    KINDS.PARAMETER_BOOL: "bool_value",
    KINDS.PARAMETER_INTEGER: "integer_value",
    KINDS.PARAMETER_DOUBLE: "double_value",
    KINDS.PARAMETER_STRING: "string_value",
    KINDS.PARAMETER_BYTE_ARRAY: "byte_array_value",
    KINDS.PARAMETER_BOOL_ARRAY: "bool_array_value",
    KINDS.PARAMETER_INTEGER_ARRAY: "integer_array_value",
    KINDS.PARAMETER_DOUBLE_ARRAY: "double_array_value",
    KINDS.PARAMETER_STRING_ARRAY: "string_array_value",
}
_WORDS = {
    KINDS.PARAMETER_BYTE_ARRAY: "byte_array",
    KINDS.PARAMETER_DOUBLE: "float64",
    KINDS.PARAMETER_DOUBLE_ARRAY: "float64_array",
}
"""Types that a JSON value does not tell by itself."""
_SCALARS = {
    bool: KINDS.PARAMETER_BOOL,
    int: KINDS.PARAMETER_INTEGER,
    float: KINDS.PARAMETER_DOUBLE,
    str: KINDS.PARAMETER_STRING,
}
_ARRAYS = {
    bool: KINDS.PARAMETER_BOOL_ARRAY,
    int: KINDS.PARAMETER_INTEGER_ARRAY,
    float: KINDS.PARAMETER_DOUBLE_ARRAY,
    str: KINDS.PARAMETER_STRING_ARRAY,
}
_INT64 = range(-(2**63), 2**63)


class ParameterName(NamedTuple):
    """Full name of a parameter: that of its node, and its own."""

    node: str
    name: str

    def __str__(self) -> str:
        return f"{self.node}.{self.name}"


def name_of(text: str) -> ParameterName:
    """Split `/node.parameter`, at the first dot, which no node's name has; raises ProtocolError."""
    node, dot, name = text.partition(".")
    if not dot or not name or not node.startswith("/"):
        raise ProtocolError(f"'{text[:100]}' names no parameter; expected /node.parameter")
    return ParameterName(node, name)


def to_json(name: ParameterName, value: ParameterValue | None) -> dict[str, Any]:
    """Return a parameter as `parameterValues` has it; one without a value is not set, or deleted."""
    shown: dict[str, Any] = {"name": str(name)}
    if value is None or value.type not in _FIELDS:
        return shown
    held = getattr(value, _FIELDS[value.type])
    if value.type == KINDS.PARAMETER_BYTE_ARRAY:
        shown["value"] = base64.b64encode(b"".join(held)).decode()
    else:
        shown["value"] = list(held) if value.type > KINDS.PARAMETER_BYTE_ARRAY else held
    if value.type in _WORDS:
        shown["type"] = _WORDS[value.type]
    return shown


def from_json(request: ParameterRequest, known: int) -> Parameter:
    """Return the message that sets a parameter.

    Args:
        request: Parameter that a client sets, in JSON; without a value the parameter is deleted.
        known: Type that the parameter has now: a whole number for a float is a float. 0 if it is not known.

    Raises:
        ProtocolError: for a value that no parameter can have.
    """
    name = name_of(request.name)
    kind, value = _typed(request, known)
    made = ParameterValue(type=kind)
    if kind in _FIELDS:
        setattr(made, _FIELDS[kind], value)
    return Parameter(name=name.name, value=made)


def _typed(request: ParameterRequest, known: int) -> tuple[int, Any]:
    value = request.value
    if value is None:
        return KINDS.PARAMETER_NOT_SET, None
    if request.type == "byte_array" or (known == KINDS.PARAMETER_BYTE_ARRAY and isinstance(value, str)):
        return KINDS.PARAMETER_BYTE_ARRAY, [bytes((each,)) for each in _decoded(request)]
    wants_float = request.type in ("float64", "float64_array") or known in (
        KINDS.PARAMETER_DOUBLE,
        KINDS.PARAMETER_DOUBLE_ARRAY,
    )
    if isinstance(value, list):
        return _list(request, known, wants_float)
    if type(value) not in _SCALARS:
        raise ProtocolError(f"{request.name}: {str(value)[:60]} is not a value of a parameter")
    if type(value) is int and wants_float:
        return KINDS.PARAMETER_DOUBLE, float(value)
    return _SCALARS[type(value)], _in_range(request, value)


def _list(request: ParameterRequest, known: int, wants_float: bool) -> tuple[int, list[Any]]:
    kinds = {type(each) for each in request.value}
    if not kinds and known in _FIELDS:
        return known, []
    if (kinds == {int} and wants_float) or kinds == {int, float}:
        return KINDS.PARAMETER_DOUBLE_ARRAY, [float(each) for each in request.value]
    if len(kinds) > 1 or not kinds <= _ARRAYS.keys():
        raise ProtocolError(
            f"{request.name}: a list of parameters has values of one type, of bool, int, float or string"
        )
    kind = (
        _ARRAYS[kinds.pop()]
        if kinds
        else (KINDS.PARAMETER_DOUBLE_ARRAY if wants_float else KINDS.PARAMETER_STRING_ARRAY)
    )
    return kind, [_in_range(request, each) for each in request.value]


def _in_range(request: ParameterRequest, value: Any) -> Any:
    if type(value) is int and value not in _INT64:
        raise ProtocolError(f"{request.name}: {str(value)[:40]} is not an integer of 64 bits")
    return value


def _decoded(request: ParameterRequest) -> bytes:
    try:
        return base64.b64decode(request.value, validate=True)
    except (binascii.Error, TypeError, ValueError):
        raise ProtocolError(f"{request.name}: expected the bytes in base64") from None
