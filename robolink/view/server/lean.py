"""Lean scripts and style sheets: sent without what a browser does not need; lines stay where they are."""

from __future__ import annotations

import re
from functools import lru_cache

_COMMENT = re.compile(r"^[ \t]*(?://.*|/\*(?:[^*]|\*(?!/))*\*/[ \t]*)$", re.MULTILINE)
"""Comments that have their lines to themselves."""

_MARGIN = re.compile(r"^[ \t]+|[ \t]+// [^\"'`\n]*$", re.MULTILINE)
"""Indentation, and comments at the end of a line in which no text can end: `"a // b"` is not one."""

_TEXT = re.compile(r"""("(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|`(?:\\.|[^`\\])*`)""")
"""Strings and templates of a line. A template within a template ends the outer one here: `_is_whole` finds that out."""

_SPACE = re.compile(r" ?([][{}();,:=<>*?&|!]) ?|(?:^|(?<=[\w)\]])) ([+/-]) (?=[\w(\[]|$)")
"""Spaces around signs that need none; those of + and - only between two operands: `a + +b` is not `a++b`."""

_STYLE = re.compile(r";?(?: ?([{}])|([;:,])) ")


@lru_cache(256)
def lean(body: bytes, suffix: str) -> bytes:
    """Return a file's bytes without comments, indentation and spaces that mean nothing.

    Args:
        body: The file, in UTF-8.
        suffix: `.js`, `.css`, or another one, of which nothing is left out.
    """
    if suffix not in {".js", ".css"}:
        return body
    bare = _COMMENT.sub(lambda found: "\n" * found.group().count("\n"), body.decode())
    if suffix == ".css":
        return _STYLE.sub(r"\1\2", bare).encode()
    return "\n".join(_tight(each) for each in _MARGIN.sub("", bare).split("\n")).encode()


def _tight(line: str) -> str:
    """Return a line of a script without spaces around its signs; one that may hold a regular expression as it is."""
    parts = _TEXT.split(line)
    code = "".join(parts[::2])
    if "`" in code or "/" in code.replace(" / ", "") or not all(map(_is_whole, parts[1::2])):
        return line
    parts[::2] = [_SPACE.sub(r"\1\2", each) for each in parts[::2]]
    return "".join(parts)


def _is_whole(text: str) -> bool:
    """Return whether a string is not a template that another one within it has cut off."""
    return text[0] != "`" or text.count("{") == text.count("}")
