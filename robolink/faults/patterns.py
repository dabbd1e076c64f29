"""Name patterns with wildcards, for topics, services and nodes in faults."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache

_ALLOWED = re.compile(r"/?[A-Za-z0-9_*]+(?:/[A-Za-z0-9_*]+)*", re.ASCII)
_PARTS = re.compile(r"(\*\*/|/\*\*|\*\*|\*)")
_WILD = {"**/": "(?:[^/]+/)*", "/**": "(?:/[^/]+)*", "**": ".*", "*": "[^/]*"}


def listed(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return one name, or several, as a tuple."""
    return (names,) if isinstance(names, str) else tuple(names)


def mistake_in(pattern: str) -> str | None:
    """Return what is wrong with a name; None if nothing is."""
    if _ALLOWED.fullmatch(pattern) is None:
        return f"'{pattern}' is not a name: it has a-z, A-Z, digits, _ and /, and * or ** for what may stand there"
    return None


def is_pattern(name: str) -> bool:
    """True if a name has wildcards."""
    return "*" in name


def exact(names: str | Sequence[str]) -> tuple[str, ...]:
    """Return the names without wildcards."""
    return tuple(each for each in listed(names) if not is_pattern(each))


def has_pattern(names: str | Sequence[str]) -> bool:
    """True if some of the names have wildcards."""
    return any(map(is_pattern, listed(names)))


@lru_cache(maxsize=256)
def matcher(patterns: tuple[str, ...]) -> Callable[[str], bool]:
    """Return a function from a name to a bool: True if the name matches a pattern, or if there are no patterns.

    The slash in front does not matter. `*` stands for any letters of one token, `**` for any tokens.

    >>> matcher(("/robot*/scan", "**/odom"))("/robot1/scan")
    True
    """
    if not patterns:
        return lambda name: True
    regex = re.compile("|".join(_regex(each.lstrip("/")) for each in patterns))
    return lambda name: regex.fullmatch(name.lstrip("/")) is not None


def fits_any(patterns: tuple[str, ...], names: Iterable[str]) -> bool:
    """True if one of the names matches one of the patterns; False if there are no patterns."""
    return bool(patterns) and any(map(matcher(patterns), names))


def _regex(pattern: str) -> str:
    return "".join(_WILD.get(part) or re.escape(part) for part in _PARTS.split(pattern))
