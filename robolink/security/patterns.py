"""Patterns of names in policies, with `*`: which names fit, and which key expressions Zenoh has for them.

As in DDS, `*` stands for any text, slashes included: `/*` is every name, `/arm/*` all below /arm, `/scan*` also
/scan_2 and /scan/raw. It may be a whole part of a name, or the end of the last.
"""

from __future__ import annotations

import re

from robolink.wire.keys import CHUNK

_NAME = re.compile(rf"(?:/(?:{CHUNK}|\*))*/(?:{CHUNK}\*?|\*)")


def problem(pattern: str) -> str:
    """Return the error of a pattern; '' if there is none."""
    if len(pattern) > 255:
        return f"a name has at most 255 letters, this one has {len(pattern)}"
    if _NAME.fullmatch(pattern):
        return ""
    return "a name is /a/b; a * stands for a whole part of it, or at its end"


def fits(pattern: str, name: str) -> bool:
    """True if a name fits a pattern; takes a time that grows with the product of their parts at most.

    >>> fits("/arm/*", "/arm/left/joint"), fits("/arm/*", "/arm"), fits("/scan*", "/scan_2")
    (True, False, True)
    """
    if "*" not in pattern:
        return pattern == name
    parts = name.split("/")
    if parts[0] or not all(parts[1:]) or len(parts) == 1:
        return False
    reached = {1}  # parts of the name with which what is left of the pattern may go on
    *inner, last = pattern.split("/")[1:]
    for part in inner:
        if part == "*":
            reached = set(range(min(reached) + 1, len(parts)))
        else:
            reached = {index + 1 for index in reached if index + 1 < len(parts) and parts[index] == part}
        if not reached:
            return False
    if last.endswith("*"):
        return any(parts[index].startswith(last[:-1]) for index in reached)
    return len(parts) - 1 in reached and parts[-1] == last


def keys(pattern: str, domain: int) -> list[str]:
    """Return the key expressions of all topics or services that fit a pattern, of any type.

    >>> keys("/arm/*", 0), keys("/scan", 7)
    (['0/arm/*/*/*/**'], ['7/scan/*/*', '7/scan/*/*/_buf_cpu'])
    """
    parts = [str(domain)]
    for part in pattern.split("/")[1:]:
        parts += ["*", "**"] if part == "*" else [part.replace("*", "$*"), "**"] if part.endswith("*") else [part]
    text = "/".join(_canonical([*parts, "*", "*"]))
    return [text] if "*" in pattern else [text, f"{text}/_buf_cpu"]


def _canonical(parts: list[str]) -> list[str]:
    """Return parts in Zenoh's order: each `**` behind the `*` that follow it, and only one of several."""
    result: list[str] = []
    for part in parts:
        if part == "*" and result[-1:] == ["**"]:
            result.insert(-1, part)
        elif part != "**" or result[-1:] != ["**"]:
            result.append(part)
    return result


def beside(pattern: str, domain: int, end: str) -> list[str]:
    """Return the key expressions of what advanced publishers or subscribers keep beside the keys of a pattern."""
    return [f"{key}/@adv/{end}/**" for key in keys(pattern, domain) if not key.endswith("_buf_cpu")]


def mangled(pattern: str) -> str:
    """Return a pattern as one part of a token, in which `%` stands for `/`.

    >>> mangled("/arm/*"), mangled("/scan")
    ('%arm%$*', '%scan')
    """
    return pattern.replace("/", "%").replace("*", "$*")
