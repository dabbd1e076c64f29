"""Watchdog of a host: finds, in real time, code that blocks by itself, which would stop all programs.

Where a program has several threads, one that blocks may wait for another of them (at a lock, say): the turn is taken
from it then, and it goes on beside the others until it waits in virtual time again.
"""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from robolink.host.call_sites import frame_of, place_of, spot_of
from robolink.system import clocks

if TYPE_CHECKING:
    from robolink.host.participants import Runner
    from robolink.host.scheduler import Scheduler

LOOK = 0.1
"""Period of the watchdog's looks, in real seconds."""

BLOCKED = 0.5
"""Real seconds at one instruction after which a thread seems to wait for another of its program."""

BY_ITSELF = "wait by itself (not the same each time)"
"""Entry in the record of real time for a thread that was passed over."""


class Watchdog(threading.Thread):
    """Thread that gives up code that does not go on for `scheduler.patience` real seconds, or time that does not."""

    def __init__(self, scheduler: Scheduler) -> None:
        super().__init__(name="robolink host's watchdog", daemon=True)
        self._scheduler = scheduler
        self._over = threading.Event()

    def run(self) -> None:
        """Look until stopped."""
        seen: tuple[Runner | None, int] = (None, -1)
        since = still = moved = 0.0
        spot, moment = (0, 0), -1
        while not self._over.wait(LOOK):
            now, found = clocks.monotonic(), self._scheduler.at_work()
            here = spot_of(found[0])
            if found != seen:
                since = now
            if found != seen or here != spot:
                seen, still, spot = found, now, here
            if found[0] is None or moment != self._scheduler.time.now():
                moved, moment = now, self._scheduler.time.now()
            if found[0] is None:
                continue
            if now - since >= self._scheduler.patience:
                self._scheduler.give_up(found[0])
            elif now - moved >= self._scheduler.patience:
                self._scheduler.tell_of_standstill(found[0])
            elif now - still >= BLOCKED:
                self._scheduler.pass_over(found[0], _note)

    def stop(self) -> None:
        """Stop the watchdog."""
        self._over.set()
        self.join()


def _note(blocked: Runner) -> None:
    """Record that a thread waits for something out of the host's sight."""
    if blocked.program is not None:
        blocked.program.host.note_real_time(blocked.program, BY_ITSELF, place_of(frame_of(blocked)))
