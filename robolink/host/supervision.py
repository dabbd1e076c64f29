"""Supervisor of the programs in a host: applies a launch file's rules, as `robolink.supervisor` does to processes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING

from robolink.launch.readiness import Readiness
from robolink.supervisor.policy import Action, Ask, Policy, Say, Start
from robolink.supervisor.rules import Step, described, is_orderly
from robolink.transport.memory import MemoryTransport
from robolink.wire import graph_pattern

if TYPE_CHECKING:
    from robolink.host.host import Host
    from robolink.host.program import Program
    from robolink.launch.planning import Launched


PATIENCE = 5.0
"""Virtual seconds from one step of ending a program to the next harder one."""


class Supervision:
    """Starts programs that wait for others, and applies the rules when programs end.

    The launch file's rules hold, `respawn`, `on_exit` and `start_after`, in the host's time. Nothing is decided within
    a program's turn, but right after it. `say` is called with each line that people should read.
    """

    def __init__(
        self,
        host: Host,
        launched: Sequence[Launched],
        *,
        say: Callable[[str], object] | None = None,
        ends: float | None = None,
    ) -> None:
        self.host = host
        self.policy = Policy({each.name: each.rules for each in launched}, ends=ends, patience=PATIENCE)
        self._launched = {each.name: each for each in launched}
        self._say = say or (lambda text: None)
        self.crashes: Counter[str] = Counter()
        """Number of crashes by faults, by program."""
        self.failures: list[str] = []
        """Programs that ended unasked and in disorder: which, when, and why."""
        self.ended_at: float | None = None
        """Time of the system's end, in s; None while it runs."""
        self._struck: set[str] = set()
        self._spared: set[str] = set()
        self._readiness = Readiness({each.name: each.held_by for each in launched})
        self._session: MemoryTransport | None = None
        host.on_exit.append(self._on_exit)

    @property
    def is_over(self) -> bool:
        """True once no program runs, and none will."""
        return self.policy.is_over

    def begin(self) -> None:
        """Start every program that waits for nothing else."""
        if self._readiness.held:
            self._session = MemoryTransport(bus=self.host.bus)
            self._session.watch(graph_pattern(), self._on_token)
        self._do(self.policy.begin(self.host.now))

    # What faults need of those who run programs

    def at(self, seconds: float, act: Callable[[], object]) -> None:
        """Call `act()` when the host is so many seconds old."""
        self.host.at(seconds, act)

    def crash(self, name: str, *, is_restarted: bool) -> bool:
        """Kill a program as a fault does. Return True if it ran.

        With `is_restarted`, the fault starts it again, and its rules are not applied to this end.
        """
        program = self.host.programs.get(name)
        if program is None or program.state != "running":
            return False
        self.crashes[name] += 1
        self._struck.add(name)
        if is_restarted:
            self._spared.add(name)
        self.host.crash(name)
        return True

    def spare(self, name: str) -> None:
        """Apply no rule to the next end of a program: somebody wants it, and the others to go on."""
        self._spared.add(name)

    def restart(self, name: str) -> None:
        """Start a program again that a fault has ended, unless the system is ending or it runs already."""
        if self.policy.step is None and self.host.program(name).is_over:
            self.host.restart(name)

    def interrupt(self, *, in_hurry: bool = True) -> None:
        """End all programs in order, as Ctrl-C does; the second time in a hurry, if `in_hurry`."""
        self._do(self.policy.interrupted(self.host.now, in_hurry=in_hurry))

    def end(self) -> None:
        """End all programs in order, as Ctrl-C does; those that do not are killed after a while."""
        self._say = lambda text: None
        self._do(self.policy.interrupted(self.host.now))
        self.host.run_until(lambda: self.is_over, 3 * PATIENCE)
        self.close()

    def close(self) -> None:
        """Watch the host no longer."""
        with suppress(ValueError):
            self.host.on_exit.remove(self._on_exit)
        if self._session is not None:
            self._session.close()

    def _on_exit(self, program: Program) -> None:
        name, code, cause = program.name, program.returncode or 0, _cause(program)
        if name in self._struck:
            self._struck.remove(name)
        elif not is_orderly(code, Step.INTERRUPT, cause) or program.error is not None:
            self.failures.append(f"{name} {described(code)} at {self.host.now:.3f} s" + (f": {cause}" if cause else ""))
        if name in self._spared:
            self._spared.remove(name)
        elif name in self._launched:
            self._soon(lambda: self._do(self.policy.exited(name, code, self.host.now, cause)))

    def _on_token(self, text: str, alive: bool) -> None:
        for name in self._readiness.note_token(text, alive):
            self._soon(lambda name=name: self._do(self.policy.released(name, self.host.now)))  # type: ignore[misc]

    def _soon(self, act: Callable[[], None]) -> None:
        self.host.at(self.host.now, act)

    def _do(self, actions: Sequence[Action]) -> None:
        for each in actions:
            if isinstance(each, Start):
                self._start(each.name)
            elif isinstance(each, Ask):
                self._ask(each.name, each.step)
            elif isinstance(each, Say):
                self._say(each.text)
        deadline = self.policy.deadline
        if self.policy.is_over:
            self.ended_at = self.host.now if self.ended_at is None else self.ended_at
        elif deadline is not None:
            # of 0.1 + 0.2 the host's nanoseconds are a hair earlier, and nothing would be due for ever
            self.host.at(deadline, lambda: self._do(self.policy.woken(max(self.host.now, deadline))))

    def _start(self, name: str) -> None:
        if name in self.host.programs:
            self.host.restart(name)
        else:
            each = self._launched[name]
            self.host.start(name, each.members, env=each.env)

    def _ask(self, name: str, step: Step) -> None:
        if self.host.program(name).is_over:  # a fault has ended it, and was to start it again
            self._soon(lambda: self._do(self.policy.exited(name, 0, self.host.now)))
        elif step is Step.INTERRUPT:
            self.host.interrupt(name)
        else:
            self.host.crash(name)


def _cause(program: Program) -> str:
    error = program.error
    return "" if error is None else f"{type(error).__name__}: {error}".partition("\n")[0]
