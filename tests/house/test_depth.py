"""The depth of a QoS profile bounds a queue in one module: there alone a receiver stores, and a publisher retains."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import robolink

ROOT = Path(robolink.__file__).parent
PLACE = "transport/history.py"
TOOLS = "bag", "cli", "counterparts", "companions"
"""Rooms of tools and of users' programs, whose queues are no part of how messages get to a receiver."""


def bounds(source: str) -> Iterator[str]:
    """Return the expressions of a source by which a depth bounds something: a deque's size, or the last of a list."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Call) and ast.unparse(node.func).partition("[")[0] in ("deque", "collections.deque"):
            sizes = [each.value for each in node.keywords if each.arg == "maxlen"] + node.args[1:]
            yield from (ast.unparse(each) for each in sizes if _is_depth(each))
        elif isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Slice) and _is_depth(node.slice.lower):
            yield ast.unparse(node)


def _is_depth(expression: ast.expr | None) -> bool:
    names = ast.walk(expression) if expression is not None else ()
    return any("depth" in (getattr(each, "id", "") + getattr(each, "attr", "")) for each in names)


def read_depths(source: str) -> Iterator[str]:
    """Return the places of a source that read the depth of a profile with its defaults filled in."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute) and node.attr == "depth" and "resolved(" in ast.unparse(node.value):
            yield ast.unparse(node)


def files() -> dict[str, str]:
    """Return the sources that name a depth, by their paths."""
    found = (each for each in ROOT.rglob("*.py") if each.relative_to(ROOT).parts[0] not in TOOLS)
    texts = {each.relative_to(ROOT).as_posix(): each.read_text(encoding="utf-8") for each in found}
    return {name: text for name, text in texts.items() if "depth" in text}


def test_a_bound_by_depth_is_found() -> None:
    source = (
        "a = deque(maxlen=qos.depth)\nb = deque[int]((), depth or None)\nc = deque(maxlen=9)\nd = b[-depth:] + b[1:]"
    )
    assert sorted(bounds(source)) == ["b[-depth:]", "depth or None", "qos.depth"]
    assert list(read_depths("a = resolved(qos).depth\nb = qos.depth")) == ["resolved(qos).depth"]


def test_depth_bounds_a_queue_in_one_module() -> None:
    assert {name: found for name, source in files().items() if (found := sorted(bounds(source)))} == {
        PLACE: ["depth", "depth or None"]
    }


def test_the_depth_of_a_profile_is_read_in_one_module() -> None:
    assert {name for name, source in files().items() if any(read_depths(source))} == {PLACE}
