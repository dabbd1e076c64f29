"""Stamps that are set when a message is sent: `header: auto` and `stamp: now`, as in `ros2 topic pub`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robolink.message import decode, encode, from_builtins

if TYPE_CHECKING:
    from robolink.message import FieldType, Message
    from robolink.time import Time

HEADER, TIME = "std_msgs/msg/Header", "builtin_interfaces/msg/Time"

Path = tuple["str | int", ...]


class Stamped:
    """A message, with those of its stamps that are to be the time of sending."""

    def __init__(self, msg_type: type[Any], data: Any) -> None:
        """`data` is the message as plain data. Raises EncodeError that names the field which does not fit."""
        self._paths: list[Path] = []
        made = from_builtins(msg_type, self._without_words(msg_type.__ros_fields__, data, ()))
        self.message = decode(msg_type, encode(made))  # as it will arrive: 3 becomes 3.0 where a float stands
        self._stamps = [_at(self.message, path) for path in self._paths]

    def stamp(self, now: Time) -> None:
        """Set the stamps to `now`."""
        seconds, nanoseconds = divmod(now.nanoseconds, 10**9)
        for each in self._stamps:
            each.sec, each.nanosec = seconds, nanoseconds

    def _without_words(self, fields: dict[str, FieldType], data: Any, path: Path) -> Any:
        """Return the data without `auto` and `now`, and record their places."""
        if not isinstance(data, dict):
            return data
        return {name: self._value(fields.get(name), value, (*path, name)) for name, value in data.items()}

    def _value(self, kind: FieldType | None, value: Any, path: Path) -> Any:
        if kind is None or kind.message is None:
            return value
        if kind.shape == "one":
            return self._nested(kind.message, value, path)
        if not isinstance(value, list):
            return value
        return [self._nested(kind.message, each, (*path, index)) for index, each in enumerate(value)]

    def _nested(self, cls: type[Message], value: Any, path: Path) -> Any:
        if cls.__ros_type__ == HEADER and value == "auto":
            self._paths.append((*path, "stamp"))
            return {}
        if cls.__ros_type__ == TIME and value == "now":
            self._paths.append(path)
            return {}
        return self._without_words(cls.__ros_fields__, value, path)


def _at(message: Any, path: Path) -> Any:
    for step in path:
        message = message[step] if isinstance(step, int) else getattr(message, step)
    return message
