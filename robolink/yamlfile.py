"""Read YAML into Structs, with errors that say where.

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

from robolink.exceptions import MOST_MISTAKES, DocumentError, few, nearest
from robolink.plainfile import read_plain
from robolink.yamlmistakes import Hook, Reader, Step, steps_of

if TYPE_CHECKING:
    from robolink.yamltext import Data

T = TypeVar("T")


class DocumentNotFoundError(DocumentError, FileNotFoundError):
    """A YAML file is not there; the text names the path and what is near."""


class Document(Generic[T]):
    """A YAML text and the value it was read into; it remembers where everything stands.

    `value` is what was read, `data` the same as plain dicts and lists, `name` the file's name as errors spell it.
    """

    def __init__(self, text: str, type_: type[T], name: str, hook: Hook | None = None) -> None:
        self._reader = Reader(text, name, hook)
        self.name, self.data = name, self._reader.data
        try:
            self.value: T = self._reader.convert(self.data, type_)
        except msgspec.ValidationError as error:
            raise self._reader.explained(self.data, type_, error) from None

    def error(self, path: str | Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Make an error (to raise) about what stands at `path`, or about its key.

        A path is `"$.robots[0].pose"`, or its steps `["robots", 0, "pose"]` where keys hold dots. When it ends
        in something that is not in the text, such as a default, the nearest mapping above is the place.
        """
        return self._reader.error(steps_of(path) if isinstance(path, str) else path, message, key=key)


def read(
    path: str | os.PathLike[str], type_: type[T], *, text: str | None = None, hook: Hook | None = None
) -> Document[T]:
    """Read a YAML file (or `text` in its place) into a `Document` of `type_`.

    `hook` is asked about types that msgspec does not know: given one and the data that should become a value of it,
    it gives the subclass to read, or raises ValueError with the reason why there is none.
    Raises `DocumentError` with `file:line:column`, and `DocumentNotFoundError` when there is no such file.
    The Structs decide whether unknown keys are refused: give them `forbid_unknown_fields=True`.
    """
    return Document(read_text(path) if text is None else text, type_, os.fspath(path), hook)


def mistakes(
    path: str | os.PathLike[str], type_: type[T], *, text: str | None = None, hook: Hook | None = None
) -> list[DocumentError]:
    """Find everything that `read` would refuse, one error for each part that is wrong; none if it would not.

    Of many the first are given, and one that says how many more there are.
    """
    try:
        reader = Reader(read_text(path) if text is None else text, os.fspath(path), hook)
    except DocumentError as error:
        return [error]
    return few(reader.mistakes(reader.data, type_), MOST_MISTAKES)


def load(path: str | os.PathLike[str], type_: type[T], *, text: str | None = None) -> T:
    """Read a YAML file (or `text` in its place) into a value of `type_`; the errors are those of `read`."""
    return read(path, type_, text=text).value


def parse(text: str, *, name: str = "<command line>") -> Data:
    """Read YAML into plain data: dicts with string keys, lists, strings, numbers, booleans and None.

    `on`, `no`, dates and `12:30:00` stay strings, `012` is 12, `1e3` is 1000.0. Raises `DocumentError`.
    """
    from robolink import yamltext

    return yamltext.plain(yamltext.compose(text, name), name)


def spell(data: Data) -> str:
    """Spell plain data as one line of YAML that `parse` turns back into exactly the same.

    >>> spell({"gain": 1.0, "names": ["a", "on"], "limit": float("inf")})
    '{"gain": 1.0, "names": ["a", "on"], "limit": .inf}'
    """
    if isinstance(data, dict):
        return "{" + ", ".join(f"{_quoted(key)}: {spell(value)}" for key, value in data.items()) + "}"
    if isinstance(data, list):
        return "[" + ", ".join(map(spell, data)) + "]"
    if isinstance(data, str):
        return _quoted(data)
    if isinstance(data, float) and not math.isfinite(data):
        return ".nan" if math.isnan(data) else ".inf" if data > 0 else "-.inf"
    return "null" if data is None else repr(data).lower()


def read_text(path: str | os.PathLike[str], most: int | None = None) -> str:
    """Read a text file: UTF-8, or UTF-16 with its mark, as PowerShell writes it; the errors are those of `read`.

    `most` is how many bytes it may have, by default what YAML may have (`yamltext.MAX_BYTES`).
    """
    from robolink import yamltext

    file = Path(path)
    try:
        raw = read_plain(file, yamltext.MAX_BYTES if most is None else most)
    except FileNotFoundError:
        raise DocumentNotFoundError(f"no file '{file}'{nearest(file.name, siblings(file))}") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise DocumentError(f"cannot be read: {reason}", str(file)) from None
    encoding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        return raw.decode(encoding)
    except UnicodeDecodeError as error:
        before = raw[: error.start]
        line, column = before.count(b"\n") + 1, error.start - before.rfind(b"\n")
        raise DocumentError("not UTF-8 text", str(file), line, column) from None


def siblings(path: Path) -> list[str]:
    """Give the names of the files in a file's folder, for whoever has found none of that name."""
    try:
        return [each.name for each in path.parent.iterdir()]
    except OSError:
        return []


def _quoted(text: str) -> str:
    return '"' + "".join(map(_escaped, text)) + '"'


def _escaped(char: str) -> str:
    if char in '"\\':
        return "\\" + char
    return char if char.isprintable() else f"\\U{ord(char):08X}"
