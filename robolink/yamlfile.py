"""Read YAML into Structs, with errors that say where.

    world = load("configs/worlds/empty.yaml", World)

Every error is one line: `empty.yaml:3:11: robots[0].radius: expected float, got 'wide'`.
"""

from __future__ import annotations

import math
import os
import re
import types
import typing
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Generic, TypeAlias, TypeVar

import msgspec

from robolink.exceptions import DocumentError, nearest, shown

if TYPE_CHECKING:
    import yaml

    from robolink.yamltext import Data

T = TypeVar("T")
Step: TypeAlias = "str | int"

LONGEST = 64 * 2**20
"""Bytes that a file may have."""

_ANY_ITEM = "[...]"
_STEP = r"\.([^.\[\]]+)|\[(\d+)\]|\[\"((?:[^\"\\]|\\.)*)\"\]|(\[\.\.\.\])"
_PLACED = r"(?P<text>.*?)(?: - at (?P<key>`key` in )?`\$(?P<path>.*)`)?"


class DocumentNotFoundError(DocumentError, FileNotFoundError):
    """A YAML file is not there; the text names the path and what is near."""


class Document(Generic[T]):
    """A YAML text and the value it was read into; it remembers where everything stands.

    `value` is what was read, `name` the file's name as errors spell it.
    """

    def __init__(self, text: str, type_: type[T], name: str) -> None:
        from robolink import yamltext

        self.name = name
        self._root = yamltext.compose(text, name)
        data = yamltext.plain(self._root, name)
        try:
            self.value: T = msgspec.convert(data, type_, str_keys=True)
        except msgspec.ValidationError as error:
            raise self._explained(data, type_, str(error)) from None

    def error(self, path: str | Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Make an error (to raise) about what stands at `path`, or about its key.

        A path is `"$.robots[0].pose"`, or its steps `["robots", 0, "pose"]` where keys hold dots. When it ends
        in something that is not in the text, such as a default, the nearest mapping above is the place.
        """
        steps = _steps(path) if isinstance(path, str) else list(path)
        node = self._node(steps, key)
        where = f"{self.name}:1:1"
        if node is not None:
            where = f"{self.name}:{node.start_mark.line + 1}:{node.start_mark.column + 1}"
        spelled = _spelled(steps)
        return DocumentError(f"{where}: " + shown(f"{spelled}: {message}" if spelled else message, 300))

    def _node(self, steps: Sequence[Step], key: bool = False) -> yaml.Node | None:
        """Walk down to the node at the path, or as far as the text goes."""
        node = self._root
        for index, step in enumerate(steps):
            entry = _child(node, step)
            if entry is None:
                break
            node = entry[0] if key and index == len(steps) - 1 else entry[1]
        return node

    def _explained(self, data: Data, type_: object, report: str) -> DocumentError:
        """Turn msgspec's report into ours: the place, the nearest key, what was found."""
        match = re.fullmatch(_PLACED, report, re.DOTALL)
        assert match is not None
        text, path = match["text"], "$" + (match["path"] or "")
        steps = _exact(data, _steps(path), type_, report)
        if unknown := re.fullmatch(r"Object contains unknown field `(.*)`", text, re.DOTALL):
            name = unknown[1]
            known = _fields(_types_at(type_, steps))
            return self.error([*steps, name], f"unknown key '{name}'{nearest(name, known)}", key=True)
        if missing := re.fullmatch(r"Object missing required field `(.*)`", text, re.DOTALL):
            return self.error(steps, f"missing key '{missing[1]}'")
        if match["key"]:
            return self.error(steps, f"a key: {_worded(text, None)}")
        return self.error(steps, _worded(text, self._node(steps)))


def read(path: str | os.PathLike[str], type_: type[T], *, text: str | None = None) -> Document[T]:
    """Read a YAML file (or `text` in its place) into a `Document` of `type_`.

    Raises `DocumentError` with `file:line:column`, and `DocumentNotFoundError` when there is no such file.
    The Structs decide whether unknown keys are refused: give them `forbid_unknown_fields=True`.
    """
    return Document(read_text(path) if text is None else text, type_, os.fspath(path))


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


def read_text(path: str | os.PathLike[str]) -> str:
    """Read a text file: UTF-8, or UTF-16 with its mark, as PowerShell writes it; the errors are those of `read`."""
    file = Path(path)
    try:
        with file.open("rb") as stream:
            raw = stream.read(LONGEST + 1)
    except FileNotFoundError:
        raise DocumentNotFoundError(f"no file '{file}'{nearest(file.name, _siblings(file))}") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise DocumentError(f"{file}: cannot be read: {reason}") from None
    if len(raw) > LONGEST:  # a device, say, which never ends
        raise DocumentError(f"{file}: longer than {LONGEST // 2**20} MiB")
    encoding = "utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"
    try:
        return raw.decode(encoding)
    except UnicodeDecodeError as error:
        before = raw[: error.start]
        line, column = before.count(b"\n") + 1, error.start - before.rfind(b"\n")
        raise DocumentError(f"{file}:{line}:{column}: not UTF-8 text") from None


def _siblings(path: Path) -> list[str]:
    try:
        return [each.name for each in path.parent.iterdir()]
    except OSError:
        return []


def _steps(path: str) -> list[Step]:
    """Split `$.robots[0].pose` into `["robots", 0, "pose"]`; msgspec's `[...]` stays as it is."""
    steps: list[Step] = []
    for name, index, quoted, item in re.findall(_STEP, path.removeprefix("$")):
        steps.append(int(index) if index else name or item or re.sub(r"\\(.)", r"\1", quoted))
    return steps


def _spelled(steps: Sequence[Step]) -> str:
    """Spell a path for a reader: `robots[0].pose`."""
    parts = (f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)
    return "".join(parts).removeprefix(".")


def _child(node: yaml.Node | None, step: Step) -> tuple[yaml.Node, yaml.Node] | None:
    """Give the key and the value that a step leads to (in a list, the value twice), or None."""
    import yaml

    from robolink import yamltext

    if isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
        return node.value[step], node.value[step]
    if isinstance(node, yaml.MappingNode):
        return next((pair for pair in yamltext.pairs(node) if pair[0].value == step), None)
    return None


def _exact(data: Data, steps: list[Step], type_: object, report: str) -> list[Step]:
    """Replace each `[...]`, for which msgspec names no key, by the first key that gives the same report."""
    while _ANY_ITEM in steps:
        at = steps.index(_ANY_ITEM)
        holder = _at(data, steps[:at])
        key = _culprit(data, holder, type_, report) if isinstance(holder, dict) else None
        if key is None:
            return steps[:at]
        steps[at] = key
    return steps


def _culprit(data: Data, holder: dict[str, Data], type_: object, report: str) -> str | None:
    """Find the key of `holder`, a mapping inside `data`, that alone gives the same report; leave only that one."""
    whole = dict(holder)
    for key in whole:
        holder.clear()
        holder[key] = whole[key]
        if _report(data, type_) == report:
            return key
    return None


def _at(data: Data, steps: Sequence[Step]) -> Data:
    for step in steps:
        data = typing.cast("dict[Step, Data]", data)[step]
    return data


def _report(data: Data, type_: object) -> str:
    try:
        msgspec.convert(data, type_, str_keys=True)
    except msgspec.ValidationError as error:
        return str(error)
    return ""


def _types_at(type_: object, steps: Sequence[Step]) -> list[object]:
    """Follow a path through the types it may lead to: fields of Structs, items of lists and mappings."""
    found = list(_members(type_))
    for step in steps:
        found = [each for outer in found for inner in _inside(outer, step) for each in _members(inner)]
    return found


def _members(type_: object) -> Iterator[object]:
    """Yield the types that a union may be; a type that is no union is its only member."""
    if typing.get_origin(type_) in (typing.Union, typing.Annotated, types.UnionType):
        for each in typing.get_args(type_):
            yield from _members(each)
    else:
        yield type_


def _inside(type_: object, step: Step) -> list[object]:
    if isinstance(type_, type) and issubclass(type_, msgspec.Struct):
        return [each.type for each in msgspec.structs.fields(type_) if each.encode_name == step]
    return list(typing.get_args(type_))


def _fields(types: Sequence[object]) -> list[str]:
    structs = (each for each in types if isinstance(each, type) and issubclass(each, msgspec.Struct))
    return [field.encode_name for each in structs for field in msgspec.structs.fields(each)]


_PLAIN_WORDS = {"object": "mapping", "array": "list", "null": "nothing"}


def _worded(text: str, node: yaml.Node | None) -> str:
    """Say "expected float, got 'fast'" for msgspec's "Expected `float`, got `str`"."""
    import yaml

    text = re.sub(r"\b(object|array|null)\b", lambda match: _PLAIN_WORDS[match[1]], text).replace("`", "")
    if text.startswith("Expected"):
        text = "e" + text[1:]
    if not isinstance(node, yaml.ScalarNode) or node.value == "":
        return text
    found = f"'{shown(node.value)}'"
    return re.sub(r", got .*", "", text) + f", got {found}" if text.startswith("expected") else text


def _quoted(text: str) -> str:
    return '"' + "".join(map(_escaped, text)) + '"'


def _escaped(char: str) -> str:
    if char in '"\\':
        return "\\" + char
    return char if char.isprintable() else f"\\U{ord(char):08X}"
