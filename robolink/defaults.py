"""What a program gets that names no context and no executor; several programs may share a process."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.timebase import SystemTime, TimeBase

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import Executor


def _in_main_thread() -> bool:
    return threading.current_thread() is threading.main_thread()


class Defaults:
    """A program's default context and shared executor, and what is special about the program."""

    def __init__(self, context_type: type[Context] | None = None, program: Any = None) -> None:
        self.context: Context | None = None
        self.executor: Executor | None = None
        self.context_type = context_type
        """What `Context()` makes in this program's code, if that is another class."""
        self.program = program
        """The program of a host whose defaults these are; None for those of a process."""
        self.time: TimeBase = SystemTime()
        """What a clock shows that was told of no time."""
        self.in_main_thread: Callable[[], bool] = _in_main_thread
        """Whether the calling thread is the program's main one, which Ctrl-C breaks into."""


class _Here(threading.local):
    defaults = Defaults()


_here = _Here()


def get_defaults() -> Defaults:
    """Give what the program has whose code this thread runs."""
    return _here.defaults


def use_defaults(defaults: Defaults) -> None:
    """Have this thread run the code of another program from now on."""
    _here.defaults = defaults
