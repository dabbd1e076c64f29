"""Resource limits of launch files, checked while a file is read, before anything is built from it."""

from __future__ import annotations

MOST_TEXT = 1_000_000
"""Most characters of one text, or of everything under one key, after substitution."""
MOST_TEXT_IN_ALL = 20_000_000
"""Most characters of a system: of all texts, each copy counted, and of all files, each include counted."""
MOST_PROCESSES = 1_000
"""Most processes of a system."""
MOST_PARTS = 20_000
"""Most copies of nodes, groups and includes in all."""
MOST_INCLUDES = 2_000
"""Most includes, each file counted as often as it is included."""
DEEPEST_INCLUDES = 50
"""Deepest nesting of includes: each file is read while the one above it is."""
MOST_PARAMETERS = 10_000
"""Most parameters of a node."""
MOST_REMAPPINGS = 1_000
"""Most remappings of a node or a group."""


class TextBudget:
    """Counter of the characters that the texts of a system have taken so far."""

    def __init__(self) -> None:
        self._in_all = self._in_this = 0

    def begin(self) -> None:
        """Restart the count of a single key."""
        self._in_this = 0

    def take(self, count: int, *, is_new: bool) -> str:
        """Count characters of a text, `is_new` if substitution added them; return an error text if it is too much."""
        self._in_all += count
        self._in_this += count if is_new else 0
        if self._in_this > MOST_TEXT:
            return f"with each {{name}} replaced this has more than {MOST_TEXT:,} characters"
        if self._in_all > MOST_TEXT_IN_ALL:
            return f"all texts together, with those of the copies, have more than {MOST_TEXT_IN_ALL:,} characters"
        return ""
