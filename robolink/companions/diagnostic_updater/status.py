"""State of a part of the robot, which diagnostic tasks fill out."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus, KeyValue


class DiagnosticStatusWrapper(DiagnosticStatus):
    """DiagnosticStatus that is filled out step by step."""

    def summary(self, *args: Any) -> None:
        """Set level and message.

        Args:
            *args: A status, whose level and message are taken, or a level and a message.
        """
        level, message = _parts(args)
        self.level, self.message = level, str(message)

    def clearSummary(self) -> None:  # noqa: N802 - ROS 2's name
        """Set the level to OK and the message to nothing."""
        self.summary(DiagnosticStatus.OK, "")

    def mergeSummary(self, *args: Any) -> None:  # noqa: N802 - ROS 2's name
        """Join another level and message: the higher level counts.

        Of an OK and another level only the other's message is kept; two of a kind are joined by a semicolon.

        Args:
            *args: A status, or a level and a message.
        """
        level, message = _parts(args)
        if (level > DiagnosticStatus.OK) == (self.level > DiagnosticStatus.OK):
            self.message = f"{self.message}; {message}" if self.message else str(message)
        elif level > self.level:
            self.message = str(message)
        self.level = max(self.level, level)

    def add(self, key: str, val: str) -> None:
        """Add a text `val` by its name, `key`."""
        self.values = [*self.values, KeyValue(key=key, value=val)]


def _parts(args: tuple[Any, ...]) -> tuple[Any, Any]:
    if len(args) == 1:
        return args[0].level, args[0].message
    level, message = args
    return level, message
