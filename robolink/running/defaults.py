"""Defaults of a program: its platform, its default context and executor, and the time of its clocks.

They are thread-local, since a host (`robolink.host`) runs several programs in one process.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from robolink.running.platform import Platform
from robolink.running.timebase import SystemTime, TimeBase


def _in_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()


class Defaults:
    """The default objects of one program."""

    def __init__(self, program: Any = None, platform: Platform | None = None) -> None:
        self.context: Any = None
        """The default Context, once there is one; it stands on a floor above, as does the next."""
        self.executor: Any = None
        """The Executor of `spin` and its sisters."""
        self.program = program
        """The program of a host whose defaults these are; None for those of a process."""
        self.platform = platform or Platform()
        """Platform of the contexts that the program makes, and of their executors."""
        self.time: TimeBase = SystemTime()
        """The time of a clock that is given no time base."""
        self.in_main_thread: Callable[[], bool] = _in_main_thread
        """Returns True in the program's main thread, which Ctrl-C interrupts."""


class _Here(threading.local):
    defaults = Defaults()


here = _Here()
"""The defaults of the calling thread."""


def get_defaults() -> Defaults:
    """Return the defaults of the program whose code the calling thread runs."""
    return here.defaults


def use_defaults(defaults: Defaults) -> None:
    """Make the calling thread run the code of another program from now on."""
    here.defaults = defaults
