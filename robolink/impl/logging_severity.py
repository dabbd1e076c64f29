"""Severities of log lines: DEBUG, INFO, WARN, ERROR, FATAL."""

from __future__ import annotations

from enum import IntEnum

from robolink.exceptions import RobolinkError, nearest


class LoggingSeverity(IntEnum):
    """The severities, numbered as in rcutils; UNSET stands for "as the parent logger"."""

    UNSET = 0
    DEBUG = 10
    INFO = 20
    WARN = 30
    ERROR = 40
    FATAL = 50


class LoggingSeverityError(RobolinkError, RuntimeError):
    """A text is not a log severity."""


def get_logging_severity_from_string(log_severity: str) -> LoggingSeverity:
    """Read 'info', 'INFO' ...; raises `LoggingSeverityError` (a `RuntimeError`) for anything else."""
    severity = LoggingSeverity.__members__.get(log_severity.upper())
    if severity is None:
        known = ", ".join(LoggingSeverity.__members__)
        hint = nearest(log_severity.upper(), LoggingSeverity.__members__)
        raise LoggingSeverityError(f"no log severity named '{log_severity}'{hint}: they are {known}")
    return severity
