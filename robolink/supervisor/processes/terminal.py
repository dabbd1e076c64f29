"""Put a terminal back as it was: a program that takes keys one by one may be killed before it does so itself."""

from __future__ import annotations

import contextlib
import os
import sys
from typing import Any


class Terminal:
    """How the terminal behind our standard input is set now, for `put_back`; nothing where there is none."""

    def __init__(self) -> None:
        self._found: list[Any] | None = None
        if sys.platform != "win32" and os.isatty(0):
            import termios

            self._found = termios.tcgetattr(0)

    def put_back(self) -> None:
        """Set it so again, unless it is another job's now, as after `bg`: the shell then sees to it."""
        if sys.platform != "win32" and self._found is not None:
            import termios

            with contextlib.suppress(OSError, termios.error):  # it is gone
                if os.tcgetpgrp(0) == os.getpgrp():
                    termios.tcsetattr(0, termios.TCSANOW, self._found)
