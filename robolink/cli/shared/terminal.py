"""The terminal of commands that go on: single keys without Enter, and a progress bar."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable, Iterator
from typing import Any

from robolink.system import clocks
from robolink.text.keys import split_keys

Read = Callable[[float], str]
"""Function that waits up to so many seconds for a key, and returns its name; '' if none came."""

_WINDOWS_LOOK = 0.02
"""Interval between two looks at Windows' console, in seconds: it cannot be waited for together with a timeout."""


@contextlib.contextmanager
def keys() -> Iterator[Read]:
    """Switch the terminal to single keys (cbreak) for the block, and restore it afterwards.

    Where standard input is not a terminal, or another job's, the function that is yielded only waits.
    """
    waiting: list[str] = []

    def read(timeout: float) -> str:
        if not waiting:
            waiting.extend(split_keys(typed(timeout)))
        return waiting.pop(0) if waiting else ""

    with _opened() as typed:
        yield read


@contextlib.contextmanager
def _opened() -> Iterator[Callable[[float], str]]:
    """Open the terminal for single keys; yield the function that waits for what is typed."""
    if not sys.stdin or not sys.stdin.isatty():
        yield _nothing
    elif sys.platform == "win32":
        yield _typed_on_windows
    else:
        import termios
        import tty

        terminal = sys.stdin.fileno()
        if _is_in_background(terminal):
            yield _nothing
            return
        before = termios.tcgetattr(terminal)
        tty.setcbreak(terminal)
        try:
            yield lambda timeout: _typed(terminal, timeout)
        finally:
            with contextlib.suppress(termios.error, OSError):  # the terminal is gone
                termios.tcsetattr(terminal, termios.TCSADRAIN, before)


def _nothing(timeout: float) -> str:
    time.sleep(max(0.0, timeout))
    return ""


def _typed(terminal: int, timeout: float) -> str:
    import select

    if not select.select([terminal], [], [], max(0.0, timeout))[0]:
        return ""
    try:
        data = os.read(terminal, 1024)
    except OSError:  # it is gone
        data = b""
    if not data:
        return _nothing(timeout)
    return data.decode(errors="replace")


def _typed_on_windows(timeout: float) -> str:
    text = ""
    if sys.platform == "win32":
        import msvcrt

        deadline = clocks.monotonic() + timeout
        while not msvcrt.kbhit() and clocks.monotonic() < deadline:
            time.sleep(_WINDOWS_LOOK)
        # An arrow is two: the second waits in a buffer into which `kbhit` looks for `getch`, not for `getwch`.
        while msvcrt.kbhit():
            text += msvcrt.getch().decode("latin-1")
    return text


def _is_in_background(terminal: int) -> bool:
    """True if the shell has put this process into the background, where it may not touch the terminal."""
    if sys.platform != "win32":
        with contextlib.suppress(OSError):  # it is not the terminal that controls this process
            return os.tcgetpgrp(terminal) != os.getpgrp()
    return False


LONG = 2.0
"""Delay until a person is shown the progress, in seconds of real time."""


class Progress:
    """Progress bar on standard error, which appears once a person has waited for a while."""

    def __init__(self, total: float, unit: str) -> None:
        self.shown = 0.0
        self._total, self._unit = total, unit
        self._bar: Any = None
        self._begin = 0.0

    def show(self, done: float) -> None:
        """Set the progress to `done`, in the unit of `total`."""
        self.shown = done
        if self._bar is not None:
            self._bar.update(self._task, completed=done)
        elif sys.stderr is not None and sys.stderr.isatty() and clocks.monotonic() - self._begin > LONG:
            self._open()
            self.show(done)

    def _open(self) -> None:
        from rich import progress
        from rich.console import Console

        columns = (
            progress.BarColumn(),
            progress.TextColumn(f"{{task.completed:.0f}} of {{task.total:.0f}} {self._unit}"),
        )
        self._bar = progress.Progress(
            *columns, progress.TimeRemainingColumn(), console=Console(stderr=True), transient=True
        )
        self._task = self._bar.add_task("", total=self._total)
        self._bar.start()

    def __enter__(self) -> Progress:
        self._begin = clocks.monotonic()
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()
