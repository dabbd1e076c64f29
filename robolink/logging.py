"""Logging as in rclpy: named loggers with levels, whose lines go to the console and to handlers."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.impl.log_levels import levels
from robolink.impl.log_output import Console, Handler, Record, output
from robolink.impl.logging_severity import LoggingSeverity, get_logging_severity_from_string
from robolink.impl.rcutils_logger import RcutilsLogger

if TYPE_CHECKING:
    from pathlib import Path

__all__ = [
    "LoggingSeverity",
    "RcutilsLogger",
    "Record",
    "add_handler",
    "clear_config",
    "get_logger",
    "get_logger_effective_level",
    "get_logger_level",
    "get_logging_directory",
    "get_logging_severity_from_string",
    "initialize",
    "remove_handler",
    "set_console_handler",
    "set_logger_level",
    "set_time_source",
    "shutdown",
]

_root_logger = RcutilsLogger()


def get_logger(name: str) -> RcutilsLogger:
    """Return a new logger called `name`; levels belong to names, filters to the object. Raises ValueError for ''."""
    if not name:
        raise ValueError("Logger name must not be empty.")
    return _root_logger.get_child(name)


def initialize() -> None:
    """Read the environment's settings again for the console."""
    if isinstance(output.console, Console):
        output.console = Console()


def shutdown() -> None:
    """Forget all levels. Logging goes on working."""
    levels.clear()


def clear_config() -> None:
    """Forget all levels and read the environment's settings again."""
    shutdown()
    initialize()


def set_logger_level(name: str, level: int | LoggingSeverity, detailed_error: bool = False) -> None:
    """Set the level of a logger, also of one that does not exist yet.

    Args:
        name: Name of the logger; '' is the root.
        level: Least severity that is logged; UNSET takes that of the nearest ancestor.
        detailed_error: rclpy's; changes nothing.

    Raises:
        ValueError: if `level` is not a severity.
    """
    levels.set(name, LoggingSeverity(level))


def get_logger_effective_level(name: str) -> LoggingSeverity:
    """Return the level that counts for the logger `name`: its own, or its nearest ancestor's."""
    return levels.effective(name)


def get_logger_level(name: str) -> LoggingSeverity:
    """Return the level that was set for the logger `name`, UNSET if it inherits one."""
    return levels.get(name)


def get_logging_directory() -> Path:
    """Return the folder for log files: $ROS_LOG_DIR, or $ROS_HOME/log, or ~/.ros/log."""
    from pathlib import Path  # late: few programs ask, and it takes their start 3 ms

    chosen = os.environ.get("ROS_LOG_DIR")
    return (Path(chosen) if chosen else Path(os.environ.get("ROS_HOME") or "~/.ros", "log")).expanduser()


def add_handler(handler: Handler) -> None:
    """Pass every log line to `handler(record)` too, in the thread that logs."""
    output.add(handler)


def remove_handler(handler: Handler) -> None:
    """Pass log lines to `handler` no more; one that was never added is not an error."""
    output.remove(handler)


def set_console_handler(handler: Handler | None) -> None:
    """Replace the console by `handler`, or silence it with None."""
    output.console = handler


def set_time_source(now: Callable[[], int]) -> None:
    """Stamp log lines with `now()`, nanoseconds, such as a virtual clock's."""
    output.now = now
