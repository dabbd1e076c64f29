"""The threads of a host."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.oneprocess.parts import Killed, Runner

if TYPE_CHECKING:
    from robolink.oneprocess.turns import Turns


class Worker(threading.Thread):
    """A thread that does what is due when it is its turn."""

    _acts_as_main = False

    def __init__(self, turns: Turns, work: Callable[[Runner], None]) -> None:
        super().__init__(name="robolink host", daemon=True)
        self.runner = Runner(turns)
        self.runner.is_host = True
        self.runner.thread = self
        self._work = work
        self.start()

    @property
    def daemon(self) -> bool:  # type: ignore[override]
        """It keeps no process from ending, but is a program's main thread for the threads that the program starts."""
        return not self._acts_as_main

    def run(self) -> None:
        """Work until the host is closed."""
        self._acts_as_main = True
        try:
            self._work(self.runner)
        except Killed:
            return
