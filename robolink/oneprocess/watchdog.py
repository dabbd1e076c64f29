"""Looks, in real time, whether whoever has the turn goes on: code that blocks by itself would stop the whole host.

Where a program has several threads, one that blocks may wait for another of them (at a lock, say): the turn is taken
from it then, and it goes on beside the others until it waits in virtual time again.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING

from robolink.oneprocess.places import frame_of, place_of, spot_of

if TYPE_CHECKING:
    from robolink.oneprocess.parts import Runner
    from robolink.oneprocess.turns import Turns

LOOK = 0.1
"""Real seconds from look to look."""

BLOCKED = 0.5
"""Real seconds at one instruction after which a thread seems to wait for another of its program."""

BY_ITSELF = "wait by itself (not the same each time)"
"""What is told of a thread that was passed over."""


class Watchdog(threading.Thread):
    """Has a host give up a thread that does not go on for `turns.patience` real seconds, or time that does not."""

    def __init__(self, turns: Turns) -> None:
        super().__init__(name="robolink host's watchdog", daemon=True)
        self._turns = turns
        self._over = threading.Event()

    def run(self) -> None:
        """Look until told to stop."""
        seen: tuple[Runner | None, int] = (None, -1)
        since = still = moved = 0.0
        spot, moment = (0, 0), -1
        while not self._over.wait(LOOK):
            now, found = time.monotonic(), self._turns.at_work()
            here = spot_of(found[0])
            if found != seen:
                since = now
            if found != seen or here != spot:
                seen, still, spot = found, now, here
            if found[0] is None or moment != self._turns.time.now():
                moved, moment = now, self._turns.time.now()
            if found[0] is None:
                continue
            if now - since >= self._turns.patience:
                self._turns.give_up(found[0])
            elif now - moved >= self._turns.patience:
                self._turns.tell_of_standstill(found[0])
            elif now - still >= BLOCKED:
                self._turns.pass_over(found[0], _note)

    def stop(self) -> None:
        """Look no more."""
        self._over.set()
        self.join()


def _note(blocked: Runner) -> None:
    """Note that what a thread waits for is out of the host's sight."""
    if blocked.program is not None:
        blocked.program.host.note_real_time(blocked.program, BY_ITSELF, place_of(frame_of(blocked)))
