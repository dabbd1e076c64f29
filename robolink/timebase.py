"""What time is for a whole context, and how an executor waits in it: the system's, or virtual time that jumps."""

from __future__ import annotations

import sys
import threading
import time
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from robolink.inbox import Inbox

FOREVER = 0.1 if sys.platform == "win32" else threading.TIMEOUT_MAX
"""Seconds of one wait at the most: on Windows Ctrl-C does not break into a wait, only between two of them."""


class TimeBase(Protocol):
    """Nanoseconds, and waiting."""

    virtual: bool

    def now(self) -> int:
        """The time of day: nanoseconds since the epoch, or since a virtual start."""

    def steady(self) -> int:
        """Nanoseconds that only grow, from some start."""

    def wait(self, inbox: Inbox, until: int | None) -> None:
        """Wait until something arrives or steady time is `until`."""

    def sleep(self, nanoseconds: int) -> None:
        """Let so much time pass."""


class SystemTime:
    """The computer's clocks."""

    virtual = False
    now = staticmethod(time.time_ns)
    steady = staticmethod(time.monotonic_ns)

    def wait(self, inbox: Inbox, until: int | None) -> None:
        """Wait until something arrives or steady time is `until`."""
        if until is None:
            inbox.wait(FOREVER)
            return
        left = until - time.monotonic_ns()
        inbox.wait(min(left / 1e9, FOREVER) if left > 0 else 0.0)

    def sleep(self, nanoseconds: int) -> None:
        """Let so much time pass."""
        time.sleep(max(0, nanoseconds) / 1e9)


class VirtualTime:
    """Time that stands still while there is work and jumps to the next deadline when there is none."""

    virtual = True

    def __init__(self, start: int = 0) -> None:
        self._now = start

    def now(self) -> int:
        """Nanoseconds since the virtual start."""
        return self._now

    steady = now

    def wait(self, inbox: Inbox, until: int | None) -> None:
        """Jump to `until`, unless something has arrived; with nothing to come, wait for another thread's message."""
        if until is None:
            inbox.wait(None)
        elif inbox.empty():
            self._now = max(self._now, until)
        else:
            inbox.sweep()

    def sleep(self, nanoseconds: int) -> None:
        """Jump."""
        self._now += max(0, nanoseconds)
