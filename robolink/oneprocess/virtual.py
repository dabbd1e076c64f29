"""How a host runs programs in virtual time: they take turns."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from robolink.oneprocess.host_time import HostTime
from robolink.oneprocess.hosted import VirtualContext
from robolink.oneprocess.parts import Job, Killed, Runner
from robolink.oneprocess.watchdog import Watchdog

if TYPE_CHECKING:
    from robolink.oneprocess.program import Program

BEGIN = 10**9
"""When virtual time begins: nanoseconds. Not 0, which ROS 2 takes for "no time yet"."""


class VirtualPace:
    """Lets programs go on as fast as they can, one at a time."""

    context_type = VirtualContext

    def __init__(self) -> None:
        self.time = HostTime(BEGIN)
        self.turns = self.time.turns
        self._watchdog = Watchdog(self.turns)
        self._watchdog.start()

    def begin(self, program: Program) -> None:
        """Begin a program; if it is asked for from outside, go on until it has begun or waits."""
        program.defaults.in_main_thread = self.turns.runners.is_hosts
        self.turns.due.append(Job(program, program.begin))
        if self.turns.runner() is self.turns.outside:
            self.turns.wait(holds=lambda: program.has_begun or program.has_waited or program.is_over)

    def run_until(self, condition: Callable[[], bool], until: int) -> bool:
        """Let time pass until the condition, asked after each callback, holds or it is `until`; whether it holds."""
        if not condition():
            self.turns.wait(holds=condition, until=until)
        return condition()

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        """Call `act()` when it is so late, before what callbacks are due then."""
        self.time.at(time_ns, act)

    def interrupt(self, program: Program) -> None:
        """Have a program interrupted when it is nobody's turn."""
        self.turns.due.append(Job(program, program.interrupt))

    def break_in(self, program: Program, error: BaseException | None) -> None:
        """Let what waits of a program's code look around; raise the error where its main thread waits."""
        for runner in self.turns.runners.waiting(program):
            assert runner.wait is not None
            if runner.is_host and runner.wait.inbox is None:
                if error is None:
                    continue  # its handler has done all that there was to do: a wait goes on
                runner.wait.error = error
            self.turns.due.append(runner.wait)
        if program.executor is not None:
            program.executor.wake()

    def unwind(self, program: Program) -> None:
        """Have what waits of a program's code end where it waits."""
        self._kill(self.turns.runners.waiting(program))
        self.turns.beside.end(program)

    def end_daemons(self, program: Program) -> None:
        """Have those threads end that do not keep a program from ending."""
        self._kill(each for each in self.turns.runners.waiting(program) if each.is_daemon)

    def _kill(self, runners: Iterable[Runner]) -> None:
        for runner in runners:
            assert runner.wait is not None
            runner.wait.error = Killed()
            runner.killed = True
            self.turns.due.append(runner.wait)

    def note_exit(self) -> None:
        """Do nothing: who waits for it is asked anyway."""

    def close(self) -> None:
        """End all threads."""
        self._watchdog.stop()
        self.turns.close()
        self.turns.beside.end()
