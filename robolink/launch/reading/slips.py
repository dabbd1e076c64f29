"""What people write in launch files that YAML takes for something else, and what they should write."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from robolink.launch.reading.substitution import Step

_BRACES = re.compile(r"\{\s*(?:[^\W\d]\w*|env:[^\s{}]+)\s*\}")
_QUOTED = re.compile(r"\"(?:\\.|[^\"\\])*\"|'[^']*'|(?:^|\s)#.*")
_JOINED = re.compile(r"\s*(?:- +)?([A-Za-z_]\w*:)[^\s:/\\].*")
_LISTS = {"nodes", "include", "groups"}


def hint(text: str, line: int) -> str:
    """Say what is probably wrong in a line, counted from 1, at which a text is no YAML; '' where nothing is known."""
    near = [_QUOTED.sub("", each) for each in text.splitlines()[max(line - 2, 0) : line]]
    if near and (braces := _BRACES.search(near[-1])):
        return f"a value with {braces[0]} in it needs quotes here"
    joined = next(filter(None, map(_JOINED.fullmatch, near)), None)
    return _space(joined) if joined else ""


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
        holds_parts = _LISTS.issuperset(each for each in steps if isinstance(each, str))
        for index, value in enumerate(data):
            if holds_parts and isinstance(value, str) and (joined := _JOINED.fullmatch(value)):
                yield (*steps, index), f"expected mapping, got '{value}': {_space(joined)}"
            yield from slips(value, spelled, (*steps, index))


def _space(joined: re.Match[str]) -> str:
    return f"a space is missing behind '{joined[1]}'"
