"""Conversion of messages to and from plain dicts and lists, as YAML and JSON have them."""

from __future__ import annotations

from array import array
from typing import Any

from robolink.exceptions import EncodeError, nearest
from robolink.message.annotations import FieldType
from robolink.message.base import Message
from robolink.message.check import explain

_FLOATS = ("float32", "float64")
_EXACT = 2**53
"""Bound of the integers that are floats without loss."""


def from_builtins(cls: type[Message], data: Any) -> Any:
    """Return a message of the class `cls` from a mapping; fields that `data` leaves out keep their defaults.

    Raises EncodeError that names the field; for an unknown one also the nearest that exists.

    >>> from_builtins(Twist, {"linear": {"x": 0.3}}).linear.x
    0.3
    """
    message = cls()
    _fill(message, data if data is not None else {}, cls.__ros_type__.rpartition("/")[2])
    wrong = explain(cls, message)
    if wrong:
        raise EncodeError(wrong)
    return message


def _fill(message: Message, data: Any, path: str) -> None:
    if not isinstance(data, dict):
        wanted = ", ".join(message.__ros_fields__) or "nothing"
        raise EncodeError(f"{path}: expected a mapping of {wanted}, got {data!r:.60}{_unspaced(message, data)}")
    for name, value in data.items():
        kind = message.__ros_fields__.get(name)
        if kind is None:
            known = list(message.__ros_fields__)
            hint = _unspaced(message, name) or f"{nearest(str(name), known)}; it has {', '.join(known)}"
            raise EncodeError(f"{path}: no field '{name}'{hint}")
        setattr(message, name, _value(kind, value, f"{path}.{name}"))


def _unspaced(message: Message, text: Any) -> str:
    """Return the hint for a text that is a field and its value, but for the space that YAML wants between them."""
    name, colon, value = text.partition(":") if isinstance(text, str) else ("", "", "")
    is_meant = bool(colon) and name in message.__ros_fields__
    return f"; a space is missing behind the colon: '{name}: {value:.40}'" if is_meant else ""


def _value(kind: FieldType, value: Any, path: str) -> Any:
    if kind.message is None:
        if kind.base == "byte":
            return _octets(kind, value)
        if kind.base in _FLOATS and kind.shape == "one" and type(value) is int and abs(value) < _EXACT:
            return float(value)
        return value
    if kind.shape == "one":
        return _nested(kind.message, value, path)
    if not isinstance(value, (list, tuple)):
        raise EncodeError(f"{path}: expected {kind}, got {value!r:.60}")
    return [_nested(kind.message, each, f"{path}[{index}]") for index, each in enumerate(value)]


def _nested(cls: type[Message], value: Any, path: str) -> Message:
    message = cls()
    _fill(message, value, path)
    return message


def _octets(kind: FieldType, value: Any) -> Any:
    """Return a byte of YAML, a number, as a message holds it: a bytes object of length one."""
    if kind.shape == "one":
        return bytes((value,)) if isinstance(value, int) and 0 <= value < 256 else value
    return [bytes((each,)) if isinstance(each, int) and 0 <= each < 256 else each for each in value]


def to_builtins(message: Message) -> dict[str, Any]:
    """Return `message` as dicts, lists, strings and numbers, fields in their order."""
    return {name: _plain(getattr(message, name)) for name in message.__ros_fields__}


def _plain(value: Any) -> Any:
    if hasattr(type(value), "__ros_fields__"):
        return to_builtins(value)
    if isinstance(value, (array, memoryview)) or hasattr(value, "__array_interface__"):
        return value.tolist()
    if isinstance(value, bytes):
        return value[0] if len(value) == 1 else list(value)
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return value
