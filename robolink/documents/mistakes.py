"""Validation errors of YAML data: msgspec's reports as readable messages with line and column, and how many of them."""

from __future__ import annotations

import contextlib
import copy
import itertools
import re
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, TypeGuard, TypeVar

import msgspec

from robolink.exceptions import DocumentError, nearest
from robolink.system.terminal import shown

if TYPE_CHECKING:
    import yaml

    from robolink.documents.yamltext import Data

T = TypeVar("T")
Step: TypeAlias = "str | int"
Hook: TypeAlias = "Callable[[type, Any], type]"

MOST_KEYS = 20
"""Most keys that an error about an unknown one lists."""
_ANY_ITEM = "[...]"
_STEP = r"\.([^.\[\]]+)|\[(\d+)\]|\[\"((?:[^\"\\]|\\.)*)\"\]|(\[\.\.\.\])"
_PLACED = r"(?P<text>.*?)(?: - at (?P<key>`key` in )?`\$(?P<path>.*)`)?"


class _InsideError(ValueError):
    """An error in a value of a type that the hook chose; msgspec keeps it as the cause of its own."""

    def __init__(self, data: Data, type_: type, error: msgspec.ValidationError) -> None:
        super().__init__(str(error).replace("`", ""))  # no path, which the report outside has in full
        self.data, self.type, self.error = data, type_, error


class Reader:
    """A parsed YAML text with the place of every value; `data` is its content as plain dicts and lists."""

    def __init__(self, text: str, name: str, hook: Hook | None = None) -> None:
        from robolink.documents import yamltext

        self._text, self._name, self._hook = text, name, hook
        self._children: dict[int, dict[str, tuple[yaml.Node, yaml.Node]]] = {}
        self._root = yamltext.compose(text, name)
        self.data: Data = yamltext.plain(self._root, name)

    def convert(self, data: Data, type_: type[T]) -> T:
        """Convert data to `type_`; raises msgspec's error, which `explained` converts to a readable one."""
        return msgspec.convert(data, type_, str_keys=True, dec_hook=None if self._hook is None else self._chosen)

    def _chosen(self, type_: type, data: Data) -> object:
        """Convert data to the type that the hook chooses."""
        assert self._hook is not None
        chosen = self._hook(type_, data)
        try:
            return self.convert(data, chosen)
        except msgspec.ValidationError as error:
            raise _InsideError(data, chosen, error) from None

    def error(self, steps: Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Return an error about the value at these steps, or about its key."""
        from robolink.documents import yamltext

        node = self._node(steps, key)
        place = (1, 1) if node is None else yamltext.place(node.start_mark)
        spelled = _spelled(steps)
        return DocumentError(shown(f"{spelled}: {message}" if spelled else message, 300), self._name, *place)

    def written(self, steps: Sequence[Step]) -> str | None:
        """Return the text of the scalar at these steps as it is written; None if it is not a scalar."""
        import yaml

        node = self._root
        for step in steps:
            entry = self._child(node, step)
            node = None if entry is None else entry[1]
        return node.value if isinstance(node, yaml.ScalarNode) else None

    def spelled(self, steps: Sequence[Step]) -> str:
        """Return the source text of the value at these steps, a mapping with its braces."""
        node = self._node(steps)
        return "" if node is None else self._text[node.start_mark.index : node.end_mark.index]

    def line(self, steps: Sequence[Step]) -> int:
        """Return the line, from 1, of the value at these steps."""
        node = self._node(steps)
        return 1 if node is None else node.start_mark.line + 1

    def mistakes(self, data: Data, type_: object, above: Sequence[Step] = ()) -> Iterator[DocumentError]:
        """Yield an error for each invalid part of the data: the smallest parts, each on its own."""
        try:
            self.convert(data, typing.cast("type", type_))
        except msgspec.ValidationError as error:
            found = False
            for each in self._mistakes_inside(data, type_, above):
                found = True
                yield each
            if not found:
                yield self.explained(data, type_, error, above)

    def _mistakes_inside(self, data: Data, type_: object, above: Sequence[Step]) -> Iterator[DocumentError]:
        for each in self._members(type_, data):
            for step, part, part_type in _parts(data, each):
                yield from self.mistakes(part, part_type, [*above, step])
            for name in _unknown_keys(data, each):
                yield self._unknown_key(name, _fields([each]), above)

    def explained(
        self, data: Data, type_: object, error: msgspec.ValidationError, above: Sequence[Step] = ()
    ) -> DocumentError:
        """Convert msgspec's error to a readable one: with the place, the nearest key, and the value found."""
        report = str(error)
        match = re.fullmatch(_PLACED, report, re.DOTALL)
        assert match is not None
        text, path = match["text"], "$" + (match["path"] or "")
        inner = self._exact(data, steps_of(path), type_, report)
        steps = [*above, *inner]
        if isinstance(error.__cause__, _InsideError):
            cause = error.__cause__
            return self.explained(cause.data, cause.type, cause.error, steps)
        if unknown := re.fullmatch(r"Object contains unknown field `(.*)`", text, re.DOTALL):
            return self._unknown_key(unknown[1], _fields(_types_at(type_, inner)), steps)
        if missing := re.fullmatch(r"Object missing required field `(.*)`", text, re.DOTALL):
            return self.error(steps, f"missing key '{missing[1]}'")
        if text.startswith("Invalid enum value"):
            return self.error(steps, _none_of(_at(data, inner), _types_at(type_, inner)))
        if match["key"]:
            return self.error(steps, f"a key: {_worded(text, None, None)}")
        return self.error(steps, _worded(text, self._node(steps), _at(data, inner)))

    def _unknown_key(self, name: str, known: Sequence[str], above: Sequence[Step]) -> DocumentError:
        hint = nearest(name, known) or (f"; there are {', '.join(known)}" if 0 < len(known) <= MOST_KEYS else "")
        return self.error([*above, name], f"unknown key '{name}'{hint}", key=True)

    def _node(self, steps: Sequence[Step], key: bool = False) -> yaml.Node | None:
        """Return the YAML node at these steps, or the last one on the way that exists."""
        node = self._root
        for index, step in enumerate(steps):
            entry = self._child(node, step)
            if entry is None:
                break
            node = entry[0] if key and index == len(steps) - 1 else entry[1]
        return node

    def _child(self, node: yaml.Node | None, step: Step) -> tuple[yaml.Node, yaml.Node] | None:
        """Return the key node and the value node of a step (in a list, the value twice), or None."""
        import yaml

        from robolink.documents import yamltext

        if isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
            return node.value[step], node.value[step]
        if not isinstance(node, yaml.MappingNode) or not isinstance(step, str):
            return None
        if id(node) not in self._children:
            self._children[id(node)] = {pair[0].value: pair for pair in reversed(list(yamltext.pairs(node)))}
        return self._children[id(node)].get(step)

    def _members(self, type_: object, data: Data) -> Iterator[object]:
        """Yield the types that the data may be, with what the hook chooses in the place of its own types."""
        for each in _members(type_):
            if self._hook is None or _is_struct(each) or not isinstance(each, type) or not _is_custom(each):
                yield each
                continue
            with contextlib.suppress(ValueError):
                yield self._hook(each, data)

    def _exact(self, data: Data, steps: list[Step], type_: object, report: str) -> list[Step]:
        """Replace each `[...]`, for which msgspec names no key, by the first key that gives the same report."""
        if _ANY_ITEM in steps:
            data = copy.deepcopy(data)  # whose mappings lose all keys but the culprit
        while _ANY_ITEM in steps:
            at = steps.index(_ANY_ITEM)
            holder = _at(data, steps[:at])
            key = self._culprit(data, holder, type_, report) if isinstance(holder, dict) else None
            if key is None:
                return steps[:at]
            steps[at] = key
        return steps

    def _culprit(self, data: Data, holder: dict[str, Data], type_: object, report: str) -> str | None:
        """Find the key of `holder`, a mapping inside `data`, that alone gives the same report; leave only that one."""
        whole = dict(holder)
        keys = list(whole)
        while len(keys) > 1:  # by halves: a stranger's mapping may have thousands
            first = keys[: len(keys) // 2]
            keys = first if self._report_of(holder, whole, first, data, type_) == report else keys[len(first) :]
        return keys[0] if keys and self._report_of(holder, whole, keys, data, type_) == report else None

    def _report_of(
        self, holder: dict[str, Data], whole: Mapping[str, Data], keys: Sequence[str], data: Data, type_: object
    ) -> str:
        holder.clear()
        holder.update((key, whole[key]) for key in keys)
        return self._report(data, type_)

    def _report(self, data: Data, type_: object) -> str:
        try:
            self.convert(data, typing.cast("type", type_))
        except msgspec.ValidationError as error:
            return str(error)
        return ""


def steps_of(path: str) -> list[Step]:
    """Split `$.robots[0].pose` into `["robots", 0, "pose"]`; msgspec's `[...]` stays as it is."""
    steps: list[Step] = []
    for name, index, quoted, item in re.findall(_STEP, path.removeprefix("$")):
        steps.append(int(index) if index else name or item or re.sub(r"\\(.)", r"\1", quoted))
    return steps


def _spelled(steps: Sequence[Step]) -> str:
    """Format a path for people: `robots[0].pose`."""
    parts = (f"[{step}]" if isinstance(step, int) else f".{step}" for step in steps)
    return "".join(parts).removeprefix(".")


def _at(data: Data, steps: Sequence[Step]) -> Data:
    for step in steps:
        data = typing.cast("dict[Step, Data]", data)[step]
    return data


def _types_at(type_: object, steps: Sequence[Step]) -> list[object]:
    """Follow a path through the types it may lead to: fields of Structs, items of lists and mappings."""
    found = list(_members(type_))
    for step in steps:
        found = [each for outer in found for inner in _inside(outer, step) for each in _members(inner)]
    return found


def _members(type_: object) -> Iterator[object]:
    """Yield the members of a union, without their constraints; another type is its own only member."""
    origin, inner = typing.get_origin(type_), typing.get_args(type_)
    if origin in (typing.Union, types.UnionType):
        for each in inner:
            yield from _members(each)
    elif origin is typing.Annotated:
        yield from _members(inner[0])
    else:
        yield type_


def _inside(type_: object, step: Step) -> list[object]:
    if _is_struct(type_):
        return [each.type for each in msgspec.structs.fields(type_) if each.encode_name == step]
    return list(typing.get_args(type_))


def _parts(data: Data, type_: object) -> Iterator[tuple[Step, Data, object]]:
    """Yield the items of a mapping or list that a type declares: step, data, type."""
    if isinstance(data, dict):
        known = _types_of_keys(data, type_)
        yield from ((key, data[key], known[key]) for key in data if key in known)
    elif isinstance(data, list):
        parts = enumerate(zip(data, _types_of_items(data, type_), strict=False))
        yield from ((index, part, part_type) for index, (part, part_type) in parts)


def _types_of_keys(data: dict[str, Data], type_: object) -> dict[str, object]:
    origin, inner = typing.get_origin(type_), typing.get_args(type_)
    if _is_struct(type_):
        return {each.encode_name: each.type for each in msgspec.structs.fields(type_)}
    return dict.fromkeys(data, inner[1]) if isinstance(origin, type) and issubclass(origin, Mapping) else {}


def _types_of_items(data: list[Data], type_: object) -> Sequence[object]:
    origin, inner = typing.get_origin(type_), typing.get_args(type_)
    if _is_struct(type_):
        return [each.type for each in msgspec.structs.fields(type_)] if type_.__struct_config__.array_like else []
    if not isinstance(origin, type) or issubclass(origin, Mapping):
        return []
    return inner if origin is tuple and inner[-1] is not Ellipsis else [inner[0]] * len(data)


def _unknown_keys(data: Data, type_: object) -> list[str]:
    if not isinstance(data, dict) or not _is_struct(type_) or not type_.__struct_config__.forbid_unknown_fields:
        return []
    known = _fields([type_])
    return [key for key in data if key not in known]


def _is_struct(type_: object) -> TypeGuard[type[msgspec.Struct]]:
    return isinstance(type_, type) and issubclass(type_, msgspec.Struct)


def _is_custom(type_: type) -> bool:
    """True if msgspec leaves a type to the hook."""
    return isinstance(msgspec.inspect.type_info(type_), msgspec.inspect.CustomType)


def _fields(found: Sequence[object]) -> list[str]:
    return [field.encode_name for each in found if _is_struct(each) for field in msgspec.structs.fields(each)]


def _none_of(data: Data, found: Sequence[object]) -> str:
    """Return which words are allowed in place of another one."""
    words = [word for each in found if typing.get_origin(each) is typing.Literal for word in typing.get_args(each)]
    given = shown(str(data))
    return f"expected one of {', '.join(map(str, words))}, got '{given}'{nearest(given, map(str, words))}"


_PLAIN_WORDS = {"object": "mapping", "array": "list", "null": "nothing"}
_ANY_SCALAR = "bool | int | float | str"


def _worded(text: str, node: yaml.Node | None, data: Data) -> str:
    """Return "expected float, got 'fast'" for msgspec's "Expected `float`, got `str`".

    The value is shown as it is written, or, where the data was changed since, as it is now.
    """
    import yaml

    text = re.sub(r"\b(object|array|null)\b", lambda match: _PLAIN_WORDS[match[1]], text).replace("`", "")
    text = text.replace(_ANY_SCALAR, "a value")
    if text.startswith("Expected"):
        text = "e" + text[1:]
    if not isinstance(node, yaml.ScalarNode) or node.value == "":
        return text
    was_filled_in = isinstance(data, str | int | float) and "{" in node.value
    found = f"'{shown(str(data) if was_filled_in else node.value)}'"
    return re.sub(r", got .*", "", text) + f", got {found}" if text.startswith("expected") else text


MOST_REPORTED, MOST_MISTAKES = 20, 100
"""Most mistakes of a file that are reported, and that are looked for."""


def first_mistakes(errors: Iterable[DocumentError], looked_for: int | None = None) -> list[DocumentError]:
    """Return the first `errors` of a file, and in place of the others one that says how many they are.

    No more than `looked_for` are counted, where finding each takes time.
    """
    found = list(itertools.islice(errors, looked_for))
    if len(found) <= MOST_REPORTED + 1:
        return found
    more = f"{len(found) - MOST_REPORTED:,}" if looked_for is None or len(found) < looked_for else "many"
    return [*found[:MOST_REPORTED], DocumentError(f"and {more} more mistakes", found[MOST_REPORTED].file)]
