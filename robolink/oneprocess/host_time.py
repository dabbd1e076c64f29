"""The virtual time of a host: whoever waits in it lets all other programs go on."""

from __future__ import annotations

import queue
from collections.abc import Callable
from typing import Any, cast

from robolink.inbox import Inbox
from robolink.oneprocess.parts import HostedInbox, Job
from robolink.oneprocess.turns import ACTS, Turns
from robolink.timebase import VirtualTime

A_POLL = 1_000_000
"""Nanoseconds that it takes to ask whether there is something, for whoever asks again and again without waiting."""

OFTEN = 20
"""How often one may ask at one moment before that."""


class HostTime(VirtualTime):
    """Virtual time of a host; it begins at `start` nanoseconds."""

    hosted = True

    def __init__(self, start: int) -> None:
        super().__init__(start)
        self.turns = Turns(self)
        self._asked, self._asked_at = 0, 0

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        """Call `act()` when it is `time_ns`, before the callbacks that are due then; at once is the earliest."""
        self.turns.at(max(time_ns, self._now), Job(None, act), ACTS)

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """Let the others go on until something arrives, or it is `until`; what arrives is delivered already."""
        self.turns.wait(inbox=cast(HostedInbox, inbox), until=until)

    def wait_until(self, holds: Callable[[], bool], until: int | None) -> None:
        """Let the others go on until `holds()`, or it is `until`."""
        if not holds():
            self.turns.wait(holds=holds, until=until)

    def sleep(self, nanoseconds: int) -> None:
        """Let the others go on for so long."""
        self.turns.wait(until=self._now + max(0, nanoseconds))

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take the oldest of a queue; let the others go on until there is one, or it is `until`. Raises queue.Empty."""
        self.wait_until(lambda: not source.empty(), until)
        return source.get_nowait()

    def pass_on(self) -> None:
        """Let others go on who are ready now. Who asks often without waiting lets a millisecond pass each time."""
        self._asked = self._asked + 1 if self._asked_at == self._now else 0
        self.turns.wait(until=self._now + (A_POLL if self._asked > OFTEN else 0))
        self._asked_at = self._now
