"""Text of a message for people: YAML like ros2's, or comma-separated values; long ones are cut short."""

from __future__ import annotations

import functools
from array import array
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.message.convert import to_builtins
from robolink.message.slot_types import IDL_NAMES
from robolink.system.terminal import fit, is_fit

if TYPE_CHECKING:
    from robolink.message.annotations import FieldType

LONGEST = 128
"""Elements of a sequence, and characters of a text, that are shown unless all are asked for."""

WIDEST = 2**31 - 1
"""Width of a line of YAML in columns: it is never broken."""


class Style(NamedTuple):
    """Options of how much of a message is shown, and in which style of YAML."""

    longest: int | None = LONGEST
    """Elements, or characters, after which comes '...'; None for all."""
    arrays: bool = True
    """True shows sequences, False only describes them."""
    strings: bool = True
    """True shows texts, False only describes them."""
    flow: bool = False
    """True writes sequences as YAML's [1, 2], False as indented blocks. Fields always are blocks, as in ros2."""


USUAL = Style()


def as_yaml(value: Any, style: Style = USUAL) -> str:
    """Return the YAML of a message or a field, without the last line break; fit for a terminal, and the same text."""
    import yaml

    text = yaml.dump(
        shown_data(value, style),
        Dumper=_dumper(),
        default_flow_style=style.flow,
        sort_keys=False,
        allow_unicode=True,
        width=WIDEST,
    )
    return fit(text.removesuffix("\n...\n").removesuffix("\n"))


@functools.cache
def _dumper() -> Any:
    import yaml

    base: Any = getattr(yaml, "CSafeDumper", yaml.SafeDumper)  # libyaml's, where there is one: five times as fast

    class Dumper(base):  # type: ignore[misc]
        """Writes text that a terminal would obey in double quotes, within which escapes are read back."""

    def text_node(dumper: Any, text: str) -> Any:
        quote = None if is_fit(text) else '"'
        return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=quote)

    def byte_node(dumper: Any, octet: bytes) -> Any:  # as ros2 shows a byte: the character of its number
        return text_node(dumper, octet.decode("latin-1"))

    def mapping_node(dumper: Any, fields: dict[str, Any]) -> Any:
        return dumper.represent_mapping("tag:yaml.org,2002:map", fields.items(), flow_style=False)

    Dumper.add_representer(str, text_node)
    Dumper.add_representer(bytes, byte_node)
    Dumper.add_representer(dict, mapping_node)
    return Dumper


def as_csv(value: Any, style: Style = USUAL) -> str:
    """Return the values of all fields, nested ones too, separated by commas; text stands as it is, as in ros2."""
    return ",".join(map(str, _leaves(shown_data(value, style))))


def plain(value: Any) -> Any:
    """Return a message, or a field of one, as dicts, lists and scalars."""
    if hasattr(value, "__ros_fields__"):
        return to_builtins(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    return value[0] if isinstance(value, bytes) and len(value) == 1 else value


def shown_data(value: Any, style: Style, kind: FieldType | None = None) -> Any:
    """Return the shown part as plain data and bytes; the rest is never converted, so images cost nothing."""
    if hasattr(value, "__ros_fields__"):
        return {name: shown_data(getattr(value, name), style, each) for name, each in value.__ros_fields__.items()}
    if isinstance(value, dict):
        return {name: shown_data(each, style) for name, each in value.items()}
    if isinstance(value, str):
        return _text(value, style)
    if _is_sequence(value):
        if not style.arrays and kind is not None:
            return _described(value, kind)
        first = plain(value[: style.longest]) if hasattr(value, "tolist") else value[: style.longest]
        elements = [shown_data(each, style) for each in first]
        return elements if style.longest is None or len(value) <= style.longest else [*elements, "..."]
    return value if isinstance(value, bytes) else plain(value)


def _is_sequence(value: Any) -> bool:
    is_numpy = hasattr(value, "shape") and len(value.shape) > 0
    return is_numpy or isinstance(value, (list, tuple, array, memoryview))


def _text(value: str, style: Style) -> str:
    if not style.strings:
        return f"<string length: <{len(value)}>>"
    return value if style.longest is None or len(value) <= style.longest else value[: style.longest] + "..."


def _described(value: Any, kind: FieldType) -> str:
    name = IDL_NAMES.get(kind.base, kind.base)
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
