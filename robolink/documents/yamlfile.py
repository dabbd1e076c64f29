"""YAML files into Structs, with errors that have line and column.

    world = load("configs/worlds/empty.yaml", World)

Every error is one line: `empty.yaml:3:11: robots[0].radius: expected float, got 'wide'`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeVar

import msgspec

from robolink.documents.mistakes import MOST_MISTAKES, Hook, Reader, Step, first_mistakes, steps_of
from robolink.exceptions import DocumentError, nearest
from robolink.system.files import decoded, read_plain
from robolink.system.terminal import quoted

if TYPE_CHECKING:
    from robolink.documents.yamltext import Data

S = TypeVar("S")
T = TypeVar("T")


class DocumentNotFoundError(DocumentError, FileNotFoundError):
    """A YAML file does not exist; the text names the path and similar files."""


class Document(Generic[T]):
    """A YAML text and its value, with the places of everything in it.

    `value` is the typed value, `data` the same as plain dicts and lists, `name` the file's name in errors.
    """

    def __init__(self, text: str, type_: type[T], name: str, hook: Hook | None = None) -> None:
        self._reader = Reader(text, name, hook)
        self.name, self.data = name, self._reader.data
        self.value: T = self.convert(self.data, type_)

    def convert(self, data: Data, type_: type[S]) -> S:
        """Convert data to `type_`: that of the text, or some in its place whose parts lie where its parts do.

        Raises:
            DocumentError: with `file:line:column`, as from the text.
        """
        try:
            return self._reader.convert(data, type_)
        except msgspec.ValidationError as error:
            raise self._reader.explained(data, type_, error) from None

    def error(self, path: str | Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Return an error (to raise) about the value at `path`, or about its key if `key` is true.

        A path is `"$.robots[0].pose"`, or its steps `["robots", 0, "pose"]` where keys contain dots. If it is not in
        the text, as for a default, the nearest mapping above is the place.
        """
        return self._reader.error(steps_of(path) if isinstance(path, str) else path, message, key=key)


def read(
    path: str | os.PathLike[str], type_: type[T], *, text: str | None = None, hook: Hook | None = None
) -> Document[T]:
    """Read a YAML file into a `Document` of `type_`.

    Args:
        path: The file.
        type_: Struct or other type of the value. Structs with `forbid_unknown_fields=True` refuse unknown keys.
        text: Content to read in place of the file's.
        hook: Called for types that msgspec does not know, with the type and the data of the value: returns the
            subclass to read, or raises ValueError with the reason why there is none.

    Raises:
        DocumentError: for invalid content, with `file:line:column`.
        DocumentNotFoundError: if the file does not exist.
    """
    return Document(read_text(path) if text is None else text, type_, os.fspath(path), hook)


def mistakes(
    path: str | os.PathLike[str], type_: type[T], *, text: str | None = None, hook: Hook | None = None
) -> list[DocumentError]:
    """Return all errors that `read` would raise, one for each invalid part; the arguments are those of `read`.

    Of many, the first are returned, and one with the number of the others.
    """
    try:
        reader = Reader(read_text(path) if text is None else text, os.fspath(path), hook)
    except DocumentError as error:
        return [error]
    return first_mistakes(reader.mistakes(reader.data, type_), MOST_MISTAKES)


def load(path: str | os.PathLike[str], type_: type[T], *, text: str | None = None) -> T:
    """Read a YAML file (or `text` in its place) into a value of `type_`; raises like `read`."""
    return read(path, type_, text=text).value


def parse(text: str, *, name: str = "<command line>") -> Data:
    """Parse YAML into plain data: dicts with string keys, lists, strings, numbers, booleans and None.

    `on`, `no`, dates and `12:30:00` stay strings, `012` is 12, `1e3` is 1000.0. Raises `DocumentError`, in which the
    text is called `name`.
    """
    from robolink.documents import yamltext

    return yamltext.plain(yamltext.compose(text, name), name)


def spell(data: Data) -> str:
    """Format plain data as one line of YAML, which `parse` converts back to exactly the same.

    >>> spell({"gain": 1.0, "names": ["a", "on"], "limit": float("inf")})
    '{"gain": 1.0, "names": ["a", "on"], "limit": .inf}'
    """
    if isinstance(data, dict):
        return "{" + ", ".join(f"{quoted(key)}: {spell(value)}" for key, value in data.items()) + "}"
    if isinstance(data, list):
        return "[" + ", ".join(map(spell, data)) + "]"
    if isinstance(data, str):
        return quoted(data)
    if isinstance(data, float) and not math.isfinite(data):
        return ".nan" if math.isnan(data) else ".inf" if data > 0 else "-.inf"
    return "null" if data is None else repr(data).lower()


def read_text(path: str | os.PathLike[str], most: int | None = None) -> str:
    """Read a text file: UTF-8, or UTF-16 with a byte order mark, as PowerShell writes it; raises like `read`.

    `most` is its largest size in bytes; the default is that of YAML (`yamltext.MAX_BYTES`).
    """
    from robolink.documents import yamltext

    file = Path(path)
    try:
        raw = read_plain(file, yamltext.MAX_BYTES if most is None else most)
    except FileNotFoundError:
        raise DocumentNotFoundError(f"no file '{file}'{nearest(file.name, siblings(file))}") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise DocumentError(f"cannot be read: {reason}", str(file)) from None
    try:
        return decoded(raw)
    except UnicodeDecodeError as error:
        before = raw[: error.start]
        line, column = before.count(b"\n") + 1, error.start - before.rfind(b"\n")
        raise DocumentError("not UTF-8 text", str(file), line, column) from None


def siblings(path: Path) -> list[str]:
    """Return the names of the files in a file's folder, for a suggestion when it does not exist."""
    try:
        return [each.name for each in path.parent.iterdir()]
    except OSError:
        return []
