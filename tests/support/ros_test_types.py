"""ROS 2's test_msgs, types that have one of everything: made of the files of the tests' workspace, and filled."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from robolink import interfaces
from robolink.message import FieldType, Message
from robolink.workspace.interfaces import WorkspaceTypes

WORKSPACE = Path(__file__).parents[1] / "data" / "workspace"
PACKAGE = WORKSPACE / "src" / "test_msgs"

_TEXTS = {"low": "", "middle": "Hello, wörld!", "high": "\N{HIRAGANA LETTER A}" * 7}  # 21 of the 22 bytes there may be
_FLOATS = {"low": -1.125, "middle": 1.125, "high": 2.0**100}
_BITS = {"int8": 8, "int16": 16, "int32": 32, "int64": 64}


def _made() -> list[SimpleNamespace]:
    """Make the classes; no other test finds them by their names."""
    types = WorkspaceTypes()
    types.add(WORKSPACE)
    interfaces.add_source(types)
    try:
        return [
            SimpleNamespace(
                **{each.stem: types.get("test_msgs", kind, each.stem) for each in (PACKAGE / kind).iterdir()}
            )
            for kind in ("msg", "srv", "action")
        ]
    finally:
        interfaces.remove_source(types)


msg, srv, action = _made()
"""The classes by their names, as ``msg.Arrays``."""


def filled_messages(cls: type[Any]) -> list[Message]:
    """Return four messages of a type: as it is when new, and with the lowest, middle and highest value in each field.

    Sequences have no elements, two, and as many as they may have or three.
    """
    return [cls(), *(_filled(cls, level) for level in ("low", "middle", "high"))]


def _filled(cls: type[Any], level: str) -> Any:
    return cls(**{name: _value(kind, level) for name, kind in cls.__ros_fields__.items()})


def _value(kind: FieldType, level: str) -> Any:
    if kind.shape == "one":
        return _one(kind, level)
    count = {"low": 0, "middle": 2, "high": 3}[level]
    return [_one(kind, level) for _ in range(kind.size if kind.shape == "array" else count)]


def _one(kind: FieldType, level: str) -> Any:
    if kind.message is not None:
        return _filled(kind.message, level)
    base = kind.base
    if base in ("string", "wstring"):
        return _TEXTS[level]
    if base in ("float32", "float64"):
        return _FLOATS[level]
    if base == "bool":
        return level != "low"
    if base == "byte":
        return {"low": b"\x00", "middle": b"\x7f", "high": b"\xff"}[level]
    if base in _BITS:
        half = 1 << (_BITS[base] - 1)
        return {"low": -half, "middle": 0, "high": half - 1}[level]
    bits = _BITS[base.removeprefix("u")] if base != "char" else 8
    return {"low": 0, "middle": 1, "high": (1 << bits) - 1}[level]
