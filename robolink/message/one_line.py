"""Summary of a message on one line: the fields that are not zero, empty or the default, by their paths."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from robolink.message.show import Style, shown_data
from robolink.system.terminal import shown

ELEMENTS = 4
"""Upper bound of the elements shown of a sequence."""
MEASURED = 10_000
"""Longest sequence of which the least and the greatest number are shown; of a longer one, an image say, the first."""
WIDTH = 110
"""Width of a line in characters; a longer one leaves out what is before a scan's ranges, else what is last."""
_TEXTS = Style(longest=60)


def short(message: Any) -> str:
    """Return a message on one line.

    >>> from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
    >>> short(Twist(linear=Vector3(x=0.25)))
    'linear.x=0.25'

    A header is left out: it hides what one looks for; of an element of a sequence, such as a transform, its frame
    stays. Nothing is left of a message that is all zero.
    """
    leaves = list(_leaves(message, type(message)(), ""))
    text = _line(leaves)
    if len(text) > WIDTH and leaves and isinstance(leaves[-1][1], _Numbers):
        first, last = leaves[:-1], f", ..., {_line(leaves[-1:])}"
        while len(first) > 1 and len(_line(first)) + len(last) > WIDTH:
            first.pop()
        text = _line(first) + last
    return shown(text, WIDTH)


def _line(leaves: Iterable[tuple[str, Any]]) -> str:
    return "".join(_joined(leaves))


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
    """Return a field as plain data; of a sequence only a part."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
        return shown_data(value, _TEXTS)
    if hasattr(next(iter(value), None), "__ros_fields__"):
        return [*map(_element, value[:ELEMENTS]), *([...] if len(value) > ELEMENTS else [])]
    first = shown_data(value[:ELEMENTS], _TEXTS)
    if len(value) <= ELEMENTS:
        return first
    finite = (
        [each for each in value if isinstance(each, (int, float)) and math.isfinite(each)] if _is_few(value) else []
    )
    return _Numbers(len(value), min(finite), max(finite)) if finite else [*first, ...]


class _Element(str):
    """A message in a sequence, on one line."""

    __slots__ = ()


def _element(message: Any) -> _Element:
    """Return an element of a sequence: its frame, and what is not the default."""
    frame = getattr(getattr(message, "header", None), "frame_id", "")
    framed = [("frame_id", shown_data(frame, _TEXTS))] if frame else []
    return _Element(f"{{{_line([*framed, *_leaves(message, type(message)(), '')])}}}")


class _Numbers(NamedTuple):
    """Summary of many numbers: how many, the least finite one and the greatest."""

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
    if isinstance(value, _Element):
        return value
    return "..." if value is ... else repr(value)
