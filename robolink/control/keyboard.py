"""Keyboard of a terminal without Enter and echo, for programs that are driven by keys, on POSIX and Windows."""

from __future__ import annotations

import atexit
import contextlib
import os
import sys
from typing import Protocol

from robolink.exceptions import RobolinkError


class NoTerminalError(RobolinkError, OSError):
    """There is no terminal to read keys from."""


class Keyboard(Protocol):
    """A source of keys."""

    def read(self) -> str:
        """Return the text typed since the last call; never waits."""

    def close(self) -> None:
        """Restore the terminal."""


def open_keyboard(program: str) -> Keyboard:
    """Open the terminal's keyboard, each key at once and without echo, until `close` or the end of the process.

    Args:
        program: Name of the program, for the error.

    Raises:
        NoTerminalError: if standard input is not a terminal, or the program runs there in the background.
    """
    if not sys.stdin or not sys.stdin.isatty():
        raise NoTerminalError(f"{program} reads keys from a terminal, and its standard input is none")
    if sys.platform != "win32" and _in_background(sys.stdin.fileno()):
        raise NoTerminalError(f"{program} reads keys from its terminal, and it runs there in the background")
    keyboard: Keyboard = WindowsKeyboard() if sys.platform == "win32" else PosixKeyboard(sys.stdin.fileno())
    atexit.register(keyboard.close)
    return keyboard


class NoKeyboard:
    """A keyboard without keys, for processes without a terminal."""

    def read(self) -> str:
        """Return ''."""
        return ""

    def close(self) -> None:
        """Nothing was opened."""


class PosixKeyboard:
    """A terminal as Linux and macOS have it.

    Args:
        terminal: Its file descriptor.
    """

    def __init__(self, terminal: int) -> None:
        self._terminal = terminal
        if sys.platform != "win32":
            import termios
            import tty

            self._found = termios.tcgetattr(terminal)
            tty.setcbreak(terminal)

    def read(self) -> str:
        """Return the text typed since the last call."""
        import select

        if not select.select([self._terminal], [], [], 0.0)[0]:
            return ""
        return os.read(self._terminal, 1024).decode(errors="replace")

    def close(self) -> None:
        """Restore the terminal."""
        if sys.platform != "win32":
            import termios

            with contextlib.suppress(termios.error):  # the terminal is gone
                termios.tcsetattr(self._terminal, termios.TCSADRAIN, self._found)


def _in_background(terminal: int) -> bool:
    """True if the shell has put this process into the background, where it may not touch the terminal."""
    if sys.platform != "win32":
        with contextlib.suppress(OSError):  # it is not the terminal that controls this process
            return os.tcgetpgrp(terminal) != os.getpgrp()
    return False


class WindowsKeyboard:
    """The console of Windows."""

    def read(self) -> str:
        """Return the text typed since the last call."""
        text = ""
        if sys.platform == "win32":
            import msvcrt

            # An arrow is two: the second waits in a buffer into which `kbhit` looks for `getch`, not for `getwch`.
            while msvcrt.kbhit():
                text += msvcrt.getch().decode("latin-1")
        return text

    def close(self) -> None:
        """Nothing was changed."""
