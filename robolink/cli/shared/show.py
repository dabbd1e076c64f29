"""Formatting of messages for output: YAML like ros2's, comma-separated values, or standard JSON."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import EncodeError, nearest
from robolink.message.show import LONGEST, USUAL, Style, as_csv, as_yaml, plain

if TYPE_CHECKING:
    from robolink.message import FieldType, Message

__all__ = ["LONGEST", "USUAL", "Style", "as_csv", "as_json", "as_yaml", "check_path", "field_of", "plain"]

_STEP = re.compile(r"(?P<name>[A-Za-z]\w*)|\[(?P<index>-?\d{1,18})\]", re.ASCII)


def as_json(value: Any) -> str:
    """Return a value as one line of JSON. Infinity is written 1e999, which readers take as infinite, and NaN null."""
    import msgspec

    return msgspec.json.encode(_finite(plain(value))).decode()


def field_of(message: Any, path: str) -> Any:
    """Return the field ``linear.x`` or ``ranges[0]`` of a message. Raises EncodeError that names what there is."""
    check_path(type(message), path)
    value = message
    for step in _steps(path):
        try:
            value = getattr(value, step) if isinstance(step, str) else value[step]
        except IndexError:
            raise EncodeError(f"--field {path}: there are {len(value)} elements, no [{step}]") from None
    return value


def check_path(msg_type: type[Message], path: str) -> FieldType:
    """Return the type of a field ``linear.x`` or ``ranges[0]``. Raises EncodeError if the message has no such field."""
    from robolink.message import FieldType

    kind = FieldType(base=msg_type.__ros_type__, message=msg_type)
    for step in _steps(path):
        is_sequence = kind.shape != "one"
        if isinstance(step, int):
            if not is_sequence:
                raise EncodeError(f"--field {path}: what stands before [{step}] is not a sequence")
            kind = FieldType(base=kind.base, message=kind.message, string_bound=kind.string_bound)
            continue
        fields = {} if kind.message is None or is_sequence else kind.message.__ros_fields__
        if step not in fields:
            there = "it is a sequence: say which, as in [0]" if is_sequence else f"there is {_listed(fields)}"
            raise EncodeError(f"--field {path}: no field '{step}'{nearest(step, fields)}; {there}")
        kind = fields[step]
    return kind


def _steps(path: str) -> list[str | int]:
    steps: list[str | int] = []
    at = 0
    for match in _STEP.finditer(path):
        if path[at : match.start()] != ("." if match["name"] and at else ""):
            break
        steps.append(match["name"] or int(match["index"]))
        at = match.end()
    if at != len(path) or not path:
        raise EncodeError(f"--field: expected a path such as linear.x or ranges[0], got '{path}'")
    return steps


def _listed(fields: Iterable[str]) -> str:
    return ", ".join(fields) or "nothing in it"


def _finite(data: Any) -> Any:
    import msgspec

    if isinstance(data, float) and not math.isfinite(data):
        return None if math.isnan(data) else msgspec.Raw(b"1e999" if data > 0 else b"-1e999")
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_finite(each) for each in data]
    return data
