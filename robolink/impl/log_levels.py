"""Levels of loggers, by name, inherited along the dots."""

from __future__ import annotations

import threading

from robolink.impl.logging_severity import LoggingSeverity

SEPARATOR = "."
DEFAULT_LEVEL = LoggingSeverity.INFO


class LogLevels:
    """Levels that were set, by name; '' is the root, from which everything inherits.

    `thresholds` remembers the effective level of each name that was asked for, so that a line that is not
    wanted costs one look into a dict. It is emptied whenever a level changes.
    """

    def __init__(self) -> None:
        self.thresholds: dict[str, LoggingSeverity] = {}
        self._lock = threading.Lock()
        self._levels = {"": DEFAULT_LEVEL}

    def set(self, name: str, level: LoggingSeverity) -> None:
        """Set a logger's own level; UNSET lets it inherit again."""
        with self._lock:
            self._levels[name] = level
            self.thresholds.clear()

    def get(self, name: str) -> LoggingSeverity:
        """Return a logger's own level, UNSET where it inherits."""
        return self._levels.get(name, LoggingSeverity.UNSET)

    def effective(self, name: str) -> LoggingSeverity:
        """Return the level of the logger or of its nearest ancestor that has one."""
        level = self.thresholds.get(name)
        if level is None:
            with self._lock:
                level = self.thresholds[name] = self._inherited(name)
        return level

    def clear(self) -> None:
        """Forget all levels: the root is back at INFO."""
        with self._lock:
            self._levels = {"": DEFAULT_LEVEL}
            self.thresholds.clear()

    def _inherited(self, name: str) -> LoggingSeverity:
        while name and not self.get(name):
            name = name.rpartition(SEPARATOR)[0]
        return self.get(name)


levels = LogLevels()
"""Levels of this process."""
