"""The threads of programs that go on beside whoever has the turn, since Python cannot stop them where they wait.

They are threads that block by themselves, and were passed over for it: see `watchdog`.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.oneprocess.parts import Killed, Runner
from robolink.oneprocess.places import spot_of

if TYPE_CHECKING:
    from robolink.oneprocess.program import Program

A_MOMENT, A_WHILE, A_LONG_WHILE = 0.002, 100, 2500
"""Real seconds that these threads have before it is looked whether they go on; and how often that is done at most:
where they do, and where they only could, since the computer has other things to do."""

SURE, UNSURE = 2, 10
"""How often they must be seen at the same place: where the system tells that they wait there, and where it does not."""

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
        moves = looks = 0
        for _ in range(A_LONG_WHILE):
            before, spots = spots, [spot_of(each) for each in self._threads]
            states = {_state(each) for each in self._threads}
            if spots != before:
                moves, looks = moves + 1, 0
            else:
                looks = 0 if "R" in states else looks + 1
            if moves >= A_WHILE or looks >= (UNSURE if "" in states else SURE):
                return False
            _sleep(A_MOMENT)
            if is_news():
                return True
        return False


def _state(runner: Runner) -> str:
    """Give the letter that Linux has for what a thread does, R for one that runs or could; '' if nobody tells."""
    number = None if runner.thread is None else runner.thread.native_id
    try:
        text = Path(f"/proc/self/task/{number}/stat").read_text("ascii", "replace")
    except OSError:
        return ""
    return text.rpartition(") ")[2][:1]  # after its name, in which there may be anything: see proc(5)
