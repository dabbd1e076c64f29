"""Progress line of `bag record` and `bag play`: the last line of the terminal, which gives way to lines of the log."""

from __future__ import annotations

import contextlib
import sys
import threading

from robolink.impl.log_output import Record, output
from robolink.system.terminal import fit


class ProgressLine:
    """Last line of the terminal, written anew each time; nothing where standard error is not a terminal.

    While a `with` lasts, lines of the log erase it before they are written.
    """

    def __init__(self) -> None:
        self._shows = sys.stderr is not None and sys.stderr.isatty()
        self._shown = False
        self._lock = threading.Lock()
        self._console = output.console

    def __enter__(self) -> ProgressLine:
        if self._shows and self._console is not None:
            output.console = self._log
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()
        if self._shows:
            output.console = self._console

    def show(self, text: str) -> None:
        """Write the line, as far as it fits."""
        if self._shows:
            with self._lock:
                _write(f"\r\x1b[K{fit(text, lines=False)[: _width() - 1]}")
                self._shown = True

    def clear(self) -> None:
        """Erase the line."""
        with self._lock:
            if self._shown:
                _write("\r\x1b[K")
                self._shown = False

    def _log(self, record: Record) -> None:
        self.clear()
        if self._console is not None:
            self._console(record)


def _width() -> int:
    import shutil

    return shutil.get_terminal_size().columns


def _write(text: str) -> None:
    if sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):  # the terminal is gone
            sys.stderr.write(text)
            sys.stderr.flush()
