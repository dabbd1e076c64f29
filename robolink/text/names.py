"""ROS 2 names: validation rules, namespaces, and matching of names that people type.

A rule is a pattern of what is invalid, so that every error has the index of the bad character.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Sequence
from typing import NamedTuple

from robolink.exceptions import AmbiguousNameError, NotFoundError, nearest
from robolink.system.patterns import late

MAX_NODE_NAME = 255
MAX_TOPIC_NAME = 247
"""Longest topic name, in characters: rmw's limit of 255, less 8 for the prefixes of services and actions."""
MAX_NAMESPACE = 245


class Problem(NamedTuple):
    """An error in a name, with the index of the bad character."""

    message: str
    invalid_index: int


class Rule(NamedTuple):
    """Validation rule: a pattern that no valid name contains; its group, if it has one, is the bad character."""

    pattern: re.Pattern[str]
    message: str


def _rules(*pairs: tuple[str, str]) -> tuple[Rule, ...]:
    return tuple(Rule(late(pattern), message) for pattern, message in pairs)


_EMPTY = (r"\A\Z", "must not be empty")
_TRAILING_SLASH = (r"/\Z", "must not end with '/'")
_TOKEN_NUMBER = (r"(?:\A|/)([0-9])", "must not start with a number in any of its tokens")

NODE_NAME_RULES = _rules(
    _EMPTY,
    (r"[^A-Za-z0-9_]", "must not contain characters other than a-z, A-Z, digits and '_'"),
    (r"\A[0-9]", "must not start with a number"),
)

FULL_NAME_RULES = _rules(
    _EMPTY,
    (r"\A[^/]", "must be absolute: begin with '/'"),
    _TRAILING_SLASH,
    (r"[^A-Za-z0-9_/]", "must not contain characters other than a-z, A-Z, digits, '_' and '/'"),
    (r"/(/)", "must not contain '//'"),
    _TOKEN_NUMBER,
)

TOPIC_NAME_RULES = _rules(
    _EMPTY,
    _TRAILING_SLASH,
    (
        r"[^A-Za-z0-9_/~{}]",
        "must not contain characters other than a-z, A-Z, digits, '_', '/', '~', '{' and '}'",
    ),
    (r"\{([0-9])", "must not start with a number in a substitution"),
    (r"\{[A-Za-z0-9_]*([/~{])", "must not contain '/', '~' or '{' within a substitution"),
    (r"(?:\A|\})[^{}]*(\})", "must not contain '}' without a '{' before it"),
    (r"\{(?![^{}]*\})", "must not contain '{' without a '}' after it"),
    (r"(?<=.)~", "must not contain '~' except as the first character"),
    (r"\A~([^/])", "must have '/' after '~'"),
    _TOKEN_NUMBER,
)


def find_problem(name: str, rules: Sequence[Rule], longest: int | None = None) -> Problem | None:
    """Return the first rule that the name breaks, and where; None for a valid name of at most `longest` characters."""
    if not _is_plain(name, rules):
        for pattern, message in rules:
            match = pattern.search(name)
            if match is not None:
                return Problem(message, match.start(match.lastindex or 0))
    if longest is not None and len(name) > longest:
        return Problem(f"must not be longer than {longest} characters, got {len(name)}", longest - 1)
    return None


def _is_plain(name: str, rules: Sequence[Rule]) -> bool:
    """True for a name without `~` and `{}` that breaks none of the rules: no pattern is compiled for it."""
    tokens = name if rules is NODE_NAME_RULES else name.removeprefix("/")
    if rules is FULL_NAME_RULES and tokens == name:
        return False
    return name.isascii() and all(map(str.isidentifier, (tokens,) if rules is NODE_NAME_RULES else tokens.split("/")))


def absolute_namespace(namespace: str) -> str:
    """Return a namespace with a leading '/', as a node's constructor adds it; '' is '/'."""
    return namespace if namespace.startswith("/") else f"/{namespace}"


def join(namespace: str, name: str) -> str:
    """Join an absolute namespace and a relative name: ('/', 'a') is '/a', ('/ns', 'a') is '/ns/a'."""
    return f"{namespace.rstrip('/')}/{name}"


def meant(name: str, known: Iterable[str]) -> list[str]:
    """Return the known names that a name means: the same one, else all with this last part, in any namespace.

    A leading slash makes no difference, neither in the name nor in those that are known.

    >>> meant("odom", ["/odom", "/ada/odom"]), meant("scan", ["ada/scan", "bob/scan", "scans"])
    (['/odom'], ['ada/scan', 'bob/scan'])
    """
    full, bare = list(known), name.strip("/")
    return [each for each in full if each.strip("/") == bare] or [each for each in full if each.endswith(f"/{bare}")]


def the_one(kind: str, name: str, known: Iterable[str], where: str = "") -> str:
    """Return the only known name that a name means.

    Raises `NotFoundError` with the nearest name if there is none, `AmbiguousNameError` if there are several.
    """
    full = list(known)
    found = meant(name, full)
    if not found:
        raise NotFoundError(kind, name, full, where)
    if len(found) > 1:
        raise AmbiguousNameError(kind, name, found)
    return found[0]


def near(name: str, known: Iterable[str]) -> str:
    """Return `` (did you mean ...?)``: a name with the same last part in another namespace goes before similar letters.

    >>> near("/odom", ["/ada/odom", "/odor"])
    " (did you mean '/ada/odom'?)"
    """
    full = list(known)
    last = name.rpartition("/")[2]
    elsewhere = next((each for each in full if each.rpartition("/")[2] == last), "")
    return f" (did you mean '{elsewhere}'?)" if elsewhere else nearest(name, full)


def spelled(text: str, fallback: str, longest: int = 60) -> str:
    """Convert any text to a valid ROS name: letters, digits and `_`, a letter first; letters lose their accents.

    >>> spelled("my robot", "robot"), spelled("2nd", "robot"), spelled("LDS-01", "lidar"), spelled("?", "lidar")
    ('my_robot', 'robot_2nd', 'LDS_01', 'lidar')
    """
    import unicodedata  # late: few programs need it

    bare = "".join(each for each in unicodedata.normalize("NFKD", text) if not unicodedata.combining(each))
    name = re.sub(r"[^A-Za-z0-9]+", "_", bare).strip("_")
    name = name if not name or name[0].isalpha() else f"{fallback}_{name}"
    return name[:longest].rstrip("_") or fallback


def unlike(name: str, taken: Collection[str]) -> str:
    """Return the name, or the first of `name_2`, `name_3` ... that is not taken."""
    numbered = (f"{name}_{number}" for number in range(2, len(taken) + 3))
    return name if name not in taken else next(each for each in numbered if each not in taken)
