"""Zenoh key expressions, matched without Zenoh."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable


@functools.lru_cache(maxsize=64)
def matcher(pattern: str) -> Callable[[str], bool]:
    """Return a matcher of Zenoh key expressions: `*` is one chunk, `**` any number, but none that begins with @."""
    wild = {"*": r"/(?!@)[^/]+", "**": r"(?:/(?!@)[^/]+)*"}
    regex = re.compile("".join(wild.get(chunk, "/" + re.escape(chunk)) for chunk in pattern.split("/")))
    return lambda token: regex.fullmatch("/" + token) is not None
