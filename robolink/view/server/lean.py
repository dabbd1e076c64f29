"""Lean scripts and style sheets: sent without comments and indentation; lines stay where they are."""

from __future__ import annotations

import re
from functools import lru_cache

_COMMENT = re.compile(r"^[ \t]*(?://.*|/\*(?:[^*]|\*(?!/))*\*/[ \t]*)$", re.MULTILINE)
"""Comments that have their lines to themselves."""

_MARGIN = re.compile(r"^[ \t]+|[ \t]+// [^\"'`\n]*$", re.MULTILINE)
"""Indentation, and comments at the end of a line in which no text can end: `"a // b"` is not one."""


@lru_cache(256)
def lean(body: bytes, suffix: str) -> bytes:
    """Return a file's bytes without comments and indentation.

    Args:
        body: The file, in UTF-8; its texts and templates end in the line in which they begin.
        suffix: `.js`, `.css`, or another one, of which nothing is left out.
    """
    if suffix not in {".js", ".css"}:
        return body
    return _MARGIN.sub("", _COMMENT.sub(lambda found: "\n" * found.group().count("\n"), body.decode())).encode()
