"""Supervisor of the programs in a host: applies a launch file's rules, as `robolink.supervisor` does to processes."""

from __future__ import annotations

import signal
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

from robolink import logging
from robolink.impl.log_output import DEFAULT_FORMAT, Record, compile_format
from robolink.launch.entry import NODE
from robolink.launch.planning import processes
from robolink.launch.readiness import Readiness
from robolink.node import Node
from robolink.running.defaults import get_defaults
from robolink.supervisor.director import Add, Director, Request, Signal, Stop, Tell
from robolink.supervisor.policy import Action, Ask, Policy, Say, Start, Step, described, is_orderly
from robolink.system.processes import Variables
from robolink.transport.memory import MemoryTransport
from robolink.wire import graph_pattern

if TYPE_CHECKING:
    from robolink.host.host import Host
    from robolink.host.program import Program
    from robolink.launch.entry import Direct, Entry
    from robolink.launch.planning import Launched


_AS_LINE = compile_format(DEFAULT_FORMAT)
LOOK_AGAIN = 0.01
"""Virtual seconds between two looks of the launcher's own node at what it is to do."""
PATIENCE = 5.0
"""Virtual seconds from one step of ending a program to the next harder one."""


class _Own(Node):
    """The launcher's own node, which carries out what waits for it."""

    acts: ClassVar[list[Callable[[Node], object]]]

    def __init__(self) -> None:
        super().__init__(NODE, enable_rosout=False, start_parameter_services=False)
        self.create_timer(LOOK_AGAIN, self.act)
        self.act()

    def act(self) -> None:
        """Carry out what waits."""
        while self.acts:
            self.acts.pop(0)(self)


class Supervision:
    """Starts programs that wait for others, and applies the rules when programs end.

    Commands are left out: they know no virtual time. The launch file's rules hold, `respawn`, `on_exit` and
    `start_after`, in the host's time. Nothing is decided within a program's turn, but right after it.

    Args:
        host: Host of the programs.
        launched: The programs, and commands.
        say: Called with each line that people should read.
        ends: Time of the end, in s; None has none.
        direct: Maker of the director of a launch file with timers and event handlers; None has none.
        on_added: Called with each program that the director adds.
        on_failure: Called with the reason if the director ends the system for a mistake in the launch file.
        env: Variables of these, besides their own.
    """

    def __init__(
        self,
        host: Host,
        launched: Sequence[Launched],
        *,
        say: Callable[[str], object] | None = None,
        ends: float | None = None,
        direct: Direct | None = None,
        on_added: Callable[[Launched], object] = lambda launched: None,
        on_failure: Callable[[str], object] = lambda reason: None,
        env: Variables | None = None,
    ) -> None:
        self.host = host
        programs = [each for each in launched if each.members]
        self.policy = Policy({each.name: each.rules for each in programs}, ends=ends, patience=PATIENCE)
        self._launched = {each.name: each for each in programs}
        self._commands = [each.name for each in launched if not each.members]
        self._say = say or (lambda text: None)
        self.crashes: Counter[str] = Counter()
        """Number of crashes by faults, by program."""
        self.failures: list[str] = []
        """Programs that ended unasked and in disorder: which, when, and why."""
        self.ended_at: float | None = None
        """Time of the system's end, in s; None while it runs."""
        self._struck: set[str] = set()
        self._spared: set[str] = set()
        self._readiness = Readiness({each.name: each.held_by for each in programs})
        self._session: MemoryTransport | None = None
        self._on_added, self._on_failure, self._env = on_added, on_failure, env or {}
        self._wake_at: float | None = None
        """Time of the next wake-up; those before it that have become needless are ignored."""
        self._own: Program | None = None
        self._waiting: list[Callable[[Node], object]] = []
        self._director: Director[Launched] | None = None if direct is None else direct(self)
        self._has_announced_end = self._is_listening = False
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
        actions = self._directed(lambda director: director.begin(self.host.now))
        for name in self._commands:
            actions += self._left_out(name)
        self._do([*self.policy.begin(self.host.now), *actions])

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
        if self._is_listening:
            logging.remove_handler(self._on_log)

    def _on_exit(self, program: Program) -> None:
        name, code, cause = program.name, program.returncode or 0, _cause(program)
        if name in self._struck:
            self._struck.remove(name)
        elif not is_orderly(code, Step.INTERRUPT, cause) or program.error is not None:
            self.failures.append(f"{name} {described(code)} at {self.host.now:.3f} s" + (f": {cause}" if cause else ""))
        if name in self._spared:
            self._spared.remove(name)
        elif name in self._launched:
            self._soon(lambda: self._do(self._exited(name, code, cause)))

    def _exited(self, name: str, code: int, cause: str) -> list[Action]:
        now = self.host.now
        actions = self.policy.exited(name, code, now, cause)
        return [*actions, *self._directed(lambda director: director.exited(name, code, now))]

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
        self._tell_end()
        deadline = self._deadline()
        if self.policy.is_over:
            self.ended_at = self.host.now if self.ended_at is None else self.ended_at
        elif deadline is not None and (self._wake_at is None or deadline < self._wake_at):
            self._wake_at = deadline
            self.host.at(deadline, lambda: self._wake(deadline))

    def _wake(self, deadline: float) -> None:
        if deadline == self._wake_at:
            self._wake_at = None
            # of 0.1 + 0.2 the host's nanoseconds are a hair earlier, and nothing would be due for ever
            self._do(self._woken(max(self.host.now, deadline)))

    def _deadline(self) -> float | None:
        deadlines = [self.policy.deadline, None if self._director is None else self._director.deadline]
        return min((each for each in deadlines if each is not None), default=None)

    def _woken(self, now: float) -> list[Action]:
        due = None if self._director is None else self._director.deadline
        actions = [] if due is None or now < due else self._directed(lambda director: director.woken(now))
        return [*self.policy.woken(now), *actions]

    def _start(self, name: str) -> None:
        if name in self.host.programs:
            self.host.restart(name)
        else:
            each = self._launched[name]
            self.host.start(name, each.members, env=each.env)
        if self._director is not None:
            self._soon(lambda: self._do(self._directed(lambda director: director.started(name, 0, self.host.now))))

    def _ask(self, name: str, step: Step) -> None:
        if self.host.program(name).is_over:  # a fault has ended it, and was to start it again
            self._soon(lambda: self._do(self.policy.exited(name, 0, self.host.now)))
        elif step is Step.INTERRUPT:
            self.host.interrupt(name)
        else:
            self.host.crash(name)

    # What the director decides

    def plan(self, entries: list[Entry]) -> list[Launched]:
        """Return the programs in which entries run that the director adds."""
        return [replace(each, env={**self._env, **each.env}) for each in processes(entries)]

    def with_node(self, act: Callable[[Node], object]) -> None:
        """Call `act` with the launcher's own node, in the turn of its program, which begins with the first call."""
        self._waiting.append(act)
        if self._own is None:
            self._own = self.host.start_class(type("Own", (_Own,), {"acts": self._waiting}), NODE)

    def post(self, act: Callable[[float], Sequence[Request[Launched]]]) -> None:
        """Call `act` with the time right after the present turn, and carry out what it returns."""
        self._soon(lambda: self._do(self._directed(lambda _: act(self.host.now))))

    def _directed(self, ask: Callable[[Director[Launched]], Sequence[Request[Launched]]]) -> list[Action]:
        """Ask the director, if there is one; return the actions that carry out what it asks for."""
        if self._director is None:
            return []
        actions: list[Action] = []
        for each in ask(self._director):
            actions += self._carried_out(each)
        self.policy.expects_more = self._director.deadline is not None
        if self._director.hears_lines and not self._is_listening:
            self._is_listening = True
            logging.add_handler(self._on_log)
        return actions

    def _carried_out(self, request: Request[Launched]) -> list[Action]:
        now = self.host.now
        if isinstance(request, Add):
            return self._added(request.process)
        if isinstance(request, Stop):
            return self.policy.stop_one(request.name, now, is_interrupted=request.is_interrupted)
        if isinstance(request, Signal):
            return [] if request.name not in self.host.programs else self._signalled(request)
        if isinstance(request, Tell):
            return [Say(request.text, request.severity)]
        if request.code:
            self.failures.append(request.reason)
            self._on_failure(request.reason)
        return self.policy.end(request.reason, request.code, now)

    def _added(self, launched: Launched) -> list[Action]:
        """Add a program; a command is left out."""
        name = launched.name
        if not launched.members:
            self._soon(lambda: self._do(self._left_out(name)))
            return [Say(f"{name} is left out: a command knows no virtual time")]
        self._launched[name] = launched
        self._on_added(launched)
        return self.policy.add(name, launched.rules, self.host.now)

    def _left_out(self, name: str) -> list[Action]:
        return self._directed(lambda director: director.left_out(name, self.host.now))

    def _signalled(self, request: Signal) -> list[Action]:
        """Interrupt a program, which handles SIGINT and SIGTERM, or kill it as other signals would do."""
        if request.number in (signal.SIGINT, signal.SIGTERM):
            self.host.interrupt(request.name)
        else:
            self.host.crash(request.name)
        return []

    def _on_log(self, record: Record) -> None:
        """Pass a line of a program's log to the director, as it would stand in the output of its process."""
        program = get_defaults().program
        name = "" if program is None else program.name
        if program is None or self.host.programs.get(name) is not program:
            return
        line = f"{_AS_LINE(record)}\n".encode()
        self._soon(lambda: self._do(self._directed(lambda director: director.line(name, line, self.host.now))))

    def _tell_end(self) -> None:
        """Inform the director once that the system is ending."""
        is_ending = self.policy.step is not None or self.policy.is_over
        if self._director is not None and is_ending and not self._has_announced_end:
            self._has_announced_end = True
            actions = self._directed(lambda director: director.stopping(self.host.now))
            self.policy.expects_more = False
            self._do(actions)


def _cause(program: Program) -> str:
    error = program.error
    return "" if error is None else f"{type(error).__name__}: {error}".partition("\n")[0]
