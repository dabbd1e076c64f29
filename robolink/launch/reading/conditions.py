"""Conditions of a launch file: the keys `if` and `unless`."""

from __future__ import annotations

from typing import Any

from robolink.documents.yamlfile import spell
from robolink.launch.reading.section import Section

_WORDS = {
    **dict.fromkeys(("true", "yes", "on", "y", "1"), True),
    **dict.fromkeys(("false", "no", "off", "n", "0"), False),
}


def as_bool(value: Any) -> bool | None:
    """Parse a boolean in the spellings that people use, `on` or `0` among them; None for anything else."""
    if isinstance(value, bool | int | str):
        return _WORDS.get(str(value).strip().lower())
    return None


def is_wanted(section: Section) -> bool:
    """True if a section is to be started; raises `DocumentError` for a condition that is no boolean."""
    return decided(section, "if", default=True) and not decided(section, "unless", default=False)


def decided(section: Section, key: str, *, default: bool) -> bool:
    """Return the boolean under a key of a section; raises `DocumentError` for a value that is none."""
    if key not in section:
        return default
    said = section.get(key)
    result = as_bool(said)
    if result is None:
        found = f"'{said if isinstance(said, str) else spell(said)}'"
        raise section.error([key], f"expected true or false, got {'nothing' if said is None else found}")
    return result
