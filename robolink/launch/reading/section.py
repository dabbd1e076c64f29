"""A section of a launch file, such as a node or a group, with each `{name}` in it substituted."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from robolink.documents.mistakes import Step
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError, RobolinkError, nearest
from robolink.launch.reading.description import Count
from robolink.launch.reading.document import LaunchFile
from robolink.system.terminal import shown

MOST_TEXT = 1_000_000
"""Most characters of one text, or of everything under one key, after substitution."""
MOST_TEXT_IN_ALL = 20_000_000
"""Most characters of a system: of all texts, each copy counted, and of all files, each include counted."""

HERE = "here"
NUMBER = "i"
ENVIRONMENT = "env:"

Renamed: TypeAlias = "dict[tuple[Step, ...], str]"
"""Keys that a substitution changed: the steps to the new key, and how it was written."""

_BRACES = re.compile(r"\{\{|\}\}|\{([^{}]*)\}|[{}]")
_IN_BRACES = re.compile(r"\{([^{}]*)\}")
_NAME = re.compile(r"[^\W\d]\w*|env:.*", re.DOTALL)
_MOST_SHOWN = 6
_ROS = re.compile(r"\$\((var|find-pkg-share)\s+'?([\w-]+)'?\)")
_ROS_MEANS = {
    "var": "write {{{0}}}, and `{0}` under `arguments`",
    "find-pkg-share": "write a path, which begins in this file's folder or in the workspace",
}

_TYPED = ("parameters", "arguments", "count", "if", "unless", "interactive", "cpu", "respawn", "record", "limits")
"""Keys in which `{name}` may become something else than a text."""
_DECIDES = ("if", "unless", "interactive")
"""Keys whose value is a boolean."""
_COLLECTIONS = ("args", "run", "env", "remappings")
"""Keys whose whole value may be one `{name}`; inside their lists and mappings it becomes text."""
_AS_WRITTEN = ("args", "run", "env")
"""Keys that programs get letter by letter: `012`, `1.10` and `true` stay texts there."""
_BOOLEANS = {
    **dict.fromkeys(("true", "yes", "on", "y", "1"), True),
    **dict.fromkeys(("false", "no", "off", "n", "0"), False),
}


class Problem(NamedTuple):
    """A mistake in a section: the steps to the value, or to its key if `is_key`."""

    steps: tuple[Step, ...]
    message: str
    is_key: bool = False


class Section:
    """A mapping in a launch file; the value of a key is substituted when it is first read.

    A key with nothing but a `{name}` that stands for null counts as absent. All methods raise `DocumentError` for
    mistakes in the file.
    """

    def __init__(self, file: LaunchFile, steps: Sequence[Step], written: Mapping[str, Any], values: Values) -> None:
        self.file, self.steps, self.values = file, tuple(steps), values
        self.written = {key: data for key, data in written.items() if key in _DECIDES or not _is_null(data, values)}
        self._filled: dict[str, Any] = {}
        self._renamed: Renamed = {}

    def __contains__(self, key: str) -> bool:
        return key in self.written

    def get(self, key: str, default: Any = None) -> Any:
        """Return the value under a key, substituted."""
        if key not in self.written:
            return default
        if key not in self._filled:
            self._filled[key] = self._fill(key)
        return self._filled[key]

    def data(self, *, without: Sequence[str] = ()) -> dict[str, Any]:
        """Return the substituted values of all keys but those of `without`."""
        return {key: self.get(key) for key in self.written if key not in without}

    def convert(self, data: Any, type_: Any, *steps: Step) -> Any:
        """Convert data of the section, or at some steps in it, to a type."""
        return self.file.value(data, type_, (*self.steps, *steps))

    def value(self, key: str, type_: Any, default: Any) -> Any:
        """Convert the value of one key to a type."""
        return self.convert(self.get(key), type_, key) if key in self.written else default

    def values_in(self, key: str) -> dict[str, Value]:
        """Return the mapping under a key, each value with the letters it is written with."""
        mapping: dict[str, Any] = self.get(key, {})
        result = {}
        for name, data in mapping.items():
            written = self.file.written(self._as_written([key, name]))
            text = None if written is None else filled(written, self.values, [], as_text=True)
            result[name] = Value.of(data) if text is None else Value(data, text)
        return result

    @property
    def is_on(self) -> bool:
        """True if its keys `if` and `unless` let it start."""
        return self._decided("if", default=True) and not self._decided("unless", default=False)

    def error(self, steps: Sequence[Step], message: str, *, key: bool = False) -> DocumentError:
        """Return an error (to raise) about the value at these steps below the section; keys may be substituted ones."""
        return self.file.error(self._as_written(steps), message, key=key)

    def problem(self, problem: Problem) -> DocumentError:
        """Return an error (to raise) about a problem."""
        return self.error(problem.steps, problem.message, key=problem.is_key)

    def _decided(self, key: str, *, default: bool) -> bool:
        value = self.get(key, default)
        for each in not_boolean(key, value):
            raise self.problem(each)
        return as_bool(value) is True

    def _fill(self, key: str) -> Any:
        data, steps = self.written[key], (*self.steps, key)
        is_typed = key in _TYPED or (key in _COLLECTIONS and isinstance(data, str))
        try:
            return _as_ros_spells(key, filled(data, self.values, steps, as_text=not is_typed, renamed=self._renamed))
        except SubstitutionError as error:
            raise self.file.error(error.steps, str(error), key=error.is_key) from None

    def _as_written(self, steps: Sequence[Step]) -> list[Step]:
        written = list(self.steps)
        for step in steps:
            written.append(self._renamed.get((*written, step), step))
        return written


class Place(NamedTuple):
    """Place of a value in a section."""

    section: Section
    steps: tuple[Step, ...] = ()

    def error(self, message: str, steps: Sequence[Step] = (), *, key: bool = False) -> DocumentError:
        """Return an error (to raise) about the value there, or at further steps."""
        return self.section.error((*self.steps, *steps), message, key=key)


def copies(file: LaunchFile, steps: Sequence[Step], data: Mapping[str, Any], values: Values) -> Iterator[Section]:
    """Yield `count` copies of a section, with `{i}` for 0, 1, 2 ...; without a `count`, one copy without `{i}`."""
    whole = Section(file, steps, _with_letters(file, steps, data), values)
    if "count" not in data:
        yield whole
        return
    for number in range(whole.value("count", Count, 1)):
        yield Section(file, steps, whole.written, values.joined_by({NUMBER: Value.of(number)}))


def _with_letters(file: LaunchFile, steps: Sequence[Step], data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a section's data, with the letters as written under the keys that programs get."""

    def text(value: Any, *at: Step) -> Any:
        written = file.written([*steps, *at])
        return value if written is None else written

    result = dict(data)
    for key in _AS_WRITTEN:
        value = data.get(key)
        if isinstance(value, list):
            result[key] = [text(each, key, index) for index, each in enumerate(value)]
        elif isinstance(value, dict):
            result[key] = {name: text(each, key, name) for name, each in value.items()}
    return result


def _as_ros_spells(key: str, value: Any) -> Any:
    """Convert ROS 2's spellings: log levels in capitals, and `respawn: true` for `always`."""
    if key == "log_level" and isinstance(value, str):
        return value.lower()
    if key == "respawn" and isinstance(value, bool):
        return "always" if value else "never"
    return value


def as_bool(value: Any) -> bool | None:
    """Parse a boolean in the spellings that people use, `on` or `0` among them; None for anything else."""
    return _BOOLEANS.get(str(value).strip().lower()) if isinstance(value, bool | int | str) else None


def not_boolean(key: str, value: Any) -> Iterator[Problem]:
    """Yield a problem if the value of a key is not a boolean."""
    if as_bool(value) is None:
        found = "nothing" if value is None else f"'{value if isinstance(value, str) else spell(value)}'"
        yield Problem((key,), f"expected true or false, got {found}")


# Substitution


class SubstitutionError(RobolinkError, ValueError):
    """A `{name}` has no value; `steps` lead to it, to the key of a mapping if `is_key`."""

    def __init__(self, reason: str, steps: Sequence[Step], is_key: bool) -> None:
        super().__init__(reason)
        self.steps, self.is_key = steps, is_key


class Value(NamedTuple):
    """Value of a variable: plain data, and its spelling inside a text, as somebody wrote it."""

    data: Any
    text: str

    @classmethod
    def of(cls, data: Any) -> Value:
        """Return the value for data that was not written in a file."""
        return cls(data, data if isinstance(data, str) else spell(data))


class TextBudget:
    """Counter of the characters that the texts of a system have taken so far."""

    def __init__(self) -> None:
        self._in_all = self._in_this = 0

    def begin(self) -> None:
        """Restart the count of a single key."""
        self._in_this = 0

    def take(self, count: int, *, is_new: bool) -> str:
        """Count characters of a text, `is_new` if substitution added them; return an error text if it is too much."""
        self._in_all += count
        self._in_this += count if is_new else 0
        if self._in_this > MOST_TEXT:
            return f"with each {{name}} replaced this has more than {MOST_TEXT:,} characters"
        if self._in_all > MOST_TEXT_IN_ALL:
            return f"all texts together, with those of the copies, have more than {MOST_TEXT_IN_ALL:,} characters"
        return ""


class Values:
    """Variables in scope: names, and `env:NAME` for a variable of the environment."""

    def __init__(
        self,
        named: Mapping[str, Value],
        environment: Mapping[str, str] = os.environ,
        budget: TextBudget | None = None,
    ) -> None:
        self._named, self._environment = named, environment
        self.budget = TextBudget() if budget is None else budget

    def joined_by(self, more: Mapping[str, Value]) -> Values:
        """Return these values and more; the new ones win where a name is the same."""
        return Values({**self._named, **more}, self._environment, self.budget)

    def get(self, name: str) -> Value | None:
        """Return the value of a name, None if it has none."""
        if name.startswith(ENVIRONMENT):
            text = self._environment.get(name.removeprefix(ENVIRONMENT).strip())
            return None if text is None else Value(text, text)
        return self._named.get(name)

    def why_not(self, name: str) -> str:
        """Return why a name has no value, with a suggestion."""
        if name.startswith(ENVIRONMENT):
            variable = name.removeprefix(ENVIRONMENT).strip()
            return f"the environment has no '{shown(variable)}'{nearest(variable, self._environment)}"
        reason = f"nothing is called '{{{shown(name)}}}' here"
        if name == NUMBER:
            return f"{reason}: only what has a `count` is numbered"
        if name in self._environment:
            return f"{reason}: for the environment's write {{{ENVIRONMENT}{name}}}"
        known = [f"{{{each}}}" for each in self._named]
        only = f", only {', '.join(known)}" if len(known) <= _MOST_SHOWN else ""
        return f"{reason}{nearest(name, self._named) or only}; '{{{{' and '}}}}' are braces"


def filled(
    data: Any, values: Values, steps: Sequence[Step], *, as_text: bool = False, renamed: Renamed | None = None
) -> Any:
    """Return plain data with each `{name}` in its texts and keys substituted.

    A text that is nothing but `{name}` becomes the value itself, so that a number stays one. Braces around anything
    but a name stay as they are, so that JSON can be written as usual; in a text with `{{` somewhere, `{{` and `}}`
    are braces and all others are variables.

    Args:
        data: Texts, lists and mappings.
        values: The variables in scope.
        steps: Steps from the root of the file to the data, for errors.
        as_text: True where only texts can stand: then a lone `{name}` becomes its spelling.
        renamed: Gets the keys that were changed.

    Raises:
        SubstitutionError: for an unknown name, and for more text than MOST_TEXT and MOST_TEXT_IN_ALL.
    """
    values.budget.begin()
    return _filled(data, values, steps, as_text, renamed)


def _filled(data: Any, values: Values, steps: Sequence[Step], as_text: bool, renamed: Renamed | None) -> Any:
    if isinstance(data, str):
        return _filled_text(data, values, steps, is_key=False, as_text=as_text)
    if isinstance(data, list):
        return [_filled(item, values, [*steps, at], as_text, renamed) for at, item in enumerate(data)]
    if isinstance(data, dict):
        return _filled_mapping(data, values, steps, as_text, renamed)
    return data


def _filled_mapping(
    data: dict[str, Any], values: Values, steps: Sequence[Step], as_text: bool, renamed: Renamed | None
) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in data.items():
        name = _filled_text(key, values, [*steps, key], is_key=True, as_text=True)
        if name in result:
            raise SubstitutionError(f"another key is '{shown(name)}', too", [*steps, key], is_key=True)
        if name != key and renamed is not None:
            at = (*steps, name)
            renamed[at] = key
        result[name] = _filled(value, values, [*steps, key], as_text, renamed)
    return result


def _filled_text(text: str, values: Values, steps: Sequence[Step], *, is_key: bool, as_text: bool) -> Any:
    _refuse_ros(text, steps, is_key)
    if too_much := values.budget.take(len(text), is_new=False):
        raise SubstitutionError(too_much, steps, is_key)
    if "{" not in text and "}" not in text:
        return text
    has_pairs = "{{" in text

    def value_of(name: str) -> Value:
        value = values.get(name)
        if value is None:
            raise SubstitutionError(values.why_not(name), steps, is_key)
        if too_much := values.budget.take(len(value.text), is_new=True):
            raise SubstitutionError(too_much, steps, is_key)
        return value

    def replaced(match: re.Match[str]) -> str:
        braces, name = match[0], match[1]
        if name is None and len(braces) == 2:
            return braces[0]
        if name is None:
            raise SubstitutionError(f"a lone '{braces}': write '{braces * 2}' for one", steps, is_key)
        return value_of(name.strip()).text if has_pairs or _is_name(name) else braces

    whole = _IN_BRACES.fullmatch(text)
    if whole and _is_name(whole[1]) and not as_text:
        return value_of(whole[1].strip()).data
    return (_BRACES if has_pairs else _IN_BRACES).sub(replaced, text)


def _refuse_ros(text: str, steps: Sequence[Step], is_key: bool) -> None:
    if "$(" in text and (theirs := _ROS.search(text)):
        instead = _ROS_MEANS[theirs[1]].format(theirs[2])
        raise SubstitutionError(f"`{theirs[0]}` is ROS 2's: {instead}", steps, is_key)


def _is_null(data: Any, values: Values) -> bool:
    """True if a text is nothing but a `{name}` whose value is null."""
    whole = _IN_BRACES.fullmatch(data) if isinstance(data, str) else None
    value = values.get(whole[1].strip()) if whole and _is_name(whole[1]) else None
    return value is not None and value.data is None


def _is_name(text: str) -> bool:
    return _NAME.fullmatch(text.strip()) is not None
