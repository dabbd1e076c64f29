"""Terminal settings, saved and restored: a program that reads single keys may be killed before it restores them."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import Any


class Terminal:
    """Snapshot of the settings of the terminal at standard input, for `put_back`; empty where there is none."""

    def __init__(self) -> None:
        self._found: list[Any] | None = None
        if sys.platform != "win32" and os.isatty(0):
            import termios

            self._found = termios.tcgetattr(0)

    def put_back(self) -> None:
        """Restore the settings, unless the terminal is another job's now, as after `bg`: then the shell does it."""
        if sys.platform != "win32" and self._found is not None:
            import termios

            with contextlib.suppress(OSError, termios.error):  # it is gone
                if os.tcgetpgrp(0) == os.getpgrp():
                    termios.tcsetattr(0, termios.TCSANOW, self._found)
