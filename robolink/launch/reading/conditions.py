"""Whether a part of a launch file is wanted: its `if` and `unless`."""

from __future__ import annotations

from typing import Any

from robolink.launch.reading.part import Part
from robolink.yamlfile import spell

_WORDS = {
    **dict.fromkeys(("true", "yes", "on", "y", "1"), True),
    **dict.fromkeys(("false", "no", "off", "n", "0"), False),
}


def as_bool(value: Any) -> bool | None:
    """Read true or false in the spellings that people use, `on` or `0` among them; None for anything else."""
    if isinstance(value, bool | int | str):
        return _WORDS.get(str(value).strip().lower())
    return None


def is_wanted(part: Part) -> bool:
    """Say whether a part is to be started. Raises `DocumentError` for a condition that is neither true nor false."""
    return decided(part, "if", default=True) and not decided(part, "unless", default=False)


def decided(part: Part, key: str, *, default: bool) -> bool:
    """Say whether a key of a part says true. Raises `DocumentError` for what is neither true nor false."""
    if key not in part:
        return default
    said = part.get(key)
    result = as_bool(said)
    if result is None:
        found = f"'{said if isinstance(said, str) else spell(said)}'"
        raise part.error([key], f"expected true or false, got {'nothing' if said is None else found}")
    return result
