"""Start, interruption and end of a host's programs, by its scheduler."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from robolink.host.host_time import HostTime
from robolink.host.participants import Job, Killed, ProgramLike, Runner
from robolink.host.watchdog import Watchdog

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
            if runner.is_host and runner.wait.inbox is None:
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
