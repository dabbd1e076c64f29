"""How commands show messages: as YAML like ros2, as values between commas, or as JSON that every reader takes."""

from __future__ import annotations

import functools
import math
import re
from array import array
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import EncodeError, nearest
from robolink.message import to_builtins

if TYPE_CHECKING:
    from robolink.message import FieldType, Message

LONGEST = 128
"""Elements of a sequence, and characters of a text, that are shown unless all are asked for."""

WIDEST = 2**31 - 1
"""Columns of a line of YAML: it is never broken."""

_STEP = re.compile(r"(?P<name>[A-Za-z]\w*)|\[(?P<index>-?\d{1,18})\]", re.ASCII)
_C_NAMES = {"float32": "float", "float64": "double", "bool": "boolean", "byte": "octet", "char": "uint8"}
"""What ROS's primitives are called where a sequence is only described."""


class Style(NamedTuple):
    """How much of a message is shown, and in which style of YAML."""

    longest: int | None = LONGEST
    """Elements, or characters, after which comes '...'; None for all."""
    arrays: bool = True
    """Whether sequences are shown, or only described."""
    strings: bool = True
    """Whether texts are shown, or only described."""
    flow: bool = False
    """YAML's {a: [1, 2]} in place of indented blocks."""


USUAL = Style()


def as_yaml(value: Any, style: Style = USUAL) -> str:
    """YAML of a message or of a field of one, without the last line break."""
    import yaml

    text = yaml.dump(
        _shown(value, style),
        Dumper=_dumper(),
        default_flow_style=style.flow,
        sort_keys=False,
        allow_unicode=True,
        width=WIDEST,
    )
    return text.removesuffix("\n...\n").removesuffix("\n")


@functools.cache
def _dumper() -> Any:
    import yaml

    base: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)  # libyaml's, where there is one: five times as fast

    class Dumper(base):  # type: ignore[misc]
        """Writes text whose line breaks only Unicode knows with escapes: bare, it would be read back as others."""

    def text_node(dumper: Any, text: str) -> Any:
        quote = '"' if any(each in text for each in "\x85\u2028\u2029") else None
        return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=quote)

    Dumper.add_representer(str, text_node)
    return Dumper


def as_csv(value: Any, style: Style = USUAL) -> str:
    """The values of all fields, also those deep inside, with commas between them; text stands as it is, as in ros2."""
    return ",".join(map(str, _leaves(_shown(value, style))))


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
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
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


def check_path(msg_type: type[Message], path: str) -> FieldType:
    """Give what ``linear.x`` or ``ranges[0]`` of a message is. Raises EncodeError when the type has no such thing."""
    from robolink.message import FieldType

    kind = FieldType(base=msg_type.__ros_type__, message=msg_type)
    for step in _steps(path):
        is_sequence = kind.shape != "one"
        if isinstance(step, int):
            if not is_sequence:
                raise EncodeError(f"--field {path}: what stands before [{step}] is no sequence")
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


def _shown(value: Any, style: Style, kind: FieldType | None = None) -> Any:
    """Give what is shown of a value as plain data; what is cut off is never converted, so images cost nothing."""
    if hasattr(value, "__ros_fields__"):
        return {name: _shown(getattr(value, name), style, each) for name, each in value.__ros_fields__.items()}
    if isinstance(value, dict):
        return {name: _shown(each, style) for name, each in value.items()}
    if isinstance(value, str):
        return _text(value, style)
    if _is_sequence(value):
        if not style.arrays and kind is not None:
            return _described(value, kind)
        first = plain(value[: style.longest]) if hasattr(value, "tolist") else value[: style.longest]
        elements = [_shown(each, style) for each in first]
        return elements if style.longest is None or len(value) <= style.longest else [*elements, "..."]
    return plain(value)


def _is_sequence(value: Any) -> bool:
    is_numpy = hasattr(value, "shape") and len(value.shape) > 0
    return is_numpy or isinstance(value, (list, tuple, array, memoryview))


def _text(value: str, style: Style) -> str:
    if not style.strings:
        return f"<string length: <{len(value)}>>"
    return value if style.longest is None or len(value) <= style.longest else value[: style.longest] + "..."


def _described(value: Any, kind: FieldType) -> str:
    name = _C_NAMES.get(kind.base, kind.base)
    if kind.shape == "array":
        return f"<array type: {name}[{kind.size}]>"
    bound = f"[{kind.size}]" if kind.shape == "bounded" else ""
    return f"<sequence type: {name}{bound}, length: {len(value)}>"


def _leaves(data: Any) -> Iterator[Any]:
    if data in ([], {}):
        yield ""
    elif isinstance(data, (dict, list)):
        for each in data.values() if isinstance(data, dict) else data:
            yield from _leaves(each)
    else:
        yield data


def _finite(data: Any) -> Any:
    import msgspec

    if isinstance(data, float) and not math.isfinite(data):
        return None if math.isnan(data) else msgspec.Raw(b"1e999" if data > 0 else b"-1e999")
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_finite(each) for each in data]
    return data
