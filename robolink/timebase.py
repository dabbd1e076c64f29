"""What time is for a whole context, and how an executor waits in it: the system's, or virtual time that jumps."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from robolink.inbox import Inbox


class TimeBase(Protocol):
    """Nanoseconds, and waiting."""

    virtual: bool

    def now(self) -> int:
        """The time of day: nanoseconds since the epoch, or since a virtual start."""

    def steady(self) -> int:
        """Nanoseconds that only grow, from some start."""

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Wait until something arrives, and give it undelivered, or until steady time is `until`; or less long."""

    def sleep(self, nanoseconds: int) -> None:
        """Let so much time pass."""


class SystemTime:
    """The computer's clocks."""

    virtual = False
    now = staticmethod(time.time_ns)
    steady = staticmethod(time.monotonic_ns)

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Wait until something arrives, and give it undelivered, or until steady time is `until`; or less long."""
        if until is None:
            return inbox.wait(None)
        return inbox.wait(max(0.0, (until - time.monotonic_ns()) / 1e9))

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

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Jump to `until`, unless something has arrived; with nothing to come, wait for another thread's message."""
        if until is None or not inbox.empty():
            return inbox.wait(None)
        self._now = max(self._now, until)
        return None

    def sleep(self, nanoseconds: int) -> None:
        """Jump."""
        self._now += max(0, nanoseconds)
