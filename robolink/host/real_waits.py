"""Real waits: what event loops of programs wait for that is outside of virtual time: sockets, pipes, other processes.

Before virtual time moves, all of it is polled. While one of these waits holds time, it goes no faster than the
computer's, for whoever is at the other end has real time.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

from robolink.system import clocks

PERIOD = 0.001
"""Period of polling, in real seconds."""

_sleep = time.sleep


class RealWait(Protocol):
    """One of these waits."""

    @property
    def holds_time(self) -> bool:
        """True if virtual time must go no faster than the computer's."""

    def is_ready(self) -> bool:
        """Return True if it is over; whoever waits has a turn then."""


class Moves(Protocol):
    """Scheduler as seen from here."""

    def until_next(self) -> int | None:
        """Return the nanoseconds to the next moment that somebody waits for; None if nobody does."""

    def pass_time(self, nanoseconds: int) -> bool:
        """Move time by so much. Return True if there is something to do."""


class Ending(Protocol):
    """Program as seen from here."""

    @property
    def is_over(self) -> bool:
        """True once it has ended."""


class RealWaits:
    """Set of these waits of one host."""

    def __init__(self) -> None:
        self.waiting: dict[RealWait, None] = {}

    def add_thread(self, thread: threading.Thread, program: Ending) -> None:
        """Add the wait for the end of a program's thread that takes no turns."""
        self.waiting[_RealThread(thread, program, self.waiting)] = None

    @contextmanager
    def including(self, wait: RealWait) -> Iterator[None]:
        """Include a wait within a `with`."""
        self.waiting[wait] = None
        try:
            yield
        finally:
            self.waiting.pop(wait, None)

    def go_on(self, scheduler: Moves) -> bool:
        """Wait in real time until time may move. Return True if there is something to do first."""
        begin = clocks.steady()
        while self.waiting:
            if any(each.is_ready() for each in list(self.waiting)):
                return True
            left = scheduler.until_next()
            if left is not None and (left <= 0 or not any(each.holds_time for each in self.waiting)):
                return False
            _sleep(PERIOD if left is None else min(PERIOD, left / 1e9))
            now = clocks.steady()
            if scheduler.pass_time(now - begin if left is None else min(left, now - begin)):
                return True
            begin = now
        return False


class _RealThread:
    def __init__(self, thread: threading.Thread, program: Ending, waiting: dict[RealWait, None]) -> None:
        self._thread, self._program, self._waiting = thread, program, waiting

    @property
    def holds_time(self) -> bool:
        return not self._program.is_over

    def is_ready(self) -> bool:
        if self._thread.is_alive():
            return False
        self._waiting.pop(self, None)
        return True
