"""The threads of programs that go on beside whoever has the turn, since Python cannot stop them where they wait.

They are Python's own pools, whose workers wait for a queue that is written in C, and threads that block.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from robolink.oneprocess.parts import Killed, Runner
from robolink.oneprocess.places import spot_of

if TYPE_CHECKING:
    from robolink.oneprocess.program import Program

A_MOMENT, A_WHILE = 0.002, 100
"""Real seconds that these threads have before it is looked whether they go on; and how often that is done at most."""

_sleep = time.sleep


class Beside:
    """Those threads of a host."""

    def __init__(self) -> None:
        self._threads: list[Runner] = []

    def add(self, runner: Runner) -> None:
        """Know of a thread."""
        runner.free = True
        self._threads.append(runner)

    def remove(self, runner: Runner) -> None:
        """Have a thread take turns again."""
        runner.free = False
        self._threads.remove(runner)

    def end(self, program: Program | None = None) -> None:
        """Have the threads of a program, or all, meet `Killed` where they wait in virtual time, now or next."""
        for runner in self._threads:
            if program in (None, runner.program):
                runner.killed = True
                if runner.wait is not None:
                    runner.wait.error = Killed()
                    with contextlib.suppress(RuntimeError):  # it goes on already
                        runner.resume()

    def __bool__(self) -> bool:
        return bool(self._threads)

    def go_on(self, is_news: Callable[[], bool]) -> bool:
        """Before time goes on, wait as long as these threads do something; whether there is news of them."""
        self._threads = [each for each in self._threads if each.thread is not None and each.thread.is_alive()]
        spots: list[tuple[int, int]] = []
        for _ in range(A_WHILE):
            before, spots = spots, [spot_of(each) for each in self._threads]
            if spots == before:
                return False
            _sleep(A_MOMENT)
            if is_news():
                return True
        return False
