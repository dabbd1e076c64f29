"""Worker threads of a host's scheduler."""

from __future__ import annotations

import threading
from collections.abc import Callable

from robolink.host.participants import Killed, Runner, SchedulerLike


class Worker(threading.Thread):
    """Worker thread: runs what is due when it is its turn."""

    _acts_as_main = False

    def __init__(self, scheduler: SchedulerLike, work: Callable[[Runner], None]) -> None:
        super().__init__(name="robolink host", daemon=True)
        self.runner = Runner(scheduler)
        self.runner.is_host = True
        self.runner.thread = self
        self._work = work
        self.start()

    @property
    def daemon(self) -> bool:  # type: ignore[override]
        """True until it runs: it keeps no process from ending. Threads that a program starts inherit False from it."""
        return not self._acts_as_main

    def run(self) -> None:
        """Run turns until the host is closed."""
        self._acts_as_main = True
        try:
            self._work(self.runner)
        except Killed:
            return
