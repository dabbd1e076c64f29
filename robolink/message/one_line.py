"""A message on one line, as short as it can be told: what is not zero, empty or the default, by its path."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from robolink.exceptions import shown
from robolink.message.show import Style, shown_data

ELEMENTS = 4
"""Elements of a sequence that are shown."""
MEASURED = 10_000
"""Numbers of which the least and the greatest are told; of more, an image say, only the first."""
WIDTH = 160
"""Characters, after which a line ends in `...`."""
_TEXTS = Style(longest=60)


def short(message: Any) -> str:
    """Give a message on one line.

    >>> from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
    >>> short(Twist(linear=Vector3(x=0.25)))
    'linear.x=0.25'

    A header is left out: it hides what one looks for. Nothing is left of a message that is all zero.
    """
    return shown("".join(_joined(_leaves(message, type(message)(), ""))), WIDTH)


def _joined(leaves: Iterable[tuple[str, Any]]) -> Iterator[str]:
    """Yield the parts of the line; fields of the same part of a message stand together, as `linear.x=1 .y=2`."""
    before, first = "", True
    for path, value in leaves:
        inside, _, name = path.rpartition(".")
        if inside and inside == before:
            yield f" .{name}={_text(value)}"
        else:
            yield f"{'' if first else ', '}{path}={_text(value)}"
        before, first = inside, False


def _leaves(message: Any, usual: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Yield the fields that differ from the default."""
    for name in message.__ros_fields__:
        here = f"{path}.{name}" if path else name
        value, other = getattr(message, name), getattr(usual, name)
        if here == "header":
            continue
        if hasattr(value, "__ros_fields__"):
            yield from _leaves(value, other, here)
        elif (data := _plain(value)) != _plain(other):
            yield here, data


def _plain(value: Any) -> Any:
    """Give a field as plain data; of a sequence what is short."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
        return shown_data(value, _TEXTS)
    first = shown_data(value[:ELEMENTS], _TEXTS)
    if len(value) <= ELEMENTS:
        return first
    finite = (
        [each for each in value if isinstance(each, (int, float)) and math.isfinite(each)] if _is_few(value) else []
    )
    return _Numbers(len(value), min(finite), max(finite)) if finite else [*first, ...]


class _Numbers(NamedTuple):
    """Many numbers: how many, the least finite one and the greatest."""

    length: int
    least: float
    greatest: float


def _is_few(value: Any) -> bool:
    return len(value) <= MEASURED and hasattr(value, "typecode")  # arrays of numbers


def _text(value: Any) -> str:
    if isinstance(value, _Numbers):
        return f"{value.length} from {_text(value.least)} to {_text(value.greatest)}"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list):
        return f"[{', '.join(map(_text, value))}]"
    if isinstance(value, dict):  # an element of a sequence of messages
        return f"{{{', '.join(f'{name}: {_text(each)}' for name, each in value.items())}}}"
    return "..." if value is ... else repr(value)
