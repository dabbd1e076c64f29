"""Layouts of what a system prints: columns for people at a terminal, names in brackets for pipes and ROS's formats."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable, Iterable
from typing import TextIO

from robolink.supervisor.policy import Severity
from robolink.system import clocks
from robolink.system.terminal import fit, wants_colour

OWN_NAME = "launch"
"""Name before the launcher's own lines."""

_COLOURS = (b"36", b"32", b"35", b"94", b"96", b"92", b"95", b"34")
"""ANSI colours of names, by turns: none is a severity's."""
_SEVERITIES = {b"DEBUG": b"2", b"INFO": b"", b"WARN": b"33", b"ERROR": b"31", b"FATAL": b"1;31"}
"""ANSI styles of the severities; nodes do not send them to a launcher, so that log files have none."""
_LOGGED = re.compile(
    rb"(?P<colour>\x1b\[[0-9;]*m)?\[(?P<severity>DEBUG|INFO|WARN|ERROR|FATAL)\] \[\d+\.\d+\] \[(?P<logger>[^\]\s]*)\]: "
)
"""Beginning of a line of a node's log, in ROS's default format; coloured where RCUTILS_COLORIZED_OUTPUT is 1."""
_SEVERE = re.compile(rb"\[(DEBUG|WARN|ERROR|FATAL)\] ")
"""Beginning of a line of a node's log in a format that keeps ROS's first word."""
_END = b"\x1b[0m"
_PLAIN = re.compile(rb"[\t -~]*")
_WIDEST = 24
"""Largest width of the column of names, in characters; a longer name is whole, and pushes its text aside."""
_SHARE = 4
"""The column of names takes at most one of so many parts of the terminal's width."""


def layout(output: TextIO, names: Iterable[str], clock: Callable[[], float] = clocks.monotonic) -> Columns | Brackets:
    """Return the layout for an output: columns on a terminal, unless RCUTILS_CONSOLE_OUTPUT_FORMAT says what to see.

    Args:
        output: Where the lines are written.
        names: Names of the processes.
        clock: Source of monotonic time, in seconds; it begins now.
    """
    coloured = {"0": False, "1": True}.get(os.environ.get("RCUTILS_COLORIZED_OUTPUT", ""))
    has_colour = wants_colour(output)
    if output.isatty() and not os.environ.get("RCUTILS_CONSOLE_OUTPUT_FORMAT"):
        width = min(_WIDEST, shutil.get_terminal_size().columns // _SHARE)
        return Columns(names, has_colour=has_colour if coloured is None else coloured, widest=width, clock=clock)
    return Brackets(names, has_colour=has_colour, colours_logs=has_colour and coloured is not False)


class Columns:
    """Layout for people: time since the start, severity, name and text, each once.

    Lines that are not of a log have no severity. Of a progress line, which goes back to its begin again and again, the
    last state is shown, as a terminal would.

    >>> columns = Columns(["world"], has_colour=False, widest=24, clock=lambda: 0.0)
    >>> columns.line("world", b"[INFO] [1795863973.05] [world]: robot at (1, 2)")
    b'  0.0 s  INFO  world   robot at (1, 2)\\n'
    """

    def __init__(self, names: Iterable[str], *, has_colour: bool, widest: int, clock: Callable[[], float]) -> None:
        self._has_colour = has_colour
        self._widest = widest
        self._clock = clock
        self._begin = clock()
        self._names: dict[str, bytes] = {}
        self._loggers: dict[str, bytes] = {}
        self._width = 0
        self._cells: dict[str, bytes] = {}
        for name in (OWN_NAME, *names):
            self.add(name)

    def add(self, name: str) -> None:
        """Make the cell of one more name, in the next colour; the launcher's own is bold."""
        style = _COLOURS[(len(self._names) - 1) % len(_COLOURS)] if self._names else b"1"
        text = fit(name, lines=False)
        self._names[name] = self._styled(text.encode(), style)
        self._loggers[name] = text.strip("/").replace("/", ".").encode()
        is_wider = self._width < len(text) <= self._widest
        self._width = len(text) if is_wider else self._width
        self._cells |= {each: self._cell(each) for each in (self._names if is_wider else [name])}

    def line(self, name: str, line: bytes) -> bytes:
        """Return a line of a process."""
        text = _fit(line.rstrip(b"\r\n").rpartition(b"\r")[2])
        logged = _LOGGED.match(text)
        if logged is None:
            return self._row(name, b"", text)
        text = text[logged.end() :]
        if logged["colour"]:
            text = text.removesuffix(_END)
        return self._row(name, logged["severity"], self._sender(name, logged["logger"]) + text)

    def say(self, text: str, severity: Severity) -> bytes:
        """Return lines of the launcher's own, over the `^C` with which a terminal shows that Ctrl-C was pressed."""
        rows = [self._row(OWN_NAME, severity.encode(), each.encode()) for each in fit(text).split("\n")]
        return b"\r" + b"".join(rows)

    def _cell(self, name: str) -> bytes:
        return self._names[name] + b" " * (self._width - len(fit(name, lines=False)))

    def _sender(self, name: str, logger: bytes) -> bytes:
        """Return a logger's name without that of its process, and a colon; b"" if it is the process's own."""
        own = self._loggers[name]
        if logger == own:
            return b""
        return logger.removeprefix(own + b".") + b": "

    def _row(self, name: str, severity: bytes, text: bytes) -> bytes:
        style = _SEVERITIES.get(severity, b"")
        if b"\x1b" not in text:
            text = self._styled(text, style)
        elif not text.endswith(_END):  # a colour that is left on would be that of all others' lines
            text += _END
        time = self._styled(b"%5.1f s" % (self._clock() - self._begin), b"2")
        return b"%b  %b %b  %b\n" % (time, self._styled(severity.ljust(5), style), self._cells[name], text)

    def _styled(self, text: bytes, style: bytes) -> bytes:
        return b"\x1b[%bm%b\x1b[0m" % (style, text) if self._has_colour and style else text


class Brackets:
    """Layout for programs, and for who chose ROS's format: `[name]`, then the line as it came."""

    def __init__(self, names: Iterable[str], *, has_colour: bool, colours_logs: bool) -> None:
        self._has_colour = has_colour
        self._colours_logs = colours_logs
        self._prefixes: dict[str, bytes] = {}
        for name in (OWN_NAME, *names):
            self.add(name)

    def add(self, name: str) -> None:
        """Make the prefix of one more name, in the next colour."""
        text = f"[{name}]".encode()
        if self._has_colour:
            style = _COLOURS[(len(self._prefixes) - 1) % len(_COLOURS)] if self._prefixes else b"1"
            text = b"\x1b[%bm%b\x1b[0m" % (style, text)
        self._prefixes[name] = text + b" "

    def line(self, name: str, line: bytes) -> bytes:
        """Return a line of a process."""
        text = _fit(line.rstrip(b"\r\n"))
        return self._prefixes[name] + (_coloured(text) if self._colours_logs else text) + b"\n"

    def say(self, text: str, severity: Severity) -> bytes:
        """Return a line of the launcher's own; programs know these by their texts, without a severity."""
        return self._prefixes[OWN_NAME] + fit(text).encode() + b"\n"


def _fit(line: bytes) -> bytes:
    return line if _PLAIN.fullmatch(line) else fit(line.decode(errors="replace"), colours=True).encode()


def _coloured(line: bytes) -> bytes:
    """Return a line in the colour of its severity, if it is of a log and has no colours of its own."""
    severe = _SEVERE.match(line)
    return line if severe is None or b"\x1b" in line else b"\x1b[%bm%b\x1b[0m" % (_SEVERITIES[severe[1]], line)
