"""How commands show messages: as YAML like ros2, or as JSON that every reader takes."""

from __future__ import annotations

import math
import re
from typing import Any

from robolink.exceptions import EncodeError, nearest
from robolink.message import to_builtins

LONGEST = 128
"""Elements of a sequence, and characters of a text, that are shown unless all are asked for."""

_STEP = re.compile(r"([A-Za-z]\w*)|\[(-?\d+)\]")


def as_yaml(value: Any, longest: int | None = LONGEST) -> str:
    """YAML in block style; what is longer than `longest` ends in '...'."""
    import yaml

    data = _cut(plain(value), longest)
    text = yaml.safe_dump(data, default_flow_style=False, sort_keys=False, allow_unicode=True, width=math.inf)
    return text.removesuffix("...\n").rstrip("\n")


def as_json(value: Any) -> str:
    """One line of JSON. What is infinite is written 1e999, which readers take as infinite, and NaN is null."""
    import msgspec

    return msgspec.json.encode(_finite(plain(value))).decode()


def plain(value: Any) -> Any:
    """Give a message, or a field of one, as dicts, lists and scalars."""
    if hasattr(value, "__ros_fields__"):
        return to_builtins(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return value[0] if isinstance(value, bytes) and len(value) == 1 else value


def field_of(message: Any, path: str) -> Any:
    """Give ``linear.x`` or ``ranges[0]`` of a message. Raises EncodeError that names what there is instead."""
    value, at = message, 0
    for match in _STEP.finditer(path):
        if path[at : match.start()] not in ("", "."):
            break
        value, at = _step(value, match, path), match.end()
    if at != len(path) or not path:
        raise EncodeError(f"--field: expected a path such as linear.x or ranges[0], got '{path}'")
    return value


def _step(value: Any, match: re.Match[str], path: str) -> Any:
    name, index = match.groups()
    if name is not None:
        fields = list(getattr(value, "__ros_fields__", ()))
        if name not in fields:
            raise EncodeError(f"--field {path}: no field '{name}'{nearest(name, fields)}; there is {_listed(fields)}")
        return getattr(value, name)
    try:
        return value[int(index)]
    except IndexError:
        raise EncodeError(f"--field {path}: there are {len(value)} elements, no [{index}]") from None
    except TypeError:
        raise EncodeError(f"--field {path}: what stands before [{index}] is no sequence") from None


def _listed(fields: list[str]) -> str:
    return ", ".join(fields) or "nothing in it"


def _cut(data: Any, longest: int | None) -> Any:
    if longest is None:
        return data
    if isinstance(data, dict):
        return {key: _cut(value, longest) for key, value in data.items()}
    if isinstance(data, list):
        shown = [_cut(each, longest) for each in data[:longest]]
        return [*shown, "..."] if len(data) > longest else shown
    if isinstance(data, str) and len(data) > longest:
        return data[:longest] + "..."
    return data


def _finite(data: Any) -> Any:
    import msgspec

    if isinstance(data, float) and not math.isfinite(data):
        return None if math.isnan(data) else msgspec.Raw(b"1e999" if data > 0 else b"-1e999")
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_finite(each) for each in data]
    return data
