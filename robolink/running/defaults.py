"""Defaults of a program: its platform, its default context and executor, and the time of its clocks.

A platform gives arguments, network sessions, mailboxes and threads, as an operating system gives them to a process.
Both are thread-local, since a host (`robolink.host`) runs several programs in one process.
"""

from __future__ import annotations

import _thread
import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from robolink.running.inbox import Inbox, Sweeper
from robolink.running.ready_queue import Timekeeper
from robolink.running.timebase import SystemTime, TimeBase
from robolink.system import clocks

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from robolink.arguments.command_line import Arguments


class Driver(Timekeeper, Protocol):
    """Runs the callbacks of an executor in place of the thread that spins it, which waits meanwhile."""

    @property
    def is_lent(self) -> bool:
        """True while it may run callbacks."""

    def runs_here(self) -> bool:
        """True if the calling thread is in a callback that it runs."""

    def spin(self, deadline: int | None, stop: Callable[[], bool] | None) -> bool:
        """Wait while callbacks run, until `stop()` or the deadline; False at once if the caller is to run them."""


class Platform:
    """Services that contexts and executors take from the process that they live in."""

    def join(self, context: Any) -> None:
        """Note that a context was made here."""

    def adopt(self, node: Any, arguments: Arguments) -> None:
        """Note that a node was made in a context with these arguments."""

    def time_base(self, given: TimeBase | None) -> TimeBase:
        """Return the time of a context that is asked for this one; None for the platform's own."""
        return given or SystemTime()

    def argv(self) -> list[str]:
        """Return the command line of a context that is given none."""
        return sys.argv

    def transport(self, given: Any) -> Any:
        """Return the transport of a context that is asked for this one, by name or as an object; None for any."""
        return given

    def begin_logging(self, arguments: Arguments, time_base: TimeBase) -> None:
        """Log as a context's arguments say, stamped by its time."""
        from robolink import logging
        from robolink.impl.log_output import Console

        logging.initialize()
        log_clock = time_base.log_clock()
        if log_clock is not None:
            logging.set_time_source(log_clock)
        for name, level in arguments.log_levels:
            logging.set_logger_level(name, level)
        if arguments.stdout_logs is not None:
            logging.set_console_handler(Console() if arguments.stdout_logs else None)

    def end_logging(self, time_base: TimeBase) -> None:
        """Stamp lines by the system's time again, once the context is over that had this one."""
        if time_base.log_clock() is not None:
            from robolink import logging

            logging.set_time_source(clocks.now)

    def make_inbox(self, *, parked: bool) -> Inbox:
        """Make the mailbox at which an executor waits; `parked` for what waits while no executor has it."""
        return Inbox()

    def make_loop_inbox(self, rouse: Callable[[], object], *, threaded: bool) -> Inbox:
        """Make the mailbox of a node on an event loop, which `rouse` lets look into it."""
        from robolink.running.loop_inbox import LoopInbox  # late: few programs have such nodes

        return LoopInbox(rouse, threaded=threaded)

    def make_sweeper(self) -> Sweeper:
        """Make what empties mailboxes that nobody looks into."""
        return Sweeper()

    def make_pool(self, size: int) -> Executor:
        """Make the threads in which callbacks of a multi-threaded executor run."""
        from concurrent.futures import ThreadPoolExecutor  # late: it takes some milliseconds

        return ThreadPoolExecutor(size, thread_name_prefix="robolink callbacks")

    def make_driver(self, executor: Any) -> Driver | None:
        """Make what runs the callbacks of a single-threaded executor; None if the thread does that spins it."""
        return None

    def run_aside(self, function: Callable[[], object]) -> None:
        """Call a function from a signal's handler, which may hold any lock: on a thread of its own."""
        _thread.start_new_thread(function, ())  # threading's own start has locks, too


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


_of_process = Defaults()


class _Here(threading.local):
    def __init__(self) -> None:
        self.place = [_of_process]


_here = _Here()


def place_of_defaults() -> list[Defaults]:
    """Return the list whose only item is the defaults of the calling thread, for who sets them often."""
    return _here.place


def get_defaults() -> Defaults:
    """Return the defaults of the program whose code the calling thread runs."""
    return _here.place[0]


def use_defaults(defaults: Defaults) -> None:
    """Make the calling thread run the code of another program from now on."""
    _here.place[0] = defaults
