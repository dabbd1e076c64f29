"""Limits on what a launch file may come to: they are found while it is read, before anything is built of it."""

from __future__ import annotations

MOST_TEXT = 1_000_000
"""Characters that one text, or all that stands under one key, may have once `{name}` is replaced in it."""
MOST_TEXT_IN_ALL = 20_000_000
"""Characters of all texts of a system together, each copy counted, and of all files as often as they are included."""
MOST_PROCESSES = 1_000
"""Processes of a system."""
MOST_PARTS = 20_000
"""Copies of nodes, groups and includes."""
MOST_INCLUDES = 2_000
"""Files that are included, each as often as it is."""
DEEPEST_INCLUDES = 50
"""Files within files: each is read while the one before is."""
MOST_PARAMETERS = 10_000
"""Parameters of a node."""
MOST_REMAPPINGS = 1_000
"""Remappings that a node or a group says."""


class TextBudget:
    """Characters that the texts of a system have taken so far."""

    def __init__(self) -> None:
        self._in_all = self._in_this = 0

    def begin(self) -> None:
        """Count anew for one key."""
        self._in_this = 0

    def take(self, count: int, *, is_new: bool) -> str:
        """Count characters of a text, and whether they were put there; return what is wrong if that is too much."""
        self._in_all += count
        self._in_this += count if is_new else 0
        if self._in_this > MOST_TEXT:
            return f"with each {{name}} replaced this has more than {MOST_TEXT:,} characters"
        if self._in_all > MOST_TEXT_IN_ALL:
            return f"all texts together, with those of the copies, have more than {MOST_TEXT_IN_ALL:,} characters"
        return ""
