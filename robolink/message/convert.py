"""Conversion of messages to and from plain dicts and lists, as YAML and JSON have them."""

from __future__ import annotations

import struct
from array import array
from collections.abc import Iterator, Mapping, Sized
from typing import Any

from robolink.exceptions import EncodeError, MessageError, nearest
from robolink.message.annotations import FieldType
from robolink.message.base import Message
from robolink.message.cdr_layout import CODES

_WORDS = {"true": True, "yes": True, "on": True, "false": False, "no": False, "off": False}


class UnknownFieldError(MessageError, AttributeError):
    """The data has a field that the message has not; not a TypeError, which stands for a value that does not fit."""


def from_builtins(cls: type[Message], data: Any) -> Any:
    """Return a message of the class `cls` from a mapping; fields that `data` leaves out keep their defaults.

    Scalars are converted; see `converted`. Raises EncodeError that names the field, and UnknownFieldError (an
    AttributeError) for an unknown one, with the nearest that exists.

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
        fields = ", ".join(message.__ros_fields__) or "nothing"
        raise EncodeError(f"{path}: expected a mapping of {fields}, got {data!r:.60}{_unspaced(message, data)}")
    for name, value in data.items():
        kind = message.__ros_fields__.get(name)
        if kind is None:
            known = list(message.__ros_fields__)
            hint = _unspaced(message, name) or f"{nearest(str(name), known)}; it has {', '.join(known)}"
            raise UnknownFieldError(f"{path}: no field '{name}'{hint}")
        setattr(message, name, _value(kind, value, f"{path}.{name}"))


def _unspaced(message: Message, text: Any) -> str:
    """Return the hint for a text that is a field and its value, but for the space that YAML wants between them."""
    name, colon, value = text.partition(":") if isinstance(text, str) else ("", "", "")
    is_meant = bool(colon) and name in message.__ros_fields__
    return f"; a space is missing behind the colon: '{name}: {value:.40}'" if is_meant else ""


def _value(kind: FieldType, value: Any, path: str) -> Any:
    if kind.message is None:
        return converted(kind, value, path)
    if kind.shape == "one":
        return _nested(kind.message, value, path)
    if not isinstance(value, (list, tuple)):
        raise EncodeError(f"{path}: expected {kind}, got {value!r:.60}")
    return [_nested(kind.message, each, f"{path}[{index}]") for index, each in enumerate(value)]


def _nested(cls: type[Message], value: Any, path: str) -> Message:
    message = cls()
    _fill(message, value, path)
    return message


def converted(kind: FieldType, value: Any, path: str) -> Any:
    """Return the value of a field that is not a message as the field holds it, converted as rosidl_runtime_py does.

    A string takes any scalar, a number what Python's int and float take (5.7 becomes 5), a bool any number and the
    words that YAML 1.1 has for it (in ros2 every text in quotes is true, 'false' too), a byte a number or the character
    that `topic echo` shows of it. What then does not fit is the caller's to find.

    Raises EncodeError that names the field.
    """
    try:
        if kind.shape == "one":
            return _scalar(kind.base, kind.code, value)
        if isinstance(value, (str, Mapping)) or not hasattr(value, "__iter__"):
            raise EncodeError(f"{path}: expected {kind}, got {value!r:.60}")
        if kind.code and kind.shape != "array":  # array.array, which converts no texts
            return value
        return [_scalar(kind.base, kind.code, each) for each in value]
    except (TypeError, ValueError, OverflowError) as error:
        if isinstance(error, EncodeError):
            raise
        raise EncodeError(f"{path}: expected {kind}, got {value!r:.60}") from None


def _scalar(base: str, code: str | None, value: Any) -> Any:
    if base in ("string", "wstring"):
        return value if isinstance(value, str) else str(value)
    if code in ("f", "d"):
        return float(value)
    if base == "bool":
        if isinstance(value, str):
            return _WORDS.get(value.lower(), value)
        return bool(value) if isinstance(value, (int, float)) else value
    if base == "byte":
        return bytes((value,)) if isinstance(value, int) else _byte_of(value)
    return int(value) if isinstance(value, (str, float, bool)) else value


def _byte_of(value: Any) -> Any:
    """Return the byte that `topic echo` shows as this character."""
    return bytes((ord(value),)) if isinstance(value, str) and len(value) == 1 and ord(value) < 256 else value


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


def explain(cls: type[Message], message: Any) -> str:
    """Return which field of a message does not fit: ``Twist.linear.x: expected float64, got 'fast'``; '' if all fit."""
    name = cls.__ros_type__.rpartition("/")[2]
    return next(_wrong_in(cls, message, name), "")


def explain_value(kind: FieldType, value: Any, path: str) -> str:
    """Return the mistake in one field's value; '' if it fits."""
    return next(_wrong(kind, value, path), "")


def _wrong_in(cls: type[Message], message: Any, path: str) -> Iterator[str]:
    if not isinstance(message, cls):
        yield _expected(path, cls.__ros_type__, message)
        return
    for name, kind in cls.__ros_fields__.items():
        yield from _wrong(kind, getattr(message, name), f"{path}.{name}")


def _wrong(kind: FieldType, value: Any, path: str) -> Iterator[str]:
    if kind.shape == "one":
        yield from _wrong_element(kind, value, path)
        return
    if isinstance(value, str) or not isinstance(value, Sized) or not hasattr(value, "__iter__"):
        yield _expected(path, str(kind), value)
        return
    if (kind.shape == "array" and len(value) != kind.size) or (kind.shape == "bounded" and len(value) > kind.size):
        yield f"{path}: expected {kind}, got {len(value)} elements"
        return
    elements: Any = value
    for index, element in enumerate(elements):
        yield from _wrong_element(kind, element, f"{path}[{index}]")


def _wrong_element(kind: FieldType, value: Any, path: str) -> Iterator[str]:
    if kind.message is not None:
        yield from _wrong_in(kind.message, value, path)
    elif kind.base in ("string", "wstring"):
        yield from _wrong_string(kind, value, path)
    elif kind.base == "bool":
        if not _is_bool(value):
            yield _expected(path, "bool", value)
    else:
        try:
            struct.pack("<" + CODES[kind.base], value)
        except (struct.error, OverflowError, TypeError, ValueError):
            yield _expected(path, kind.base, value)


def _wrong_string(kind: FieldType, value: Any, path: str) -> Iterator[str]:
    if not isinstance(value, str):
        yield _expected(path, kind.base, value)
        return
    try:
        value.encode()
    except UnicodeEncodeError:
        yield f"{path}: {value!r:.60} is not valid Unicode"
        return
    if kind.string_bound and len(value) > kind.string_bound:
        yield f"{path}: expected at most {kind.string_bound} characters, got {len(value)}"


def _expected(path: str, what: str, value: Any) -> str:
    text = repr(value)
    is_comma = "float" in what and type(value) is tuple and len(value) == 2 and all(type(each) is int for each in value)
    advice = f"; a decimal number has a point: {value[0]}.{value[1]}" if is_comma else ""
    return f"{path}: expected {what}, got {text if len(text) <= 60 else text[:57] + '...'}{advice}"


def _is_bool(value: Any) -> bool:
    return isinstance(value, bool) or type(value).__name__ in ("bool_", "bool") or value in (0, 1)


def bools(values: Any) -> bytes:
    """Return a bool sequence's bytes. Raises TypeError for any but True and False (and 1, 0 and numpy's)."""
    for value in values:
        if not _is_bool(value):
            raise TypeError(f"{value!r} is not a bool")
    return bytes(bool(value) for value in values)


def instance(value: Any, cls: type[Message]) -> None:
    """Raise TypeError unless `value` is of the class, even if it has the same fields as one that is."""
    if not isinstance(value, cls):
        raise TypeError(f"{value!r:.60} is not a {cls.__ros_type__}")


def fixed(values: Any, size: int) -> None:
    """Raise ValueError unless there are `size` values."""
    if len(values) != size:
        raise ValueError(f"{len(values)} elements, not {size}")
