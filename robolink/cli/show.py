"""How commands show messages: as YAML like ros2, or as JSON that every reader takes."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import EncodeError, nearest
from robolink.message import to_builtins

if TYPE_CHECKING:
    from robolink.message import Message

LONGEST = 128
"""Elements of a sequence, and characters of a text, that are shown unless all are asked for."""

_STEP = re.compile(r"(?P<name>[A-Za-z]\w*)|\[(?P<index>-?\d{1,18})\]", re.ASCII)


def as_yaml(value: Any, longest: int | None = LONGEST) -> str:
    """YAML in block style; what is longer than `longest` ends in '...'."""
    import yaml

    class Dumper(yaml.SafeDumper):
        """Writes text whose line breaks only Unicode knows with escapes: bare, it would be read back as others."""

    def text_node(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
        style = '"' if any(each in text for each in "\x85\u2028\u2029") else None
        return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)

    Dumper.add_representer(str, text_node)
    data = _cut(plain(value), longest)
    text = yaml.dump(data, Dumper=Dumper, default_flow_style=False, sort_keys=False, allow_unicode=True, width=math.inf)
    return text.removesuffix("\n...\n").removesuffix("\n")


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
    check_path(type(message), path)
    value = message
    for step in _steps(path):
        try:
            value = getattr(value, step) if isinstance(step, str) else value[step]
        except IndexError:
            raise EncodeError(f"--field {path}: there are {len(value)} elements, no [{step}]") from None
    return value


def check_path(msg_type: type[Message], path: str) -> None:
    """Raise EncodeError unless a message of the type can have ``linear.x`` or ``ranges[0]``."""
    holder: type[Message] | None = msg_type
    is_sequence = False
    for step in _steps(path):
        if isinstance(step, int):
            if not is_sequence:
                raise EncodeError(f"--field {path}: what stands before [{step}] is no sequence")
            is_sequence = False
            continue
        fields = {} if holder is None or is_sequence else holder.__ros_fields__
        if step not in fields:
            there = "it is a sequence: say which, as in [0]" if is_sequence else f"there is {_listed(fields)}"
            raise EncodeError(f"--field {path}: no field '{step}'{nearest(step, fields)}; {there}")
        holder, is_sequence = fields[step].message, fields[step].shape != "one"


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
