"""Validation of the text of keys and tokens: length limit, numbers, patterns."""

from __future__ import annotations

import functools
import re

from robolink.exceptions import WireError

LONGEST = 4096
"""Longest key or token, in characters; longer ones are refused unread. ROS 2's own names end at 255."""

remembered = functools.lru_cache(maxsize=1024)
"""LRU cache for parts of tokens: each endpoint of a node repeats the node's name, and each node the same types."""

_NUMBER = re.compile(r"0|[1-9][0-9]{0,18}")


def format_number(value: int) -> str:
    """Format a domain or entity number; raises WireError for a negative or giant one."""
    return matched(_NUMBER, str(value), "a domain or entity number")


def parse_number(text: str) -> int:
    """Parse a number; raises WireError for anything else."""
    return int(matched(_NUMBER, text, "a number"))


def matched(pattern: re.Pattern[str], text: str, what: str) -> str:
    """Return the text if all of it matches; raises WireError with `what` was expected if not."""
    if pattern.fullmatch(not_too_long(text, what)) is None:
        raise WireError(f"expected {what}, got {quoted(text)}")
    return text


def not_too_long(text: str, what: str) -> str:
    """Return the text if it has at most LONGEST characters; raises WireError if not."""
    if len(text) > LONGEST:
        raise WireError(f"{what} has at most {LONGEST} characters, got {len(text)}: {quoted(text)}")
    return text


def quoted(text: str) -> str:
    """Quote a text for an error, cut where it is long."""
    return repr(text if len(text) <= 120 else text[:120] + "…")
