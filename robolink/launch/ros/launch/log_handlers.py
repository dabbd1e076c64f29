"""Handlers of Python's logging that may have a format of its own for each logger (`launch.logging.handlers`).

All of `logging` and `logging.handlers` are there by their names: `handlers.FileHandler`, `handlers.QueueHandler`.
"""

from __future__ import annotations

import logging
from typing import Any

_made: dict[str, type[logging.Handler]] = {}


def with_per_logger_formatting(cls: type[logging.Handler]) -> type[logging.Handler]:
    """Return a class below the handler `cls` that has `setFormatterFor(logger, formatter)`."""

    class _PerLogger(cls):  # type: ignore[misc,valid-type]
        def __init__(self, *args: Any, **kwargs: Any) -> None:
            super().__init__(*args, **kwargs)
            self._formatters: dict[str, logging.Formatter] = {}

        def setFormatterFor(self, logger: logging.Logger | str, formatter: logging.Formatter) -> None:  # noqa: N802
            """Set the format of a logger, which may be named."""
            self._formatters[_name(logger)] = formatter

        def unsetFormatterFor(self, logger: logging.Logger | str) -> None:  # noqa: N802
            """Let a logger have the format of all."""
            self._formatters.pop(_name(logger), None)

        def format(self, record: logging.LogRecord) -> str:
            own = self._formatters.get(record.name)
            return str(super().format(record)) if own is None else own.format(record)

    _PerLogger.__name__ = _PerLogger.__qualname__ = cls.__name__
    _PerLogger.__doc__ = cls.__doc__
    return _PerLogger


def _name(logger: logging.Logger | str) -> str:
    return logger if isinstance(logger, str) else logger.name


def __getattr__(name: str) -> Any:
    """Return a handler of Python's logging by its name."""
    if name.startswith("_"):
        raise AttributeError(name)
    import logging.handlers  # it imports pickle and sockets, for handlers that few name

    found = getattr(logging.handlers, name, None) or getattr(logging, name, None)
    if not isinstance(found, type) or not issubclass(found, logging.Handler):
        raise AttributeError(f"Python's logging has no handler '{name}'")
    if name not in _made:
        _made[name] = with_per_logger_formatting(found)
    return _made[name]
