"""Put values in the place of `{name}` in what a launch file says."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, TypeAlias

from robolink.exceptions import RobolinkError, nearest

Steps: TypeAlias = "list[str | int]"

_BRACES = re.compile(r"\{\{|\}\}|\{([^{}]*)\}|[{}]")


class SubstitutionError(RobolinkError, ValueError):
    """A `{name}` stands for nothing; `steps` lead to it, to the key of a mapping if `is_key`."""

    def __init__(self, reason: str, steps: Steps, is_key: bool) -> None:
        super().__init__(reason)
        self.steps, self.is_key = steps, is_key


def filled(data: Any, values: Mapping[str, Any], steps: Steps) -> Any:
    """Give plain data with each `{name}` in its texts and keys replaced; `{{` and `}}` are braces.

    A text that is nothing but `{name}` becomes the value itself, so that a number stays one. `steps` lead to the
    data, for the SubstitutionError that is raised for an unknown name or a lone brace.
    """
    if isinstance(data, str):
        return _filled_text(data, values, steps, is_key=False)
    if isinstance(data, list):
        return [filled(each, values, [*steps, index]) for index, each in enumerate(data)]
    if isinstance(data, dict):
        return _filled_mapping(data, values, steps)
    return data


def _filled_mapping(data: dict[str, Any], values: Mapping[str, Any], steps: Steps) -> dict[str, Any]:
    result: dict[str, Any] = {}
    for key, value in data.items():
        name = str(_filled_text(key, values, [*steps, key], is_key=True))
        if name in result:
            raise SubstitutionError(f"another key is '{name}', too", [*steps, key], is_key=True)
        result[name] = filled(value, values, [*steps, key])
    return result


def _filled_text(text: str, values: Mapping[str, Any], steps: Steps, is_key: bool) -> Any:
    def value(match: re.Match[str]) -> str:
        braces = match[0]
        if len(braces) == 2 and braces[0] == braces[1]:
            return braces[0]
        if match[1] in values:
            return str(values[match[1]])
        raise SubstitutionError(_reason(match, values), steps, is_key)

    whole = text[1:-1] if text.startswith("{") and text.endswith("}") else ""
    return values[whole] if whole in values else _BRACES.sub(value, text)


def _reason(match: re.Match[str], values: Mapping[str, Any]) -> str:
    known = ", ".join(f"{{{name}}}" for name in values)
    if match[1] is None:
        return f"a lone '{match[0]}': write '{match[0] * 2}' for one"
    near = nearest(match[1], values)
    return f"nothing is called '{match[0]}' here{near or f', only {known}'}; '{{{{' and '}}}}' are braces"
