"""The process of a command: the names by which it is another program, and repeats of a Ctrl-C that Python has lost.

Python raises KeyboardInterrupt wherever its main thread just is. In code that has no caller to catch it (the callback
of a weak reference, of which every import has some; a `__del__`), Python prints "Exception ignored" and goes on.
"""

from __future__ import annotations

import _thread
import contextlib
import sys
import time
from collections.abc import Iterator
from typing import Any

A_MOMENT = 0.002
"""Delay of the repeat, in seconds: the code that lost it has ended by then; if not, it is repeated once more."""


@contextlib.contextmanager
def not_lost() -> Iterator[None]:
    """Raise each KeyboardInterrupt again that Python ignores in this block. For the main thread."""
    show, main = sys.unraisablehook, _thread.get_ident()

    def on_ignored(ignored: Any) -> None:
        if issubclass(ignored.exc_type, KeyboardInterrupt):
            _thread.start_new_thread(_interrupt, (main,))
        else:
            show(ignored)

    sys.unraisablehook = on_ignored
    try:
        yield
    finally:
        if sys.unraisablehook is on_ignored:  # else the user's program has one of its own
            sys.unraisablehook = show


def _interrupt(main: int) -> None:
    import signal  # late, as few commands need it

    time.sleep(A_MOMENT)
    if sys.platform == "win32":
        _thread.interrupt_main()
    else:
        signal.pthread_kill(main, signal.SIGINT)  # breaks into a wait, too


OTHER_NAMES = {"colcon": "robolink.cli.shim.colcon", "launch_test": "robolink.cli.shim.launch_test"}
"""Modules whose `main` runs in place of the command's own."""
