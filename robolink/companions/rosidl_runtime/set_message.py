"""Filling of a message from plain data, as `ros2 topic pub` and `ros2 service call` do."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any

from robolink.exceptions import EncodeError, nearest
from robolink.message import FieldType, Message, message_type
from robolink.message.check import explain_value
from robolink.message.convert import UnknownFieldError, converted

HEADER, TIME = "std_msgs/msg/Header", "builtin_interfaces/msg/Time"

Setter = Callable[[Any], None]
"""Function that sets a builtin_interfaces Time in the message."""


def set_message_fields(
    msg: Any, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Setter]:
    """Set fields of a message from a mapping; those that it leaves out stay as they are.

    Args:
        msg: The message, which stays as it was if an error is raised.
        values: Values by field name, nested messages as mappings.
        expand_header_auto: True takes 'auto' for a Header, whose stamp is set later.
        expand_time_now: True takes 'now' for a Time, which is set later.

    Returns:
        The functions that set these times; each takes a builtin_interfaces Time.

    Raises:
        UnknownFieldError: (an AttributeError) if there is no such field.
        EncodeError: (a TypeError and a ValueError) if a value does not fit, with the field's name.
    """
    filling = _Filling(expand_header_auto, expand_time_now)
    changes = filling.changes(msg, values, type(msg).__name__)
    for name, value in changes.items():
        setattr(msg, name, value)
    return [functools.partial(_put, msg, path) for path in filling.paths]


class _Filling:
    """Conversion of data into values of fields, with notes of the times that are to be set."""

    def __init__(self, auto: bool, now: bool) -> None:
        self.auto, self.now = auto, now
        self.paths: list[tuple[str | int, ...]] = []

    def changes(self, msg: Any, values: Any, where: str, path: tuple[str | int, ...] = ()) -> dict[str, Any]:
        """Return the new value of each field that is named."""
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
        """Return the new value of a field."""
        if kind.message is None:
            made = converted(kind, value, where)
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
        """Return a nested message: the one given, or one made of a mapping."""
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


def _put(msg: Any, path: tuple[str | int, ...], stamp: Any) -> None:
    for step in path[:-1]:
        msg = msg[step] if isinstance(step, int) else getattr(msg, step)
    if isinstance(path[-1], int):
        msg[path[-1]] = stamp
    else:
        setattr(msg, path[-1], stamp)
