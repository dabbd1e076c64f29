"""Variable substitution: replaces `{name}` in the texts and keys of a launch file."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from robolink.documents.yamlfile import spell
from robolink.exceptions import RobolinkError, nearest
from robolink.launch.reading.limits import TextBudget
from robolink.system.terminal import shown

Step: TypeAlias = "str | int"
Renamed: TypeAlias = "dict[tuple[Step, ...], str]"
"""Keys that a substitution changed: the steps to the new key, and how it was written."""

HERE = "here"
NUMBER = "i"
ENVIRONMENT = "env:"

_BRACES = re.compile(r"\{\{|\}\}|\{([^{}]*)\}|[{}]")
_IN_BRACES = re.compile(r"\{([^{}]*)\}")
_NAME = re.compile(r"[^\W\d]\w*|env:.*", re.DOTALL)
_MOST_SHOWN = 6
_ROS = re.compile(r"\$\((var|find-pkg-share)\s+'?([\w-]+)'?\)")
_ROS_MEANS = {
    "var": "write {{{0}}}, and `{0}` under `arguments`",
    "find-pkg-share": "write a path, which begins in this file's folder or in the workspace",
}


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
        SubstitutionError: for an unknown name, and for more text than `limits` allow.
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


def is_null(data: Any, values: Values) -> bool:
    """True if a text is nothing but a `{name}` whose value is null."""
    whole = _IN_BRACES.fullmatch(data) if isinstance(data, str) else None
    value = values.get(whole[1].strip()) if whole and _is_name(whole[1]) else None
    return value is not None and value.data is None


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


def _is_name(text: str) -> bool:
    return _NAME.fullmatch(text.strip()) is not None
