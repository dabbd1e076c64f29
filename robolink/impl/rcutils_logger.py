"""Logger of a node: `info`, `warning` ..., each line optionally once, throttled or not the first."""

from __future__ import annotations

import os
import sys
import threading
from types import FrameType
from typing import Any, NamedTuple, Protocol, TypeAlias

from robolink.impl.log_levels import SEPARATOR, levels
from robolink.impl.log_output import Record, output
from robolink.impl.logging_severity import LoggingSeverity

_DEBUG, _INFO = LoggingSeverity.DEBUG, LoggingSeverity.INFO  # an enum's attributes are slow to look up
_thresholds = levels.thresholds


class RcutilsLogger:
    """Logger of a `name`, whose levels and filters decide about each line.

    The methods that log return True if the line was logged, False if its level is off or a filter kept it back.
    Filters are keywords (`**kwargs`), and each place in a program that logs must always use the same ones:

    - `once=True`: only the first time
    - `skip_first=True`: not the first time
    - `throttle_duration_sec=2.0`: at most every two seconds of `throttle_time_source_type`, a clock (the
      time of the log stamps by default)
    - `name="other"`: as if another logger had written it
    """

    def __init__(self, name: str = "") -> None:
        self.name = name
        self._sites: dict[_SiteKey, _Site] = {}

    def get_child(self, name: str) -> RcutilsLogger:
        """Return the logger `name` below this one, `<this name>.<name>`, which inherits this one's level."""
        if not name:
            raise ValueError("Child logger name must not be empty.")
        return RcutilsLogger(f"{self.name}{SEPARATOR}{name}" if self.name else name)

    def set_level(self, level: int | LoggingSeverity) -> None:
        """Set the least severity that is logged to `level`; UNSET inherits the parent's."""
        levels.set(self.name, LoggingSeverity(level))

    def get_effective_level(self) -> LoggingSeverity:
        """Return the level that counts: this logger's, or its nearest ancestor's."""
        return levels.effective(self.name)

    def is_enabled_for(self, severity: int | LoggingSeverity) -> bool:
        """True if a line of this `severity` would be logged."""
        return LoggingSeverity(severity) >= levels.effective(self.name)

    def debug(self, message: str, **kwargs: Any) -> bool:
        """Log `message`, which helps to find a fault; off by default. `kwargs` are filters."""
        if _thresholds.get(self.name, _DEBUG) > _DEBUG:
            return False
        return self.log(message, _DEBUG, **kwargs)

    def info(self, message: str, **kwargs: Any) -> bool:
        """Log `message`, which a user wants to know. `kwargs` are filters."""
        if _thresholds.get(self.name, _INFO) > _INFO:
            return False
        return self.log(message, _INFO, **kwargs)

    def warning(self, message: str, **kwargs: Any) -> bool:
        """Log `message`, of what may turn out bad. `kwargs` are filters."""
        return self.log(message, LoggingSeverity.WARN, **kwargs)

    warn = warning

    def error(self, message: str, **kwargs: Any) -> bool:
        """Log `message`, of what went wrong. `kwargs` are filters."""
        return self.log(message, LoggingSeverity.ERROR, **kwargs)

    def fatal(self, message: str, **kwargs: Any) -> bool:
        """Log `message`, of why the program cannot go on. `kwargs` are filters."""
        return self.log(message, LoggingSeverity.FATAL, **kwargs)

    def log(self, message: str, severity: int | LoggingSeverity, name: str | None = None, **kwargs: Any) -> bool:
        """Log a line of any severity.

        Args:
            message: Text of the line.
            severity: Severity of the line.
            name: Name of the logger to show; None is this one's.
            **kwargs: Filters: `once`, `skip_first`, `throttle_duration_sec` and `throttle_time_source_type`.

        Returns:
            True if the line was logged.

        Raises:
            TypeError: for unknown or incomplete filters.
            ValueError: if the severity, the name or the filters differ from the last time at this place of the
                program.
        """
        if severity < levels.effective(self.name):
            return False
        frame = _find_caller(sys._getframe(1))
        code = frame.f_code
        key = (code.co_filename, code.co_firstlineno, code.co_name, frame.f_lasti)
        site = self._sites.get(key)
        if site is None or (severity, name or self.name, kwargs) != site.call:
            filters = _read_filters(kwargs) if kwargs else _NO_FILTERS
            if site is None:
                fresh = _Site(LoggingSeverity(severity), name or self.name, filters, frame)
                site = self._sites.setdefault(key, fresh)
            site.check(severity, name or self.name, filters)
            site.call = severity, name or self.name, kwargs
        if site.filters is not _NO_FILTERS and not site.passes():
            return False
        output.emit(site.record(message))
        return True


class _Clock(Protocol):
    def now(self) -> Any: ...


class _Filters(NamedTuple):
    """The filters of one call; `throttle` is None where there is none."""

    throttle: float | None = None
    clock: _Clock | None = None
    skip_first: bool = False
    once: bool = False

    def kinds(self) -> tuple[bool, bool, bool]:
        return self.throttle is not None, self.skip_first, self.once


_NO_FILTERS = _Filters()
_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")
_SiteKey: TypeAlias = tuple[str, int, str, int]


def _read_filters(options: dict[str, Any]) -> _Filters:
    for option in options:
        if option not in _OPTIONS:
            raise TypeError(f'parameter "{option}" is not one of the recognized logging options {list(_OPTIONS)}')
    duration, clock, skip_first, once = map(options.get, _OPTIONS)
    if clock and duration is None:
        raise TypeError('required parameter "throttle_duration_sec" not specified for the throttle filter')
    throttle = duration if duration or clock else None
    return _Filters(throttle, clock or None, bool(skip_first), bool(once))


class _Site:
    """Place in a program that logs: what it always uses, and what its filters remember."""

    lock = threading.Lock()

    def __init__(self, severity: LoggingSeverity, name: str, filters: _Filters, frame: FrameType) -> None:
        if filters.clock is not None and not hasattr(filters.clock, "now"):
            raise ValueError(f"throttle_time_source_type must be a clock, got {filters.clock!r}")
        self.severity, self.name, self.filters = severity, name, filters
        file = frame.f_code.co_filename
        self.file = file if os.path.isabs(file) else os.path.join(os.getcwd(), file)  # noqa: PTH109, PTH117, PTH118
        self.function, self.line = frame.f_code.co_name, frame.f_lineno
        # The first line passes; with a clock of the user's it is held back at time 0, as rclpy does.
        self.last_logged = -(2**63) if filters.clock is None else 0
        self.was_skipped = self.was_logged = False
        self.call: tuple[int, str, dict[str, Any]] | None = None
        """Severity, name and filters of a call that was checked: one that is the same need not be."""

    def check(self, severity: int, name: str, filters: _Filters) -> None:
        if severity != self.severity:
            raise ValueError(f"Logger severity cannot be changed between calls. {self._place()}")
        if name != self.name:
            raise ValueError(f"Logger name cannot be changed between calls. {self._place()}")
        if filters.kinds() != self.filters.kinds():
            raise ValueError(f"Logging filters cannot be changed between calls. {self._place()}")
        if filters != self.filters:
            raise ValueError(f"Logging filter parameters cannot be changed between calls. {self._place()}")

    def _place(self) -> str:
        return f"({self.file}:{self.line} logs {self.severity.name} as '{self.name}')"

    def passes(self) -> bool:
        """True if all filters let the line pass, in rclpy's order; the first that keeps it back spares the others."""
        with self.lock:
            return self._throttle_passes() and self._skip_first_passes() and self._once_passes()

    def _throttle_passes(self) -> bool:
        if self.filters.throttle is None:
            return True
        clock = self.filters.clock
        now: int = output.now() if clock is None else clock.now().nanoseconds
        # A clock that was set back, as a restarted simulation does, must not silence the line.
        if self.last_logged <= now < self.last_logged + self.filters.throttle * 1e9:
            return False
        self.last_logged = now
        return True

    def _skip_first_passes(self) -> bool:
        passes = self.was_skipped or not self.filters.skip_first
        self.was_skipped = True
        return passes

    def _once_passes(self) -> bool:
        passes = not (self.filters.once and self.was_logged)
        self.was_logged = True
        return passes

    def record(self, message: str) -> Record:
        return Record(output.now(), self.severity, self.name, str(message), self.file, self.function, self.line)


internal_files = {_read_filters.__code__.co_filename}
"""Files whose frames are not taken for the place that logs; add those of your own wrappers."""


def _find_caller(frame: FrameType) -> FrameType:
    """Return the nearest frame outside of `internal_files`."""
    while frame.f_code.co_filename in internal_files and frame.f_back is not None:
        frame = frame.f_back
    return frame
