"""Time bases: the clocks of a whole context, and every wait in them, in system time or in virtual time that jumps.

What differs between system time, virtual time and the time of a host (`robolink.host`) are methods of a time base, so
that nothing else asks which of them it has.
"""

from __future__ import annotations

import heapq
import itertools
import queue
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from robolink.system import clocks, waits
from robolink.system.waits import A_WHILE, get_within

if TYPE_CHECKING:
    import random

    from robolink.running.inbox import Inbox


_steady = clocks.steady

POLL = 0.001
"""Polling period of `wait_until` in real time, in seconds."""

Block: TypeAlias = Callable[[float | None], object]
"""Function that blocks the calling thread until a condition holds; for so many seconds at most, for ever with None."""


class TimeBase(Protocol):
    """Clocks in nanoseconds, and the waits of programs that go by them."""

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

    def take_soon(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue as `take` does, but wait a quarter of a second at most. Raises queue.Empty."""

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Wait until `holds()`, or until steady time is `until`, by polling where time is real."""

    def wait_notified(self, holds: Callable[[], bool], until: int | None, block: Block) -> None:
        """Wait until `holds()`, or until steady time is `until`, where `block` is notified by the thread that does it.

        In virtual time no thread is blocked, since time would stand still meanwhile.
        """

    def pass_on(self) -> None:
        """Let others go on who are ready now: whoever asks whether there is something, without waiting, comes here."""

    def stands_still_for_threads(self) -> bool:
        """True if time must not go on while a callback runs in a thread of its own."""

    def ends_are_news(self) -> bool:
        """True if an executor must be woken whenever a callback in a thread ends, since time waits for it."""

    def log_clock(self) -> Callable[[], int] | None:
        """Return the clock that stamps this process's log while a context goes by this time; None for no change."""

    def fastest_pace(self) -> float:
        """Return the real-time factor of a simulated world that is to go as fast as it can; 0 stands for no limit."""

    def random_ids(self, seed: bytes) -> random.Random:
        """Return a generator for identifiers: in virtual time one made of `seed`, so that runs repeat."""

    def on_base(self, steady: int) -> int:
        """Convert a steady time to that of the time base which this one is made of; the same if it is of none."""


class SystemTime:
    """The computer's clocks."""

    now = staticmethod(clocks.now)
    steady = staticmethod(clocks.steady)

    def __init__(self) -> None:
        clocks.make_waits_exact()

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Wait until something arrives, and give it undelivered, or until steady time is `until`; or less long."""
        get = inbox.get
        try:  # `Inbox.wait` written out, where it says why: this is run for every callback
            if until is None:
                return get(True, A_WHILE)
            left = (until - _steady()) / 1e9
            try:
                return get(False)
            except queue.Empty:
                return get(True, left if left < A_WHILE else A_WHILE) if left > 0 else None
        except queue.Empty:
            return None

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

    def take_soon(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; wait for one for A_WHILE at most. Raises queue.Empty."""
        left = A_WHILE if until is None else min(A_WHILE, max(0.0, (until - self.steady()) / 1e9))
        return get_within(source, left)

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Poll `holds()`."""
        while not holds() and (until is None or self.steady() < until):
            time.sleep(POLL)

    def wait_notified(self, holds: Callable[[], bool], until: int | None, block: Block) -> None:
        """Block the thread."""
        block(None if until is None else max(0.0, (until - self.steady()) / 1e9))

    def pass_on(self) -> None:
        """Do nothing: the operating system schedules threads."""

    def stands_still_for_threads(self) -> bool:
        """Return False: real time goes on."""
        return False

    ends_are_news = stands_still_for_threads

    def log_clock(self) -> Callable[[], int] | None:
        """Return None: a log is stamped by the system's clock anyway."""

    def fastest_pace(self) -> float:
        """Return 0: no limit."""
        return 0.0

    def random_ids(self, seed: bytes) -> random.Random:
        """Return the operating system's generator: identifiers of two processes must differ."""
        from random import SystemRandom

        return SystemRandom()

    def on_base(self, steady: int) -> int:
        """Return it as it is: this time base is made of no other."""
        return steady


class VirtualTime:
    """Virtual time: it stands still while there is work, and jumps to the next deadline when there is none.

    `Context(time=VirtualTime())` gives it to the nodes of a context. `start` is the time at its beginning, in
    nanoseconds.
    """

    def __init__(self, start: int = 0) -> None:
        self._now = start
        self._acts: list[tuple[int, int, Callable[[], object]]] = []
        self._serial = itertools.count()

    def now(self) -> int:
        """Return the virtual time in nanoseconds."""
        return self._now

    steady = now

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        """Call `act()` when it is `time_ns`, before the callbacks that are due then; at once is the earliest."""
        heapq.heappush(self._acts, (time_ns, next(self._serial), act))

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Jump to `until`, unless `inbox` has something; with nothing to come, wait for another thread's message."""
        if self._acts:
            until = self._acts[0][0] if until is None else min(until, self._acts[0][0])
        if until is None or not inbox.empty():
            return inbox.wait(None)
        self._jump(until)
        return None

    def sleep(self, nanoseconds: int) -> None:
        """Jump ahead by so many `nanoseconds`, at once; negative is 0."""
        until = self._now + max(0, nanoseconds)
        while self._acts and self._acts[0][0] <= until:
            self._jump(self._acts[0][0])
        self._jump(until)

    def _jump(self, until: int) -> None:
        self._now = max(self._now, until)
        while self._acts and self._acts[0][0] <= self._now:
            heapq.heappop(self._acts)[2]()

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of `source`; wait in real time for another thread to bring one, `until` then."""
        return waits.get(source, None if until is None else (until - self._now) / 1e9)

    def take_soon(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of `source`; wait for another thread to bring one, for A_WHILE of real time, not `until`."""
        return get_within(source, A_WHILE)

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Jump to `until`, unless `holds()` already; without an end, ask again and again for what other threads do."""
        if until is None:
            while not holds():
                time.sleep(POLL)
        elif not holds():
            self.sleep(until - self._now)

    def wait_notified(self, holds: Callable[[], bool], until: int | None, block: Block) -> None:
        """Jump to `until`; without an end, call `block(None)`, since only another thread can make `holds()` true."""
        if until is None:
            block(None)
        else:
            self.wait_until(holds, until)

    def pass_on(self) -> None:
        """Do nothing: there is no other program."""

    def stands_still_for_threads(self) -> bool:
        """Return True: a callback that works in a thread takes no virtual time."""
        return True

    def ends_are_news(self) -> bool:
        """Return True: an executor waits for the end of each."""
        return True

    def log_clock(self) -> Callable[[], int] | None:
        """Return this clock."""
        return self.now

    def fastest_pace(self) -> float:
        """Return 1: a world that ran ahead of virtual time, as fast as that is, would leave none to others."""
        return 1.0

    def random_ids(self, seed: bytes) -> random.Random:
        """Return a generator made of `seed`: in virtual time a program does the same each time, byte for byte."""
        from random import Random

        return Random(seed)

    def on_base(self, steady: int) -> int:
        """Return `steady` as it is: this time base is made of no other."""
        return steady


class SkewedTime:
    """A clock that goes wrong: `ahead` nanoseconds ahead of another at first, and gaining `drift` seconds in a second.

    Steady time, which has no beginning that one could know, only drifts. Both may be negative; a drift is above -1.
    """

    def __init__(self, base: TimeBase, *, ahead: int = 0, drift: float = 0.0) -> None:
        if not -1.0 + 1e-9 <= drift < float("inf"):
            raise ValueError(f"a clock's drift must be above -1 seconds in a second, got {drift}")
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
        """Convert a steady time to that of the clock behind: the first nanosecond at which it has come."""
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

    def take_soon(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; wait a quarter of a second of the clock behind at most. Raises queue.Empty."""
        return self._base.take_soon(source, self._until(until))

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Wait until `holds()`, or until steady time is `until`."""
        self._base.wait_until(holds, self._until(until))

    def wait_notified(self, holds: Callable[[], bool], until: int | None, block: Block) -> None:
        """Wait until `holds()`, or until steady time is `until`."""
        self._base.wait_notified(holds, self._until(until), block)

    def pass_on(self) -> None:
        """Let others go on who are ready now."""
        self._base.pass_on()

    def stands_still_for_threads(self) -> bool:
        """Return the answer of the clock behind."""
        return self._base.stands_still_for_threads()

    def ends_are_news(self) -> bool:
        """Return the answer of the clock behind."""
        return self._base.ends_are_news()

    def log_clock(self) -> Callable[[], int] | None:
        """Return this clock, if that behind would be used."""
        return None if self._base.log_clock() is None else self.now

    def fastest_pace(self) -> float:
        """Return the answer of the clock behind."""
        return self._base.fastest_pace()

    def random_ids(self, seed: bytes) -> random.Random:
        """Return the generator of the clock behind."""
        return self._base.random_ids(seed)

    def _until(self, steady: int | None) -> int | None:
        return None if steady is None else self._behind(steady)
