"""Terminal output: prints the lines of many processes, whole and in order, in the layout that the output wants."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterable
from typing import TextIO

from robolink.supervisor.policy import Severity
from robolink.supervisor.reporting.background_queue import BackgroundQueue, Troubles
from robolink.supervisor.reporting.layouts import OWN_NAME, layout
from robolink.system.terminal import fit


class Printer:
    """Background writer to a terminal, so that a stopped terminal never blocks the supervisor."""

    def __init__(self, output: TextIO, names: Iterable[str], troubles: Troubles | None = None) -> None:
        self._layout = layout(output, names)
        writer = Writer(output)
        self._queue: BackgroundQueue[bytes] = BackgroundQueue(
            lambda lines: writer.write(b"".join(lines)), troubles or Troubles(), name="printer"
        )

    def add(self, name: str) -> None:
        """Note the name of one more process."""
        self._layout.add(name)

    def line(self, name: str, line: bytes) -> None:
        """Print one line of a process, of all control codes only colours; blocks while too much waits."""
        whole = self._layout.line(name, line)
        self._queue.put(whole, len(whole))

    def say(self, text: str, severity: Severity = "INFO") -> None:
        """Print a line of the launcher's own; never blocks: rather the line is lost."""
        whole = self._layout.say(text, severity)
        self._queue.put_own(whole, len(whole))

    def close(self, timeout: float = 1.0) -> None:
        """Print the lines that wait, for at most `timeout` seconds."""
        self._queue.close(timeout)


def complain(text: str) -> None:
    """Print a line of the launcher's own on stderr, if that can be written."""
    with contextlib.suppress(OSError, ValueError, AttributeError):  # closed; or there is none
        sys.stderr.write(f"[{OWN_NAME}] {fit(text)}\n")
        sys.stderr.flush()


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
