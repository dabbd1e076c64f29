"""Actions that write lines for people (`launch.actions`)."""

from __future__ import annotations

from typing import Any

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import Action, LaunchContext, LaunchError, Said, SomeSubstitutionsType
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from robolink.system.terminal import shown

__all__ = [
    "Log",
    "LogDebug",
    "LogError",
    "LogInfo",
    "LogWarning",
]

SEVERITIES = {
    "CRITICAL": "FATAL",
    "FATAL": "FATAL",
    "ERROR": "ERROR",
    "WARNING": "WARN",
    "WARN": "WARN",
    "INFO": "INFO",
    "DEBUG": "DEBUG",
    "NOTSET": "DEBUG",
}
"""Severities of lines, by the names of Python's levels."""


class Log(Action):
    """Write a line.

    Args:
        msg: The text.
        level: Its level by Python's name, in capitals or not: debug, info, warning, error, critical.
        **kwargs: `condition`.
    """

    def __init__(self, *, msg: SomeSubstitutionsType, level: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.msg, self.level = normalize_to_list_of_substitutions(msg), normalize_to_list_of_substitutions(level)

    def execute(self, context: LaunchContext) -> None:
        """Write it as a line of the launcher's own, with the values of `context`. Raises LaunchError for another level.

        One of the level debug is shown by a LaunchService(debug=True), or where `launch.logging` is set to it.
        """
        import logging

        level = perform_substitutions(context, self.level).upper()
        if level not in SEVERITIES:
            hint = nearest(level, SEVERITIES) or f": there is {', '.join(SEVERITIES)}"
            raise LaunchError(f"no level is called '{shown(level)}'{hint}")
        if SEVERITIES[level] != "DEBUG" or logging.getLogger("launch.user").isEnabledFor(logging.DEBUG):
            context.said.append(Said(perform_substitutions(context, self.msg), SEVERITIES[level]))


class LogInfo(Log):
    """Write a line of the level info.

    Args:
        msg: The text.
        **kwargs: `condition`.
    """

    LEVEL = "INFO"

    def __init__(self, *, msg: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(msg=msg, level=self.LEVEL, **kwargs)


class LogDebug(LogInfo):
    """Write a line of the level debug, as LogInfo does."""

    LEVEL = "DEBUG"


class LogWarning(LogInfo):
    """Write a line of the level warning, as LogInfo does."""

    LEVEL = "WARNING"


class LogError(LogInfo):
    """Write a line of the level error, as LogInfo does."""

    LEVEL = "ERROR"
