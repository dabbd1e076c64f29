"""Output of log lines: to the console, in ROS's format, and to handlers."""

from __future__ import annotations

import os
import re
import sys
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import NamedTuple, TextIO, TypeAlias

from robolink.impl.logging_severity import LoggingSeverity
from robolink.system import clocks
from robolink.system.patterns import late
from robolink.system.terminal import fit, knows_colours

DEFAULT_FORMAT = "[{severity}] [{time}] [{name}]: {message}"


class Record(NamedTuple):
    """One log line and where it was written."""

    stamp_ns: int
    severity: LoggingSeverity
    name: str
    message: str
    file: str
    function: str
    line: int


Handler: TypeAlias = Callable[[Record], None]


class LogOutput:
    """Distributor of log records to the console and to the handlers, in the thread that logs.

    `console` may be replaced, or None for silence. `now` gives the stamps, in nanoseconds. A handler may log:
    its own lines go to the console only. A handler that raises is reported once on the console.
    """

    def __init__(self, console: Handler | None, now: Callable[[], int] = clocks.now) -> None:
        self.console = console
        self.now = now
        self._handlers: tuple[Handler, ...] = ()
        self._lock = threading.Lock()
        self._thread = _InThread()
        self._failed: list[Handler] = []

    def add(self, handler: Handler) -> None:
        """Pass every further record to a handler too."""
        with self._lock:
            self._handlers = (*self._handlers, handler)

    def remove(self, handler: Handler) -> None:
        """Remove a handler; one that is not there is no error."""
        with self._lock:
            self._handlers = tuple(each for each in self._handlers if each != handler)
            self._failed = [each for each in self._failed if each != handler]

    def emit(self, record: Record) -> None:
        """Pass a record to the console and to all handlers."""
        if self.console is not None:
            self.console(record)
        if self._thread.handling:
            return
        self._thread.handling = True
        try:
            for handler in self._handlers:
                self._hand_over(record, handler)
        finally:
            self._thread.handling = False

    def _hand_over(self, record: Record, handler: Handler) -> None:
        try:
            handler(record)
        except Exception as error:  # noqa: BLE001 - a handler is anybody's code; a log line must not end a program
            if self.console is not None and handler not in self._failed:
                self._failed.append(handler)
                text = f"log handler {handler!r} failed: {type(error).__name__}: {error}"
                self.console(record._replace(severity=LoggingSeverity.ERROR, name="logging", message=text))


class _InThread(threading.local):
    handling = False


class Console:
    """Handler that writes each record as one line to stderr, in one write; coloured in a terminal.

    As in ROS, RCUTILS_CONSOLE_OUTPUT_FORMAT is the format, RCUTILS_COLORIZED_OUTPUT=0 or 1 decides about
    colours (else NO_COLOR, else whether it is a terminal), and RCUTILS_LOGGING_USE_STDOUT=1 chooses stdout.
    A message may hold text of others: of what a terminal obeys it keeps line breaks and colours.
    """

    def __init__(self, environ: Mapping[str, str] = os.environ) -> None:
        self._format = compile_format(environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT") or DEFAULT_FORMAT)
        forced = {"0": False, "1": True}.get(environ.get("RCUTILS_COLORIZED_OUTPUT", ""))
        self._coloured = False if forced is None and environ.get("NO_COLOR") else forced
        self._use_stdout = environ.get("RCUTILS_LOGGING_USE_STDOUT") == "1"

    def __call__(self, record: Record) -> None:
        """Write a record."""
        stream: TextIO | None = sys.stdout if self._use_stdout else sys.stderr
        if stream is None or getattr(stream, "closed", False):  # under pythonw, or late at exit
            return
        text = self._format(record)
        colour = _COLOURS.get(record.severity)
        if colour and (stream.isatty() and knows_colours() if self._coloured is None else self._coloured):
            text = f"{colour}{text}\x1b[0m"
        _write_line(stream, text)


_COLOURS = {
    LoggingSeverity.DEBUG: "\x1b[32m",
    LoggingSeverity.INFO: "\x1b[0m",
    LoggingSeverity.WARN: "\x1b[33m",
    LoggingSeverity.ERROR: "\x1b[31m",
    LoggingSeverity.FATAL: "\x1b[31m",
}


def _write_line(stream: TextIO, text: str) -> None:
    with suppress(OSError):  # the reader of a pipe is gone
        try:
            stream.write(f"{text}\n")
        except UnicodeEncodeError:
            stream.write(text.encode("ascii", "backslashreplace").decode() + "\n")
        stream.flush()


_TOKENS: dict[str, Callable[[Record], str]] = {
    "severity": lambda record: record.severity.name,
    "name": lambda record: fit(record.name, lines=False),
    "message": lambda record: fit(record.message, colours=True),
    "function_name": lambda record: record.function,
    "file_name": lambda record: record.file,
    "line_number": lambda record: str(record.line),
    "time": lambda record: "{}.{:09}".format(*divmod(record.stamp_ns, 1_000_000_000)),
    "time_as_nanoseconds": lambda record: str(record.stamp_ns),
    "date_time_with_ms": lambda record: _date(record.stamp_ns),
}
_TOKEN = late(r"\{(" + "|".join(_TOKENS) + r")\}")
_ESCAPES = {"a": "\a", "b": "\b", "n": "\n", "r": "\r", "t": "\t", "x1b": "\x1b"}


def compile_format(text: str) -> Callable[[Record], str]:
    r"""Return the function that formats a record by a format such as `{time} {message}`.

    The tokens are rcutils': severity, name, message, function_name, file_name, line_number, time (seconds),
    time_as_nanoseconds, date_time_with_ms. Other braces stay; \a \b \n \r \t \x1b are understood.
    """
    text = re.sub(r"\\(a|b|n|r|t|x1b)", lambda match: _ESCAPES[match[1]], text)
    parts = _TOKEN.split(text)  # literal, token, literal, token, ..., literal
    tokens = [(_TOKENS[token], after) for token, after in zip(parts[1::2], parts[2::2], strict=True)]

    def write(record: Record) -> str:
        return parts[0] + "".join([f"{value(record)}{after}" for value, after in tokens])

    return write


def _date(stamp_ns: int) -> str:
    seconds, nanoseconds = divmod(stamp_ns, 1_000_000_000)
    return time.strftime("%Y-%m-%d %H:%M:%S", time.localtime(seconds)) + f".{nanoseconds // 1_000_000:03}"


output = LogOutput(Console())
"""Output of this process."""
