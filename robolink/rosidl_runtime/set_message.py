"""Fill a message from plain data, as `ros2 topic pub` and `ros2 service call` do."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any

from robolink.exceptions import EncodeError, nearest
from robolink.message import FieldType, Message, message_type
from robolink.message.check import explain_value

HEADER, TIME = "std_msgs/msg/Header", "builtin_interfaces/msg/Time"

Setter = Callable[[Any], None]
"""Puts a builtin_interfaces Time into the message."""


class UnknownFieldError(EncodeError, AttributeError):
    """The data names a field that the message has not."""


def set_message_fields(
    msg: Any, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Setter]:
    """Set fields of a message from a mapping; those that it leaves out stay as they are.

    With `expand_header_auto`, 'auto' for a Header, and with `expand_time_now`, 'now' for a Time, stand for a time that
    is put in later: the functions that are given do it. Raises UnknownFieldError (an AttributeError), and EncodeError
    (a TypeError and a ValueError) that names the field whose value does not fit; the message is as before then.
    """
    filling = _Filling(expand_header_auto, expand_time_now)
    changes = filling.changes(msg, values, type(msg).__name__)
    for name, value in changes.items():
        setattr(msg, name, value)
    return [functools.partial(_put, msg, path) for path in filling.paths]


class _Filling:
    """Turns data into values of fields, and notes where times are to be put in."""

    def __init__(self, auto: bool, now: bool) -> None:
        self.auto, self.now = auto, now
        self.paths: list[tuple[str | int, ...]] = []

    def changes(self, msg: Any, values: Any, where: str, path: tuple[str | int, ...] = ()) -> dict[str, Any]:
        """Give the new value of each field that is named."""
        fields = message_type(type(msg)).__ros_fields__
        if not isinstance(values, Mapping):
            kind = type(values).__name__
            raise EncodeError(f"Value '{values}' is expected to be a dictionary but is a {kind} ({where})")
        made = {}
        for name, value in values.items():
            if name not in fields:
                listed = ", ".join(fields) or "none"
                raise UnknownFieldError(f"{where}: no field '{name}'{nearest(str(name), fields)}; it has {listed}")
            made[name] = self.value(fields[name], getattr(msg, name), value, f"{where}.{name}", (*path, name))
        return made

    def value(self, kind: FieldType, old: Any, value: Any, where: str, path: tuple[str | int, ...]) -> Any:
        """Give what a field is set to."""
        if kind.message is None:
            made = _converted(kind, value, where)
        elif kind.shape == "one":
            made = self.nested(kind.message, old, value, where, path)
        elif isinstance(value, (list, tuple)):
            made = [
                self.nested(kind.message, None, each, f"{where}[{at}]", (*path, at)) for at, each in enumerate(value)
            ]
        else:
            raise EncodeError(f"{where}: expected {kind}, got {value!r:.60}")
        wrong = explain_value(kind, made, where)
        if wrong:
            raise EncodeError(wrong)
        return made

    def nested(self, cls: type[Message], old: Any, value: Any, where: str, path: tuple[str | int, ...]) -> Any:
        """Give a message within a message: the one given, or one made of a mapping."""
        if isinstance(value, cls):
            return value
        made = cls()
        if value == "auto" and cls.__ros_type__ == HEADER and self.auto:
            self.paths.append((*path, "stamp"))
            return old if old is not None else made
        if value == "now" and cls.__ros_type__ == TIME and self.now:
            self.paths.append(path)
            return made
        for name, each in self.changes(made, value, where, path).items():
            setattr(made, name, each)
        return made


def _converted(kind: FieldType, value: Any, where: str) -> Any:
    """Give a primitive as the field has it: text that is a number, a number for a text, as ros2 takes them."""
    if kind.shape != "one":
        elements = list(value) if hasattr(value, "__iter__") and not isinstance(value, (str, Mapping)) else None
        if elements is None:
            raise EncodeError(f"{where}: expected {kind}, got {value!r:.60}")
        element = FieldType(base=kind.base, string_bound=kind.string_bound)
        return value if kind.code else [_converted(element, each, where) for each in elements]
    try:
        if kind.base in ("string", "wstring"):
            return value if isinstance(value, str) else str(value)
        if kind.base in ("float32", "float64"):
            return float(value)
        if kind.base == "byte" and isinstance(value, int):
            return bytes((value,))
        return int(value) if kind.code and isinstance(value, str) else value
    except (TypeError, ValueError) as error:
        raise EncodeError(f"{where}: expected {kind}, got {value!r:.60} ({error})") from None


def _put(msg: Any, path: tuple[str | int, ...], stamp: Any) -> None:
    for step in path[:-1]:
        msg = msg[step] if isinstance(step, int) else getattr(msg, step)
    if isinstance(path[-1], int):
        msg[path[-1]] = stamp
    else:
        setattr(msg, path[-1], stamp)
