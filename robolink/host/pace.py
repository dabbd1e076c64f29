"""Pace of a host: its programs' start and end, its virtual time, and the watchdog of what blocks in real time."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterable
from typing import Any, cast

from robolink.host.call_sites import frame_of, place_of, spot_of
from robolink.host.participants import ACTS, HostedInbox, Job, Killed, ProgramLike, Runner
from robolink.host.scheduler import Scheduler
from robolink.running.inbox import Inbox
from robolink.running.ready_queue import earlier
from robolink.running.timebase import Block, VirtualTime
from robolink.system import clocks
from robolink.system.waits import A_WHILE

BEGIN = 10**9
"""Start of virtual time, in ns. Not 0, which ROS 2 takes for "no time yet"."""


class Pace:
    """Runs programs as fast as the computer can, one at a time."""

    def __init__(self) -> None:
        self.time = HostTime(BEGIN)
        self.scheduler = self.time.scheduler
        self._watchdog = Watchdog(self.scheduler)
        self._watchdog.start()

    def begin(self, program: ProgramLike) -> None:
        """Begin a program; if asked from outside of the scheduler, run until it has begun or waits."""
        program.defaults.in_main_thread = self.scheduler.runners.is_hosts
        self.scheduler.due.append(Job(program, program.begin))
        if self.scheduler.runner() is self.scheduler.outside:
            self.scheduler.wait(holds=lambda: program.has_begun or program.has_waited or program.is_over)

    def run_until(self, condition: Callable[[], bool], until: int) -> bool:
        """Run until the condition, checked after each callback, or `until`. Return True if it holds."""
        if not condition():
            self.scheduler.wait(holds=condition, until=until)
        return condition()

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        """Call `act()` at a moment, before the callbacks that are due then."""
        self.time.at(time_ns, act)

    def interrupt(self, program: ProgramLike) -> None:
        """Interrupt a program as soon as no code of it runs."""
        self.scheduler.due.append(Job(program, program.interrupt))

    def break_in(self, program: ProgramLike, error: BaseException | None) -> None:
        """Wake what waits in a program's code; raise the error where its main thread waits."""
        for runner in self.scheduler.runners.waiting(program):
            assert runner.wait is not None
            inbox = runner.wait.inbox
            if runner.is_host and (inbox is None or not inbox.is_executors):
                if error is None:
                    continue  # its handler has done all that there was to do: a wait goes on
                runner.wait.error = error
            self.scheduler.due.append(runner.wait)
        if program.driver is not None:
            program.driver.inbox.wake()

    def unwind(self, program: ProgramLike) -> None:
        """Raise `Killed` in the threads of a program, where they wait."""
        self._kill(self.scheduler.runners.waiting(program))
        self.scheduler.background.end(program)

    def end_daemons(self, program: ProgramLike) -> None:
        """Raise `Killed` in a program's daemon threads."""
        self._kill(each for each in self.scheduler.runners.waiting(program) if each.is_daemon)

    def _kill(self, runners: Iterable[Runner]) -> None:
        for runner in runners:
            assert runner.wait is not None
            runner.wait.error = Killed()
            runner.killed = True
            self.scheduler.due.append(runner.wait)

    def close(self) -> None:
        """End all threads of the host."""
        self._watchdog.stop()
        self.scheduler.close()
        self.scheduler.background.end()


POLL_TAKES = 1_000_000
"""Virtual time that a poll takes, in ns, for whoever polls again and again without waiting."""

FREE_POLLS = 20
"""Polls at one moment that take no time."""


class HostTime(VirtualTime):
    """Virtual time of a host; it begins at `start` nanoseconds, and its scheduler moves it."""

    def __init__(self, start: int) -> None:
        super().__init__(start)
        self.scheduler = Scheduler(self)
        self._polls, self._polled_at = 0, 0

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
        # A loop of `spin_once(timeout_sec=0)` would stop virtual time.
        self._polls = self._polls + 1 if self._polled_at == self._now else 0
        self.scheduler.wait(until=self._now + (POLL_TAKES if self._polls > FREE_POLLS else 0))
        self._polled_at = self._now


LOOK = 0.1
"""Period of the watchdog's looks, in real seconds."""

BLOCKED = 0.5
"""Real seconds at one instruction after which a thread seems to wait for another of its program."""

BY_ITSELF = "wait by itself (not the same each time)"
"""Entry in the record of real time for a thread that was passed over."""


class Watchdog(threading.Thread):
    """Thread that gives up code that does not go on for `scheduler.patience` real seconds, or time that does not.

    Where a program has several threads, one that blocks may wait for another of them (at a lock, say): the turn is
    taken from it then, and it goes on beside the others until it waits in virtual time again.
    """

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
