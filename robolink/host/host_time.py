"""Virtual time base of a host: a wait in it lets all other programs go on."""

from __future__ import annotations

import queue
from collections.abc import Callable
from typing import Any, cast

from robolink.host.participants import ACTS, HostedInbox, Job
from robolink.host.scheduler import Scheduler
from robolink.running.inbox import Inbox
from robolink.running.ready_queue import earlier
from robolink.running.timebase import Block, VirtualTime
from robolink.system.waits import A_WHILE

POLL_TAKES = 1_000_000
"""Virtual time that a poll takes, in ns, for whoever polls again and again without waiting."""

FREE_POLLS = 20
"""Polls at one moment that take no time."""


class HostTime(VirtualTime):
    """Virtual time of a host; it begins at `start` nanoseconds, and its scheduler moves it."""

    def __init__(self, start: int) -> None:
        super().__init__(start)
        self.scheduler = Scheduler(self)
        self._asked, self._asked_at = 0, 0

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        """Call `act()` when it is `time_ns`, before the callbacks that are due then; at once is the earliest."""
        self.scheduler.at(max(time_ns, self._now), Job(None, act), ACTS)

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Let the others go on until something arrives, or it is `until`; what arrives is delivered already."""
        self.scheduler.wait(inbox=cast(HostedInbox, inbox), until=until)

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Let the others go on until `holds()`, or it is `until`."""
        if not holds():
            self.scheduler.wait(holds=holds, until=until)

    def sleep(self, nanoseconds: int) -> None:
        """Let the others go on for so long."""
        self.scheduler.wait(until=self._now + max(0, nanoseconds))

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; let the others go on until there is one, or it is `until`. Raises queue.Empty."""
        self.wait_until(lambda: not source.empty(), until)
        return source.get_nowait()

    def take_soon(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; wait for A_WHILE of virtual time at most. Raises queue.Empty."""
        return self.take(source, earlier(until, self._now + int(A_WHILE * 1e9)))

    def wait_notified(self, holds: Callable[[], bool], until: int | None, block: Block) -> None:
        """Let the others go on until `holds()`, or it is `until`: never block, the others have this thread's turn."""
        self.wait_until(holds, until)

    def stands_still_for_threads(self) -> bool:
        """Return False: the host's scheduler knows when all threads wait."""
        return False

    def log_clock(self) -> Callable[[], int] | None:
        """Return None: the host stamps each line by the clock of the program that writes it."""

    def pass_on(self) -> None:
        """Let others go on who are ready now. After FREE_POLLS polls at one moment, each takes a millisecond."""
        self._asked = self._asked + 1 if self._asked_at == self._now else 0
        self.scheduler.wait(until=self._now + (POLL_TAKES if self._asked > FREE_POLLS else 0))
        self._asked_at = self._now
