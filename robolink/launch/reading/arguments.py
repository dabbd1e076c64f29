"""Launch arguments: the `arguments` section of a launch file, its defaults and choices, and the values given."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from robolink.documents.yamlfile import parse
from robolink.exceptions import DocumentError, nearest
from robolink.launch.entry import ArgumentHelp
from robolink.launch.reading.conditions import as_bool
from robolink.launch.reading.description import Argument
from robolink.launch.reading.file import LaunchFile
from robolink.launch.reading.section import Place
from robolink.launch.reading.substitution import HERE, NUMBER, Step, SubstitutionError, Value, Values, filled
from robolink.system.terminal import shown

_FIELDS = Argument.__struct_fields__
_OTHERS = {HERE: "the launch file's folder", NUMBER: "the number of a copy"}


def arguments_of(path: str | os.PathLike[str], *, text: str | None = None) -> list[ArgumentHelp]:
    """Return the arguments of a launch file (or of `text` in its place), in its order.

    Raises `DocumentError` with `file:line:column`.
    """
    file = LaunchFile(Path(path), text)
    return [_help(file, name, each) for name, each in _declared(file).items()]


def read_given(given: Mapping[str, str]) -> dict[str, Value]:
    """Parse arguments as people type them, `1e3` or `[1, 2]`; raises `DocumentError` for invalid YAML."""
    return {name: Value(_data(name, text), text) for name, text in given.items()}


def values_of(file: LaunchFile, given: Mapping[str, Value], asker: Place | None = None) -> Values:
    """Return the values for `{name}` in a launch file: its arguments, `{here}`, and `{env:NAME}`.

    `asker` is the place that includes the file; errors in given values point there. Raises `DocumentError` for an
    unknown argument, for a missing one and for one that is not among its choices.
    """
    declared = _declared(file)
    for name in given:
        if name not in declared:
            raise _asked(file, asker, name, _unknown(name, declared))
    named = {HERE: Value.of(str(file.folder.resolve()))}
    values = Values(named, budget=None if asker is None else asker.section.values.budget)
    for name, argument in declared.items():
        if name in given:
            value = _given(file, asker, name, argument, given[name])
        elif argument.default is msgspec.UNSET:
            about = f" ({argument.description})" if argument.description else ""
            way = f"`arguments: {{{name}: ...}}`" if asker else f"{name}:=VALUE"
            raise _asked(file, asker, name, f"'{name}' must be given{about}: {way}")
        else:
            value = _default(file, name, argument, values)
        named[name] = value
    return values


def _asked(file: LaunchFile, asker: Place | None, name: str, message: str) -> DocumentError:
    """Return an error about a given value, at the place that gives it."""
    if asker is None:
        return file.error(["arguments", name], message)
    return asker.error(f"{file.path.name}: {message}", ["arguments", name])


def _declared(file: LaunchFile) -> dict[str, Argument]:
    """Parse the `arguments` section; a bare value is the default."""
    declared = file.value(file.data.get("arguments", {}), dict[str, Any], ["arguments"])
    return {name: _argument(file, name, each) for name, each in declared.items()}


def _argument(file: LaunchFile, name: str, data: Any) -> Argument:
    steps = ["arguments", name]
    if not name.isidentifier():
        raise file.error(steps, f"'{name}' is not a name for an argument: letters, digits and '_'", key=True)
    if name in _OTHERS:
        raise file.error(steps, f"{{{name}}} is {_OTHERS[name]}: give the argument another name", key=True)
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


def _given(file: LaunchFile, asker: Place | None, name: str, argument: Argument, value: Value) -> Value:
    """Convert a value to the default's type where both can be read as the same type."""
    if isinstance(argument.default, bool) and (decided := as_bool(value.data)) is not None:
        value = Value(decided, value.text)
    elif _is_text_on_purpose(argument.default):
        value = Value(value.text, value.text)
    chosen = _chosen(file, name, argument, value)
    if chosen is None:
        raise _asked(file, asker, name, _none_of(file, name, argument, value))
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
    places: list[list[Step]] = [["arguments", name, "choices", at] for at in range(len(argument.choices))]
    return [file.written(each) or "" for each in places]


def _steps_to_default(file: LaunchFile, name: str) -> list[Step]:
    steps: list[Step] = ["arguments", name]
    return [*steps, "default"] if file.written([*steps]) is None and _says_default(file, name) else steps


def _says_default(file: LaunchFile, name: str) -> bool:
    argument = file.data["arguments"][name]
    return isinstance(argument, dict) and "default" in argument


def _help(file: LaunchFile, name: str, argument: Argument) -> ArgumentHelp:
    default = None
    if argument.default is not msgspec.UNSET:
        written = file.written(_steps_to_default(file, name))
        default = Value.of(argument.default).text if written is None else written
    return ArgumentHelp(name, default, argument.description, tuple(_texts(file, name, argument)))


def _unknown(name: str, declared: Mapping[str, Argument]) -> str:
    known = f": there is {', '.join(declared)}" if declared else ": it has none"
    return f"no argument is called '{shown(name)}'{nearest(name, declared) or known}"


def _data(name: str, text: str) -> Any:
    """Parse the text behind `:=` as YAML; nothing at all is an empty text."""
    if not text.strip():
        return text
    try:
        return parse(text, name="")
    except DocumentError as error:
        raise DocumentError(f"{shown(name)}:={shown(text)} is not YAML: {error.message}") from None
