"""What people write in launch files that YAML takes for something else, and what they should write."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from robolink.exceptions import shown
from robolink.launch.reading.substitution import Step

_BRACES = re.compile(r"\{\s*(?:[^\W\d]\w*|env:[^\s{}]+)\s*\}")
_QUOTED = re.compile(r"\"(?:\\.|[^\"\\])*\"|'[^']*'|(?:^|\s)#.*")
_JOINED = re.compile(r"\s*(?:- +)?([A-Za-z_]\w*:)[^\s:/\\].*")
_ALIAS = re.compile(r"(?:[\[{,]|[:-] )\s*\*")
_LISTS = {"nodes": "node: NAME", "include": "file: NAME", "groups": "nodes: [...]"}
"""What a launch file lists, and how one of each begins."""
_BEGIN = "a launch file begins with `nodes:`, and below it each node with `- node: NAME`"


def hint(text: str, line: int) -> str:
    """Say what is probably wrong in a line, counted from 1, at which a text is no YAML; '' where nothing is known."""
    near = [_QUOTED.sub("", each) for each in text.splitlines()[max(line - 2, 0) : line]]
    if near and (braces := _BRACES.search(near[-1])):
        return f"a value with {braces[0]} in it needs quotes here"
    if near and _ALIAS.search(near[-1]):
        return "a value that begins with '*' needs quotes"
    joined = next(filter(None, map(_JOINED.fullmatch, near)), None)
    return _space(joined) if joined else ""


def misshapen(data: Any, steps: tuple[Step, ...] = ()) -> Iterator[tuple[tuple[Step, ...], str]]:
    """Yield what should be a list or a mapping in a launch file, or one of its groups, and is none: steps, message."""
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
    """Say how to write as a list what is none."""
    if isinstance(data, dict):
        return "begin each with '- '"
    return f"begin each with '- ', as in `- {_as_named(key, data)}`"


def _as_item(key: str, data: Any) -> str:
    """Say how to write an item of a list that is no mapping."""
    if isinstance(data, str) and (joined := _JOINED.fullmatch(data)):
        return _space(joined)
    return "one '-' too many" if isinstance(data, list) else f"write `{_as_named(key, data)}`"


def _as_named(key: str, data: Any) -> str:
    begin = _LISTS[key]
    return begin.replace("NAME", shown(data, 40)) if isinstance(data, str) and data.strip() else begin


def slips(
    data: Any, spelled: Callable[[Sequence[Step]], str], steps: tuple[Step, ...] = ()
) -> Iterator[tuple[tuple[Step, ...], str]]:
    """Yield what is YAML and was not meant so: the steps to it, and what is wrong.

    `spelled` gives what stands at some steps as the text has it. `arguments: {speed}` is meant so.
    """
    if isinstance(data, dict):
        if list(data.values()) == [None] and steps != ("arguments",) and _BRACES.fullmatch(text := spelled(steps)):
            yield steps, f'{text} without quotes is a mapping: write "{text}"'
        for key, value in data.items():
            yield from slips(value, spelled, (*steps, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from slips(value, spelled, (*steps, index))


def _space(joined: re.Match[str]) -> str:
    return f"a space is missing behind '{joined[1]}'"
