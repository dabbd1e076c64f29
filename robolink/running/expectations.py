"""Expectations of a topic's QoS: deadlines that messages meet or miss, and leases of liveliness that run out.

They are driven by whoever notes a message, on any thread, and by the executor that takes what has happened. What they
count is as in ROS 2 over Fast DDS: a deadline begins with the first message, and is missed again with each period; a
lease begins with the first message or assertion, and is lost once.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Protocol

MOST_HEARD = 1000
"""Most publishers that are remembered though they are not matched: a message may be faster than its sender's token."""


class Expectation(Protocol):
    """Expectation as seen by an event handler."""

    wake: Callable[[], object]
    """Function that has `take` called soon; it is called on any thread, without a lock."""

    def take(self, now: int) -> tuple[Any, int | None]:
        """Return the info of changes since the last time, or None, and the time of the next look, if there is one."""


class Deadline:
    """Deadline that each message of a topic sets anew.

    Args:
        period: Longest time from message to message, in nanoseconds.
        info: Class of what is reported: it takes the count of missed deadlines, and its change.
    """

    def __init__(self, period: int, info: Callable[[int, int], Any]) -> None:
        self.wake: Callable[[], object] = lambda: None
        self._period, self._info = period, info
        self._lock = threading.Lock()
        self._due: int | None = None
        self._total = self._change = 0

    def note(self, now: int) -> None:
        """Note a message, on any thread; `now` is steady time in nanoseconds."""
        with self._lock:
            begins = self._due is None
            self._count(now)
            self._due = now + self._period
        if begins:
            self.wake()

    def take(self, now: int) -> tuple[Any, int | None]:
        """Return the info of deadlines missed since the last time, or None, and when the next one is missed."""
        with self._lock:
            self._count(now)
            change, self._change = self._change, 0
            return (self._info(self._total, change) if change else None), _behind(self._due)

    def _count(self, now: int) -> None:
        # A message just at the deadline meets it: in virtual time a period that is as long as the deadline is usual.
        if self._due is None or now <= self._due:
            return
        missed = (now - self._due - 1) // self._period + 1
        self._total += missed
        self._change += missed
        self._due += missed * self._period


class Lease:
    """Lease of a publisher that asserts its liveliness itself, by each message too.

    Args:
        duration: Longest time from assertion to assertion, in nanoseconds.
        info: Class of what is reported: it takes the count of losses, and its change.
    """

    def __init__(self, duration: int, info: Callable[[int, int], Any]) -> None:
        self.wake: Callable[[], object] = lambda: None
        self._duration, self._info = duration, info
        self._lock = threading.Lock()
        self._due: int | None = None
        self._total = self._change = 0

    def note(self, now: int) -> None:
        """Note an assertion, on any thread; `now` is steady time in nanoseconds."""
        with self._lock:
            self._expire(now)
            begins, self._due = self._due is None, now + self._duration
        if begins:
            self.wake()

    def take(self, now: int) -> tuple[Any, int | None]:
        """Return the info of losses since the last time, or None, and when the lease ends."""
        with self._lock:
            self._expire(now)
            change, self._change = self._change, 0
            return (self._info(self._total, change) if change else None), _behind(self._due)

    def _expire(self, now: int) -> None:
        if self._due is not None and now > self._due:
            self._due = None
            self._total += 1
            self._change += 1


class Liveliness:
    """Liveliness of a topic's publishers, as one of its subscriptions sees it.

    One whose liveliness is AUTOMATIC is alive while it is matched; one that asserts it itself from its first message or
    assertion on, until it has been silent for the duration of the lease.

    Args:
        duration: Lease duration of the subscription, in nanoseconds.
        info: Class of what is reported: it takes the counts of those alive and not alive, and both changes.
    """

    def __init__(self, duration: int, info: Callable[[int, int, int, int], Any]) -> None:
        self.wake: Callable[[], object] = lambda: None
        self._duration, self._info = duration, info
        self._lock = threading.Lock()
        self._automatic: dict[bytes, None] = {}
        self._alive: dict[bytes, int] = {}
        """Ends of the leases of those that assert it themselves and are alive, by gid."""
        self._not_alive: dict[bytes, None] = {}
        self._silent: dict[bytes, None] = {}
        """Those that have asserted nothing yet."""
        self._heard: dict[bytes, int] = {}
        """Time of the last sign of those that are not matched, by gid."""
        self._reported = 0, 0
        self._has_changed = False

    def match(self, gid: bytes, now: int, *, automatic: bool) -> None:
        """Note that a publisher came, on any thread."""
        with self._lock:
            heard = self._heard.pop(gid, None)
            if automatic:
                self._automatic[gid] = None
                self._has_changed = True
            else:
                self._silent[gid] = None
                if heard is not None and heard + self._duration >= now:
                    self._assert(gid, heard)
        self.wake()

    def unmatch(self, gid: bytes) -> None:
        """Note that a publisher has gone, on any thread."""
        with self._lock:
            self._silent.pop(gid, None)
            for group in (self._automatic, self._alive, self._not_alive):
                if gid in group:
                    del group[gid]
                    self._has_changed = True
        self.wake()

    def note(self, gid: bytes, now: int) -> None:
        """Note a message or an assertion of a publisher, on any thread; `now` is steady time in nanoseconds."""
        with self._lock:
            if gid in self._automatic:
                return
            self._expire(now)
            was_alive = gid in self._alive
            if was_alive or gid in self._silent or gid in self._not_alive:
                self._assert(gid, now)
            else:
                self._heard[gid] = now
                if len(self._heard) > MOST_HEARD:
                    del self._heard[next(iter(self._heard))]
                return
        if not was_alive:
            self.wake()

    def take(self, now: int) -> tuple[Any, int | None]:
        """Return the info of changes since the last time, or None, and when the next lease ends."""
        with self._lock:
            self._expire(now)
            due = _behind(min(self._alive.values(), default=None))
            if not self._has_changed:
                return None, due
            self._has_changed = False
            alive, not_alive = len(self._automatic) + len(self._alive), len(self._not_alive)
            before, self._reported = self._reported, (alive, not_alive)
            return self._info(alive, not_alive, alive - before[0], not_alive - before[1]), due

    def _assert(self, gid: bytes, now: int) -> None:
        if gid not in self._alive:
            self._silent.pop(gid, None)
            self._not_alive.pop(gid, None)
            self._has_changed = True
        self._alive[gid] = now + self._duration

    def _expire(self, now: int) -> None:
        for gid in [gid for gid, due in self._alive.items() if now > due]:
            del self._alive[gid]
            self._not_alive[gid] = None
            self._has_changed = True


def _behind(due: int | None) -> int | None:
    """Return the first moment at which something due has not come."""
    return None if due is None else due + 1
