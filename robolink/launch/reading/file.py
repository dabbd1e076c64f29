"""A parsed launch file: its data, and errors with line and column."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec

from robolink.documents.mistakes import Reader
from robolink.documents.yamlfile import read_text
from robolink.exceptions import DocumentError
from robolink.launch.reading.substitution import Step
from robolink.launch.reading.yaml_pitfalls import hint, misreadings, misshapen

_LONGEST_CHAIN = 100


class LaunchFile:
    """A YAML file that was read, or `text` in its place.

    `data` is its content as plain data, `length` its number of characters, `folder` its directory. `above` lists the
    files that include it, nearest first: `lap.yaml:3, fleet.yaml:7`. Raises `DocumentError`, as all its methods do,
    for invalid YAML.
    """

    def __init__(self, path: Path, text: str | None = None, above: str = "") -> None:
        self.path, self._above = path, above
        try:
            text = read_text(path) if text is None else text
            self._reader, slip = _reader(text, str(path))
        except DocumentError as error:
            raise self._told(_with_hint(error, text)) from None
        if slip is not None:
            raise self.error(*slip)
        self.length = len(text)
        self.data: dict[str, Any] = self.value(self._reader.data, dict[str, Any], [])

    @property
    def folder(self) -> Path:
        """Directory of the file."""
        return self.path.parent

    def error(self, steps: Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Return an error (to raise) about the value at these steps, or at the nearest of them that exists."""
        return self._told(self._reader.error(steps, message, key=key))

    def value(self, data: Any, type_: Any, steps: Sequence[Step]) -> Any:
        """Convert data at these steps, which may be written otherwise there, to a type."""
        try:
            return self._reader.convert(data, type_)
        except msgspec.ValidationError as error:
            raise self._told(self._reader.explained(data, type_, error, steps)) from None

    def written(self, steps: Sequence[Step]) -> str | None:
        """Return the value there letter by letter, such as `012`; None if it is not a single value."""
        return self._reader.written(steps)

    def mentioned(self, steps: Sequence[Step]) -> str:
        """Return a place, with the files above it, for an error in another file: `lap.yaml:3`."""
        place = f"{self.path.name}:{self._reader.line(steps)}"
        whole = f"{place}, {self._above}" if self._above else place
        return whole if len(whole) <= _LONGEST_CHAIN else place

    def _told(self, error: DocumentError) -> DocumentError:
        return _longer(error, f" (included in {self._above})") if self._above else error


@functools.lru_cache(maxsize=8)
def _reader(text: str, name: str) -> tuple[Reader, tuple[Sequence[Step], str] | None]:
    """Parse a text and find its first pitfall. Cached: a file may be included for each of a hundred robots."""
    reader = Reader(text, name)
    found = itertools.chain(misreadings(reader.data, reader.spelled), misshapen(reader.data))
    return reader, next(found, None)


def _with_hint(error: DocumentError, text: str | None) -> DocumentError:
    """Return an error about invalid YAML, with its probable reason added."""
    said = hint(text, error.line) if text is not None and error.line else ""
    return _longer(error, f": {said}") if said else error


def _longer(error: DocumentError, more: str) -> DocumentError:
    return type(error)(error.message + more, error.file, error.line, error.column)
