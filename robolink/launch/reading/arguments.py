"""Keys of a whole launch file: its `arguments`, the values given for them, its network, limits and recording."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import msgspec

from robolink.documents.mistakes import Step
from robolink.documents.yamlfile import parse, spell
from robolink.exceptions import DocumentError, nearest
from robolink.launch.entry import ArgumentHelp
from robolink.launch.reading.description import Argument
from robolink.launch.reading.document import LaunchFile
from robolink.launch.reading.section import (
    HERE,
    NUMBER,
    Place,
    Section,
    SubstitutionError,
    Value,
    Values,
    as_bool,
    filled,
)
from robolink.networks.limits import Limits, mistakes, parsed
from robolink.system.terminal import shown

_FIELDS = Argument.__struct_fields__
_RESERVED = {HERE: "the launch file's folder", NUMBER: "the number of a copy"}
_WHOLE = ("network", "limits", "record")
"""Keys that are about the whole system."""
_OF_LAUNCH_FILES = {"limits", "nodes", "include", "groups"}
_NOTHING: Mapping[str, str] = MappingProxyType({})


def arguments_of(path: str | os.PathLike[str], *, text: str | None = None) -> list[ArgumentHelp]:
    """Return the arguments of a launch file (or of `text` in its place), in its order.

    Raises `DocumentError` with `file:line:column`.
    """
    file = LaunchFile(Path(path), text)
    return [_help(file, name, each) for name, each in _declared(file).items()]


def _help(file: LaunchFile, name: str, argument: Argument) -> ArgumentHelp:
    default = None
    if argument.default is not msgspec.UNSET:
        written = file.written(_steps_to_default(file, name))
        default = Value.of(argument.default).text if written is None else written
    return ArgumentHelp(name, default, argument.description, tuple(_texts(file, name, argument)))


def read_given(given: Mapping[str, str]) -> dict[str, Value]:
    """Parse arguments as people type them, `1e3` or `[1, 2]`; raises `DocumentError` for invalid YAML."""
    return {name: Value(_data(name, text), text) for name, text in given.items()}


def _data(name: str, text: str) -> Any:
    """Parse the text behind `:=` as YAML; nothing at all is an empty text."""
    if not text.strip():
        return text
    try:
        return parse(text, name="")
    except DocumentError as error:
        raise DocumentError(f"{shown(name)}:={shown(text)} is not YAML: {error.message}") from None


def values_of(file: LaunchFile, given: Mapping[str, Value], includer: Place | None = None) -> Values:
    """Return the values for `{name}` in a launch file: its arguments, `{here}`, and `{env:NAME}`.

    `includer` is the place that includes the file; errors in given values point there. Raises `DocumentError` for an
    unknown argument, for a missing one and for one that is not among its choices.
    """
    declared = _declared(file)
    for name in given:
        if name not in declared:
            known = f": there is {', '.join(declared)}" if declared else ": it has none"
            reason = f"no argument is called '{shown(name)}'{nearest(name, declared) or known}"
            raise _error_of_given(file, includer, name, reason)
    named = {HERE: Value.of(str(file.folder.resolve()))}
    values = Values(named, budget=None if includer is None else includer.section.values.budget)
    for name, argument in declared.items():
        if name in given:
            value = _given(file, includer, name, argument, given[name])
        elif argument.default is msgspec.UNSET:
            about = f" ({argument.description})" if argument.description else ""
            way = f"`arguments: {{{name}: ...}}`" if includer else f"{name}:=VALUE"
            raise _error_of_given(file, includer, name, f"'{name}' must be given{about}: {way}")
        else:
            value = _default(file, name, argument, values)
        named[name] = value  # the defaults of the arguments below may name it
    return values


def _error_of_given(file: LaunchFile, includer: Place | None, name: str, message: str) -> DocumentError:
    """Return an error about a given value, at the place that gives it."""
    if includer is None:
        return file.error(["arguments", name], message)
    return includer.error(f"{file.path.name}: {message}", ["arguments", name])


def _declared(file: LaunchFile) -> dict[str, Argument]:
    """Parse the `arguments` section; a bare value is the default."""
    declared = file.value(file.data.get("arguments", {}), dict[str, Any], ["arguments"])
    return {name: _argument(file, name, each) for name, each in declared.items()}


def _argument(file: LaunchFile, name: str, data: Any) -> Argument:
    steps = ["arguments", name]
    if not name.isidentifier():
        raise file.error(steps, f"'{name}' is not a name for an argument: letters, digits and '_'", key=True)
    if name in _RESERVED:
        raise file.error(steps, f"{{{name}}} is {_RESERVED[name]}: give the argument another name", key=True)
    if data is None:  # `speed:` with nothing behind it
        return Argument()
    if isinstance(data, dict) and data and not any(key in _FIELDS or nearest(key, _FIELDS) for key in data):
        raise file.error(steps, "a mapping that is a default stands under `default`")
    argument: Argument = file.value(data, Argument, steps) if isinstance(data, dict) else Argument(default=data)
    return argument


def _default(file: LaunchFile, name: str, argument: Argument, values: Values) -> Value:
    steps = _steps_to_default(file, name)
    try:
        data = filled(argument.default, values, steps)
    except SubstitutionError as error:
        raise file.error(error.steps, str(error), key=error.is_key) from None
    written = file.written(steps)
    value = Value.of(data) if written is None or isinstance(data, str) else Value(data, written)
    chosen = _chosen(file, name, argument, value)
    if chosen is None:
        raise file.error(steps, _none_of(file, name, argument, value))
    return chosen


def _given(file: LaunchFile, includer: Place | None, name: str, argument: Argument, value: Value) -> Value:
    """Convert a value to the default's type where both can be read as the same type."""
    if isinstance(argument.default, bool) and (decided := as_bool(value.data)) is not None:
        value = Value(decided, value.text)
    elif _is_text_on_purpose(argument.default):
        value = Value(value.text, value.text)
    chosen = _chosen(file, name, argument, value)
    if chosen is None:
        raise _error_of_given(file, includer, name, _none_of(file, name, argument, value))
    return chosen


def _is_text_on_purpose(default: Any) -> bool:
    """True if a default is a text only by its quotes, such as "8080"."""
    if not isinstance(default, str):
        return False
    try:
        return not isinstance(parse(default), str)
    except DocumentError:
        return False


def _chosen(file: LaunchFile, name: str, argument: Argument, value: Value) -> Value | None:
    """Return the matching choice, or the value itself where all are allowed; None if it matches none."""
    if not argument.choices:
        return value
    for choice, text in zip(argument.choices, _texts(file, name, argument), strict=True):
        is_same = choice == value.data and isinstance(choice, bool) == isinstance(value.data, bool)
        if is_same or text == value.text:
            return Value(choice, text)
    return None


def _none_of(file: LaunchFile, name: str, argument: Argument, value: Value) -> str:
    texts, found = _texts(file, name, argument), shown(value.text)
    return f"'{name}' is one of {', '.join(texts)}, got '{found}'{nearest(found, texts)}"


def _texts(file: LaunchFile, name: str, argument: Argument) -> list[str]:
    """Return the choices as they are written."""
    return [file.written(["arguments", name, "choices", at]) or "" for at in range(len(argument.choices))]


def _steps_to_default(file: LaunchFile, name: str) -> list[Step]:
    data = file.data["arguments"][name]
    return ["arguments", name, *(["default"] if isinstance(data, dict) and "default" in data else [])]


# Keys about the whole system


def whole(file: LaunchFile, values: Values) -> Section:
    """Return the part of a launch file that is about the whole system: its network, limits and recording."""
    return Section(file, [], {key: data for key, data in file.data.items() if key in _WHOLE}, values)


def record_of(
    path: str | os.PathLike[str], given: Mapping[str, str] = _NOTHING, *, text: str | None = None
) -> str | None:
    """Return the folder of the bag that a launch file requests: '' for one with the date in its name, None for none.

    Args:
        path: The launch file; those that it includes do not count.
        given: Launch arguments by name, as people type them.
        text: Content to read in place of the file's.

    Raises:
        DocumentError: for a mistake in the file, with `file:line:column`.
    """
    file = LaunchFile(Path(path), text)
    return recorded(whole(file, values_of(file, read_given(given))))


def recorded(section: Section) -> str | None:
    """Return the folder of the bag as `record_of` does, from the part `whole` of a file. Raises DocumentError."""
    value = section.get("record")
    if value is None:
        return None
    is_on = as_bool(value)
    if is_on is not None:
        return "" if is_on else None
    if not isinstance(value, str) or not value.strip():
        found = value if isinstance(value, str) else spell(value)
        raise section.error(["record"], f"expected true, false or the folder of a bag, got '{found}'")
    return value


class Found(NamedTuple):
    """Limits of a file; `error` makes an error that names the place of one of their values."""

    limits: Limits
    error: Callable[[Sequence[Step], str], DocumentError]


def limits_of(path: str | os.PathLike[str]) -> Found:
    """Return the limits of a file: those of a launch file under `limits`, or those that are a file of their own.

    Args:
        path: The file; launch files that it includes do not count.

    Raises:
        DocumentError: for a mistake in the file, with `file:line:column`, also for a launch file without limits.
    """
    file = LaunchFile(Path(path))
    if not set(file.data) & _OF_LAUNCH_FILES:
        document = parsed(None, os.fspath(path))
        return Found(document.value, document.error)
    section = whole(file, values_of(file, {}))
    found = limits_in(section)
    if found is None:
        raise file.error([], "no key 'limits': nothing is limited")
    return Found(found, lambda steps, message: section.error(["limits", *steps], message))


def limits_in(section: Section) -> Limits | None:
    """Return the limits that the part `whole` of a file has; None for none. Raises DocumentError for a mistake."""
    found: Limits | None = section.value("limits", Limits | None, None)
    for steps, message, is_key in mistakes(found) if found is not None else ():
        raise section.error(["limits", *steps], message, key=is_key)
    return found
