"""A launch file as a YAML document: its data, errors with line and column, and the pitfalls of YAML."""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import msgspec

from robolink.documents.mistakes import Reader, Step
from robolink.documents.yamlfile import read_text
from robolink.exceptions import DocumentError
from robolink.system.terminal import shown

Pitfall: TypeAlias = "tuple[tuple[Step, ...], str]"
"""Steps to a value, and what is wrong with it."""

_LONGEST_CHAIN = 100
_BRACES = re.compile(r"\{\s*(?:[^\W\d]\w*|env:[^\s{}]+)\s*\}")
_QUOTED = re.compile(r"\"(?:\\.|[^\"\\])*\"|'[^']*'|(?:^|\s)#.*")
_JOINED = re.compile(r"\s*(?:- +)?([A-Za-z_]\w*:)[^\s:/\\].*")
_ALIAS = re.compile(r"(?:[\[{,]|[:-] )\s*\*")
_LISTS = {"nodes": "node: NAME", "include": "file: NAME", "groups": "nodes: [...]"}
"""Keys whose values are lists, and how an item of each begins."""
_BEGIN = "a launch file begins with `nodes:`, and below it each node with `- node: NAME`"


class LaunchFile:
    """A YAML file that was read, or `text` in its place.

    `data` is its content as plain data, `length` its number of characters, `folder` its directory. `above` lists the
    files that include it, nearest first: `lap.yaml:3, fleet.yaml:7`. Raises `DocumentError`, as all its methods do,
    for invalid YAML.
    """

    def __init__(self, path: Path, text: str | None = None, above: str = "") -> None:
        self.path, self.folder, self._above = path, path.parent, above
        try:
            text = read_text(path) if text is None else text
            self._reader, pitfall = _reader(text, str(path))
        except DocumentError as error:
            raise self._included(_with_hint(error, text)) from None
        if pitfall is not None:
            raise self.error(*pitfall)
        self.length = len(text)
        self.data: dict[str, Any] = self.value(self._reader.data, dict[str, Any], [])

    def error(self, steps: Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Return an error (to raise) about the value at these steps, or at the nearest of them that exists."""
        return self._included(self._reader.error(steps, message, key=key))

    def value(self, data: Any, type_: Any, steps: Sequence[Step]) -> Any:
        """Convert data at these steps, which may be written otherwise there, to a type."""
        try:
            return self._reader.convert(data, type_)
        except msgspec.ValidationError as error:
            raise self._included(self._reader.explained(data, type_, error, steps)) from None

    def written(self, steps: Sequence[Step]) -> str | None:
        """Return the value there letter by letter, such as `012`; None if it is not a single value."""
        return self._reader.written(steps)

    def mentioned(self, steps: Sequence[Step]) -> str:
        """Return a place, with the files above it, for an error in another file: `lap.yaml:3`."""
        place = f"{self.path.name}:{self._reader.line(steps)}"
        whole = f"{place}, {self._above}" if self._above else place
        return whole if len(whole) <= _LONGEST_CHAIN else place

    def _included(self, error: DocumentError) -> DocumentError:
        return _longer(error, f" (included in {self._above})") if self._above else error


@functools.lru_cache(maxsize=8)  # a file may be included for each of a hundred robots
def _reader(text: str, name: str) -> tuple[Reader, Pitfall | None]:
    """Parse a text and find its first pitfall."""
    reader = Reader(text, name)
    return reader, next(itertools.chain(_misreadings(reader.data, reader), _misshapen(reader.data)), None)


def _longer(error: DocumentError, more: str) -> DocumentError:
    return type(error)(error.message + more, error.file, error.line, error.column)


# Invalid YAML


def _with_hint(error: DocumentError, text: str | None) -> DocumentError:
    """Return an error about invalid YAML, with its probable reason added."""
    hint = _hint(text, error.line) if text is not None and error.line else ""
    return _longer(error, f": {hint}") if hint else error


def _hint(text: str, line: int) -> str:
    """Return the probable mistake in a line, counted from 1, at which YAML parsing failed; '' if unknown."""
    near = [_QUOTED.sub("", each) for each in text.splitlines()[max(line - 2, 0) : line]]
    if near and (braces := _BRACES.search(near[-1])):
        return f"a value with {braces[0]} in it needs quotes here"
    if near and _ALIAS.search(near[-1]):
        return "a value that begins with '*' needs quotes"
    joined = next(filter(None, map(_JOINED.fullmatch, near)), None)
    return _space(joined) if joined else ""


def _space(joined: re.Match[str]) -> str:
    return f"a space is missing behind '{joined[1]}'"


# Valid YAML that was hardly meant so


def _misreadings(data: Any, reader: Reader, steps: tuple[Step, ...] = ()) -> Iterator[Pitfall]:
    """Yield each `{name}` without quotes, which YAML reads as a mapping; `arguments: {speed}` is none."""
    if isinstance(data, dict):
        is_one = list(data.values()) == [None] and steps != ("arguments",)
        if is_one and _BRACES.fullmatch(text := reader.spelled(steps)):
            yield steps, f'{text} without quotes is a mapping: write "{text}"'
        for key, value in data.items():
            if isinstance(value, dict | list):
                yield from _misreadings(value, reader, (*steps, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            if isinstance(value, dict | list):
                yield from _misreadings(value, reader, (*steps, index))


def _misshapen(data: Any, steps: tuple[Step, ...] = ()) -> Iterator[Pitfall]:
    """Yield each value of a launch file or group that should be a list or a mapping."""
    if not isinstance(data, dict):
        yield steps, f"{_expected('mapping', data)}: {_instead(data)}"
        return
    for key in (each for each in _LISTS if each in data):
        listed, at = data[key], (*steps, key)
        is_below = listed is None and any(each.startswith("-") for each in data)  # `-node: NAME`, an unknown key
        if not isinstance(listed, list) and not is_below:
            yield at, f"{_expected('list', listed)}: {_as_items(key, listed)}"
        for index, each in enumerate(listed if isinstance(listed, list) else ()):
            if not isinstance(each, dict):
                yield (*at, index), f"{_expected('mapping', each)}: {_as_item(key, each)}"
            elif key == "groups":
                yield from _misshapen(each, (*at, index))
    if not steps and isinstance(data.get("arguments"), list):
        yield ("arguments",), "expected mapping, got list: write each as `NAME: DEFAULT`, without '-'"


def _expected(kind: str, data: Any) -> str:
    kinds = {dict: "mapping", list: "list", type(None): "nothing"}
    return f"expected {kind}, got {kinds.get(type(data)) or repr(shown(str(data)))}"


def _instead(data: Any) -> str:
    if isinstance(data, list):
        return "write `nodes:` above it"
    if isinstance(data, str) and (joined := _JOINED.fullmatch(data)):
        return _space(joined)
    return _BEGIN


def _as_items(key: str, data: Any) -> str:
    """Return how to write this value as a list."""
    return "begin each with '- '" + ("" if isinstance(data, dict) else f", as in `- {_as_named(key, data)}`")


def _as_item(key: str, data: Any) -> str:
    """Return how to write this item of a list as a mapping."""
    if isinstance(data, str) and (joined := _JOINED.fullmatch(data)):
        return _space(joined)
    return "one '-' too many" if isinstance(data, list) else f"write `{_as_named(key, data)}`"


def _as_named(key: str, data: Any) -> str:
    begin = _LISTS[key]
    return begin.replace("NAME", shown(data, 40)) if isinstance(data, str) and data.strip() else begin
