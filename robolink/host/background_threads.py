"""Threads of programs that run beside the scheduled one, since Python cannot stop them where they block.

They are threads that block by themselves, and were passed over for it: see `watchdog`.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from pathlib import Path

from robolink.host.call_sites import spot_of
from robolink.host.participants import Killed, ProgramLike, Runner

PERIOD = 0.002
"""Period of the looks at these threads, in real seconds."""

MOST_MOVES = 100
"""Number of looks that find one of them at another place, after which time moves all the same."""

MOST_LOOKS = 2500
"""Number of looks after which time moves though one of them could run: the computer has other things to do."""

STILL, STILL_UNTOLD = 2, 10
"""Number of looks that must find them at the same place: where the system tells that they wait, and where not."""

_sleep = time.sleep


class BackgroundThreads:
    """Set of these threads of one host."""

    def __init__(self) -> None:
        self.threads: list[Runner] = []

    def add(self, runner: Runner) -> None:
        """Add a thread, which takes no turns from now on."""
        runner.free = True
        self.threads.append(runner)

    def remove(self, runner: Runner) -> None:
        """Remove a thread, which takes turns again."""
        runner.free = False
        self.threads.remove(runner)

    def end(self, program: ProgramLike | None = None) -> None:
        """Raise `Killed` in the threads of a program, or in all, where they wait in virtual time, now or next."""
        for runner in self.threads:
            if program in (None, runner.program):
                runner.killed = True
                if runner.wait is not None:
                    runner.wait.error = Killed()
                    with contextlib.suppress(RuntimeError):  # it goes on already
                        runner.resume()

    def __bool__(self) -> bool:
        return bool(self.threads)

    def go_on(self, is_news: Callable[[], bool]) -> bool:
        """Wait, before time moves, while these threads make progress. Return True if they brought something to do."""
        self.threads = [each for each in self.threads if each.thread is not None and each.thread.is_alive()]
        spots: list[tuple[int, int]] = []
        moves = looks = 0
        for _ in range(MOST_LOOKS):
            before, spots = spots, [spot_of(each) for each in self.threads]
            states = {_state(each) for each in self.threads}
            if spots != before:
                moves, looks = moves + 1, 0
            else:
                looks = 0 if "R" in states else looks + 1
            if moves >= MOST_MOVES or looks >= (STILL_UNTOLD if "" in states else STILL):
                return False
            _sleep(PERIOD)
            if is_news():
                return True
        return False


def _state(runner: Runner) -> str:
    """Return Linux's letter for a thread's state, R for running or runnable; '' where the system does not tell."""
    number = None if runner.thread is None else runner.thread.native_id
    try:
        text = Path(f"/proc/self/task/{number}/stat").read_text("ascii", "replace")
    except OSError:
        return ""
    return text.rpartition(") ")[2][:1]  # after its name, in which there may be anything: see proc(5)
