"""Terminal output: prints the lines of many processes whole, with coloured name prefixes."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import time
from collections.abc import Iterable
from typing import TextIO

from robolink.supervisor.reporting.background_queue import BackgroundQueue, Troubles
from robolink.system.terminal import fit, wants_colour

_COLOURS = ("36", "33", "32", "35", "34", "96", "93", "92", "95", "94")
OWN_NAME = "launch"
_LOGGED = re.compile(rb"\[(DEBUG|WARN|ERROR|FATAL)\] ")
"""Beginning of a line of a node's log, in ROS's usual format."""
_WHOLE = re.compile(rb"(\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\]) \[\d+\.\d+\] (\[([^\]\s]*)\]): ")
"""Beginning of such a line with its parts: severity, and logger in brackets and without."""
_FORMAT = "RCUTILS_CONSOLE_OUTPUT_FORMAT"
_SEVERITIES = {b"DEBUG": b"32", b"WARN": b"33", b"ERROR": b"31", b"FATAL": b"31"}
"""ANSI colours of the severities; nodes do not send them to a launcher, so that log files have none."""
_PLAIN = re.compile(rb"[\t -~]*")


class Printer:
    """Background writer to a terminal, so that a stopped terminal never blocks the supervisor."""

    def __init__(self, output: TextIO, names: Iterable[str], troubles: Troubles | None = None) -> None:
        has_colour = wants_colour(output)
        self._has_colour = has_colour
        self._prefixes = prefixes([*names, OWN_NAME], has_colour)
        self._shortens = output.isatty() and not os.environ.get(_FORMAT)
        self._colours_logs = has_colour and os.environ.get("RCUTILS_COLORIZED_OUTPUT") != "0"
        writer = Writer(output)
        self._queue: BackgroundQueue[bytes] = BackgroundQueue(
            lambda lines: writer.write(b"".join(lines)), troubles or Troubles(), name="printer"
        )

    def add(self, name: str) -> None:
        """Make the prefix of one more process, `name`, in the next colour."""
        self._prefixes = {**self._prefixes, name: prefixes([*self._prefixes, name], self._has_colour)[name]}

    def line(self, name: str, line: bytes) -> None:
        """Print one line of a process, of all control codes only colours; blocks while too much waits."""
        text = _fit(line.rstrip(b"\r\n"))
        text = _shortened(name, text) if self._shortens else text
        whole = self._prefixes[name] + (_coloured(text) if self._colours_logs else text) + b"\n"
        self._queue.put(whole, len(whole))

    def say(self, text: str) -> None:
        """Print a line of the launcher's own; never blocks: rather the line is lost."""
        whole = self._prefixes[OWN_NAME] + fit(text).encode() + b"\n"
        self._queue.put_own(whole, len(whole))

    def close(self, timeout: float = 1.0) -> None:
        """Print the lines that wait, for at most `timeout` seconds."""
        self._queue.close(timeout)


def _fit(line: bytes) -> bytes:
    return line if _PLAIN.fullmatch(line) else fit(line.decode(errors="replace"), colours=True).encode()


def _shortened(name: str, line: bytes) -> bytes:
    """Return a line of a node's log for people: without its time, and without its logger if the process is called so.

    Whoever has set a format has said what to see, and log files keep all.
    """
    logged = _WHOLE.match(line)
    if logged is None:
        return line
    severity, logger, bare = logged.groups()
    who = b" " if bare.decode(errors="replace") == name.strip("/").replace("/", ".") else b" %s: " % logger
    return severity + who + line[logged.end() :]


def _coloured(line: bytes) -> bytes:
    """Return a line in the colour of its severity, if it is of a log and has no colours of its own."""
    logged = _LOGGED.match(line)
    if logged is None or b"\x1b" in line:
        return line
    return b"\x1b[%sm%s\x1b[0m" % (_SEVERITIES[logged[1]], line)


def complain(text: str) -> None:
    """Print a line of the launcher's own on stderr, if that can be written."""
    with contextlib.suppress(OSError, ValueError, AttributeError):  # closed; or there is none
        sys.stderr.write(f"[{OWN_NAME}] {fit(text)}\n")
        sys.stderr.flush()


def prefixes(names: Iterable[str], has_colour: bool) -> dict[str, bytes]:
    """Return the prefix of each name: `[name] `, in a colour of its own as far as they go."""
    plain = {name: f"[{name}]" for name in names}
    if not has_colour:
        return {name: f"{prefix} ".encode() for name, prefix in plain.items()}
    coloured = {}
    for index, (name, prefix) in enumerate(plain.items()):
        coloured[name] = f"\x1b[{_COLOURS[index % len(_COLOURS)]}m{prefix}\x1b[0m ".encode()
    return coloured


_AGAIN = 0.01
"""Retry interval of a full non-blocking output, in seconds."""


class Writer:
    """Writes bytes unchanged where that is possible, else as text; buffers nothing.

    After a line that was written in part only, the next one begins on a line of its own.
    """

    def __init__(self, output: TextIO) -> None:
        self._output = output
        binary = getattr(output, "buffer", None)
        self._raw = getattr(binary, "raw", binary)  # with PYTHONUNBUFFERED there is no buffer in between
        self._is_cut = False

    def write(self, lines: bytes) -> None:
        """Write lines. Raises OSError, and ValueError when the output is closed."""
        self._output.flush()
        if self._raw is None:
            self._output.write(lines.decode(errors="replace"))
            self._output.flush()
            return
        rest = memoryview(b"\n" + lines if self._is_cut else lines)
        while rest:
            count = self._raw.write(rest)
            if count:
                self._is_cut = rest[count - 1] != ord("\n")
                rest = rest[count:]
            else:
                time.sleep(_AGAIN)
