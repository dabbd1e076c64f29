"""Validation of a message's fields, once packing it has failed: slow, and only then."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sized
from typing import Any

from robolink.message.annotations import FieldType
from robolink.message.base import Message
from robolink.message.cdr_layout import CODES


def explain(cls: type[Message], message: Any) -> str:
    """Return which field of a message does not fit: ``Twist.linear.x: expected float64, got 'fast'``; '' if all fit."""
    name = cls.__ros_type__.rpartition("/")[2]
    return next(_wrong_in(cls, message, name), "")


def explain_value(kind: FieldType, value: Any, path: str) -> str:
    """Return what of one field's value does not fit; '' if all does."""
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
        raise TypeError(f"{value!r:.60} is no {cls.__ros_type__}")


def fixed(values: Any, size: int) -> None:
    """Raise ValueError unless there are `size` values."""
    if len(values) != size:
        raise ValueError(f"{len(values)} elements, not {size}")
