"""Keyboard of a terminal: keys at once, and the terminal given back."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from robolink.control.keyboard import NoTerminalError, PosixKeyboard, open_keyboard


def test_without_a_terminal_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    with Path(os.devnull).open() as nothing:
        monkeypatch.setattr(sys, "stdin", nothing)
        with pytest.raises(NoTerminalError, match="somebody reads keys from a terminal"):
            open_keyboard("somebody")
    monkeypatch.setattr(sys, "stdin", None)
    with pytest.raises(OSError, match="somebody reads keys from a terminal"):
        open_keyboard("somebody")


if sys.platform != "win32":
    import pty
    import select
    import termios

    def test_a_terminal_gives_keys_at_once_and_is_given_back() -> None:
        controller, terminal = pty.openpty()
        try:
            found = termios.tcgetattr(terminal)
            keyboard = PosixKeyboard(terminal)
            assert not termios.tcgetattr(terminal)[3] & (termios.ECHO | termios.ICANON)
            assert keyboard.read() == ""
            os.write(controller, b"w\x1b[A")
            assert select.select([terminal], [], [], 30.0)[0]  # the kernel takes its time to hand them on
            assert keyboard.read() == "w\x1b[A"
            keyboard.close()
            assert termios.tcgetattr(terminal) == found
        finally:
            os.close(controller)
            os.close(terminal)
        keyboard.close()  # the terminal is gone: nothing to give back
