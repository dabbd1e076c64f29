"""What time is for a whole context, and how an executor waits in it: the system's, or virtual time that jumps."""

from __future__ import annotations

import heapq
import itertools
import queue
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from robolink import systemclock
from robolink.queues import A_WHILE, get_within

if TYPE_CHECKING:
    from robolink.inbox import Inbox


POLL = 0.001
"""Seconds after which somebody is asked again who cannot tell by himself."""


class TimeBase(Protocol):
    """Nanoseconds, and waiting."""

    virtual: bool

    hosted: bool
    """Whether all other programs of a host go on while one waits in it: see `robolink.oneprocess`."""

    def now(self) -> int:
        """The time of day: nanoseconds since the epoch, or since a virtual start."""

    def steady(self) -> int:
        """Nanoseconds that only grow, from some start."""

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Wait until something arrives, and give it undelivered, or until steady time is `until`; or less long."""

    def sleep(self, nanoseconds: int) -> None:
        """Let so much time pass."""

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; wait for one until steady time is `until`. Raises queue.Empty."""

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Wait until `holds()`, or until steady time is `until`; in virtual time, where nobody else can tell of it."""

    def pass_on(self) -> None:
        """Let others go on who are ready now: whoever asks whether there is something, without waiting, comes here."""

    def on_base(self, steady: int) -> int:
        """Say when that is in the steady time of the time base that this one is made of, or of this one."""


class SystemTime:
    """The computer's clocks."""

    virtual = hosted = False
    now = staticmethod(systemclock.now)
    steady = staticmethod(systemclock.steady)

    def __init__(self) -> None:
        systemclock.make_waits_exact()

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Wait until something arrives, and give it undelivered, or until steady time is `until`; or less long."""
        if until is None:
            return inbox.wait(None)
        return inbox.wait(max(0.0, (until - self.steady()) / 1e9))

    def sleep(self, nanoseconds: int) -> None:
        """Let so much time pass."""
        time.sleep(max(0, nanoseconds) / 1e9)

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; wait for one until steady time is `until`. Raises queue.Empty."""
        while True:
            left = A_WHILE if until is None else min(A_WHILE, (until - self.steady()) / 1e9)
            try:
                return get_within(source, left)
            except queue.Empty:
                if until is not None and self.steady() >= until:
                    raise

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Ask again and again."""
        while not holds() and (until is None or self.steady() < until):
            time.sleep(POLL)

    def pass_on(self) -> None:
        """Do nothing: the system sees to it."""

    def on_base(self, steady: int) -> int:
        """It is made of no other."""
        return steady


class VirtualTime:
    """Time that stands still while there is work and jumps to the next deadline when there is none."""

    virtual = True
    hosted = False

    def __init__(self, start: int = 0) -> None:
        self._now = start
        self._acts: list[tuple[int, int, Callable[[], object]]] = []
        self._serial = itertools.count()

    def now(self) -> int:
        """Nanoseconds since the virtual start."""
        return self._now

    steady = now

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        """Call `act()` when it is `time_ns`, before the callbacks that are due then; at once is the earliest."""
        heapq.heappush(self._acts, (time_ns, next(self._serial), act))

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Jump to `until`, unless something has arrived; with nothing to come, wait for another thread's message."""
        if self._acts:
            until = self._acts[0][0] if until is None else min(until, self._acts[0][0])
        if until is None or not inbox.empty():
            return inbox.wait(None)
        self._jump(until)
        return None

    def sleep(self, nanoseconds: int) -> None:
        """Jump."""
        until = self._now + max(0, nanoseconds)
        while self._acts and self._acts[0][0] <= until:
            self._jump(self._acts[0][0])
        self._jump(until)

    def _jump(self, until: int) -> None:
        self._now = max(self._now, until)
        while self._acts and self._acts[0][0] <= self._now:
            heapq.heappop(self._acts)[2]()

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; wait for another thread to bring one, in real time. Raises queue.Empty."""
        return source.get() if until is None else get_within(source, (until - self._now) / 1e9)

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Jump to `until`, unless it holds already; without an end, ask again and again for what other threads do."""
        if until is None:
            while not holds():
                time.sleep(POLL)
        elif not holds():
            self.sleep(until - self._now)

    def pass_on(self) -> None:
        """Do nothing: there is nobody else."""

    def on_base(self, steady: int) -> int:
        """It is made of no other."""
        return steady


class SkewedTime:
    """A clock that goes wrong: `ahead` nanoseconds ahead of another at first, and gaining `drift` seconds in a second.

    Steady time, which has no beginning that one could know, only drifts. Both may be negative; a drift is above -1.
    """

    def __init__(self, base: TimeBase, *, ahead: int = 0, drift: float = 0.0) -> None:
        if not -1.0 + 1e-9 <= drift < float("inf"):
            raise ValueError(f"a clock's drift must be above -1 seconds in a second, got {drift}")
        self.virtual, self.hosted = base.virtual, base.hosted
        self._base, self._ahead, self._gain = base, ahead, round(drift * 1e9)
        self._begin, self._steady_begin = base.now(), base.steady()

    def now(self) -> int:
        """The time that it shows: nanoseconds."""
        now = self._base.now()
        return now + self._ahead + (now - self._begin) * self._gain // 10**9

    def steady(self) -> int:
        """Nanoseconds that only grow."""
        now = self._base.steady()
        return now + (now - self._steady_begin) * self._gain // 10**9

    def on_base(self, steady: int) -> int:
        """Say when that is in the steady time of the clock behind: the first nanosecond at which it has come."""
        return self._base.on_base(self._behind(steady))

    def _behind(self, steady: int) -> int:
        return self._steady_begin - (self._steady_begin - steady) * 10**9 // (10**9 + self._gain)

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Wait until something arrives, and give it undelivered, or until steady time is `until`; or less long."""
        return self._base.wait(inbox, self._until(until))

    def sleep(self, nanoseconds: int) -> None:
        """Let so much time pass."""
        self._base.sleep(self._behind(self.steady() + max(0, nanoseconds)) - self._base.steady())

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; wait for one until steady time is `until`. Raises queue.Empty."""
        return self._base.take(source, self._until(until))

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Wait until `holds()`, or until steady time is `until`."""
        self._base.wait_until(holds, self._until(until))

    def pass_on(self) -> None:
        """Let others go on who are ready now."""
        self._base.pass_on()

    def _until(self, steady: int | None) -> int | None:
        return None if steady is None else self._behind(steady)
