"""YAML pitfalls in launch files: text that YAML reads as something else, each with what to write instead."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from robolink.launch.reading.substitution import Step
from robolink.system.terminal import shown

_BRACES = re.compile(r"\{\s*(?:[^\W\d]\w*|env:[^\s{}]+)\s*\}")
_QUOTED = re.compile(r"\"(?:\\.|[^\"\\])*\"|'[^']*'|(?:^|\s)#.*")
_JOINED = re.compile(r"\s*(?:- +)?([A-Za-z_]\w*:)[^\s:/\\].*")
_ALIAS = re.compile(r"(?:[\[{,]|[:-] )\s*\*")
_LISTS = {"nodes": "node: NAME", "include": "file: NAME", "groups": "nodes: [...]"}
"""Keys whose values are lists, and how an item of each begins."""
_BEGIN = "a launch file begins with `nodes:`, and below it each node with `- node: NAME`"


def hint(text: str, line: int) -> str:
    """Return what is probably wrong in a line, counted from 1, at which YAML parsing failed; '' if unknown."""
    near = [_QUOTED.sub("", each) for each in text.splitlines()[max(line - 2, 0) : line]]
    if near and (braces := _BRACES.search(near[-1])):
        return f"a value with {braces[0]} in it needs quotes here"
    if near and _ALIAS.search(near[-1]):
        return "a value that begins with '*' needs quotes"
    joined = next(filter(None, map(_JOINED.fullmatch, near)), None)
    return _space(joined) if joined else ""


def misshapen(data: Any, steps: tuple[Step, ...] = ()) -> Iterator[tuple[tuple[Step, ...], str]]:
    """Yield a message for each value of a launch file or group that should be a list or a mapping, with its steps."""
    if not isinstance(data, dict):
        yield steps, f"{_expected('mapping', data)}: {_instead(data)}"
        return
    for key in (each for each in _LISTS if each in data):
        listed, at = data[key], (*steps, key)
        is_below = listed is None and any(each.startswith("-") for each in data)  # `-node: NAME`, which is told of
        if not isinstance(listed, list) and not is_below:
            yield at, f"{_expected('list', listed)}: {_as_items(key, listed)}"
        for index, each in enumerate(listed if isinstance(listed, list) else ()):
            if not isinstance(each, dict):
                yield (*at, index), f"{_expected('mapping', each)}: {_as_item(key, each)}"
            elif key == "groups":
                yield from misshapen(each, (*at, index))
    if not steps and isinstance(data.get("arguments"), list):
        yield ("arguments",), "expected mapping, got list: write each as `NAME: DEFAULT`, without '-'"


def _expected(what: str, data: Any) -> str:
    kinds = {dict: "mapping", list: "list", type(None): "nothing"}
    return f"expected {what}, got {kinds.get(type(data)) or repr(shown(str(data)))}"


def _instead(data: Any) -> str:
    if isinstance(data, list):
        return "write `nodes:` above it"
    if isinstance(data, str) and (joined := _JOINED.fullmatch(data)):
        return _space(joined)
    return _BEGIN


def _as_items(key: str, data: Any) -> str:
    """Return how to write this value as a list."""
    if isinstance(data, dict):
        return "begin each with '- '"
    return f"begin each with '- ', as in `- {_as_named(key, data)}`"


def _as_item(key: str, data: Any) -> str:
    """Return how to write this item of a list as a mapping."""
    if isinstance(data, str) and (joined := _JOINED.fullmatch(data)):
        return _space(joined)
    return "one '-' too many" if isinstance(data, list) else f"write `{_as_named(key, data)}`"


def _as_named(key: str, data: Any) -> str:
    begin = _LISTS[key]
    return begin.replace("NAME", shown(data, 40)) if isinstance(data, str) and data.strip() else begin


def misreadings(
    data: Any, spelled: Callable[[Sequence[Step]], str], steps: tuple[Step, ...] = ()
) -> Iterator[tuple[tuple[Step, ...], str]]:
    """Yield the values that are valid YAML but were hardly meant so: the steps to each, and what is wrong.

    `spelled` returns the value at some steps as the text has it. `arguments: {speed}` is no such value.
    """
    if isinstance(data, dict):
        if list(data.values()) == [None] and steps != ("arguments",) and _BRACES.fullmatch(text := spelled(steps)):
            yield steps, f'{text} without quotes is a mapping: write "{text}"'
        for key, value in data.items():
            yield from misreadings(value, spelled, (*steps, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from misreadings(value, spelled, (*steps, index))


def _space(joined: re.Match[str]) -> str:
    return f"a space is missing behind '{joined[1]}'"
