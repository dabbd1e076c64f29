"""Run the system of a launch file in one process, in virtual time, with faults, and note all that it publishes."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, cast

import msgspec

from robolink import logging
from robolink.faults import FaultsDescription, FaultyNetwork, FaultyTransport, Injector, Why
from robolink.faults.network import Timetable
from robolink.impl.log_output import output
from robolink.launch import Entry, Launched, processes
from robolink.logging import LoggingSeverity, Record
from robolink.oneprocess import Host, Program
from robolink.oneprocess.supervision import Supervision
from robolink.oneprocess.trace import Trace
from robolink.qos import QoSProfile
from robolink.simulating.result import ProgramResult, RobotResult, SimulationResult
from robolink.simulating.robots import robots_of
from robolink.simulating.settings import numpy_seeded
from robolink.simulating.undeclared import undeclared
from robolink.timebase import TimeBase
from robolink.transport.base import Outlet

if TYPE_CHECKING:
    from robolink.sim import Robot

PARTS, LEAST = 200, 10**9
"""In how many parts a run is made, each of so many nanoseconds or more; after each somebody is told how far it is."""
_SAME_EVERYWHERE = {"ROS_DOMAIN_ID": "0"}
"""What a shell may say and no run may depend on: a publisher's identity is made of its domain, among others."""


class Watching(NamedTuple):
    """Whom to tell during a run: of log lines, of what becomes of programs, and of how many seconds have passed."""

    log: Callable[[Record], object] = lambda record: None
    say: Callable[[str], object] = lambda text: None
    time: Callable[[float], object] = lambda seconds: None


def simulate(
    entries: Sequence[Entry],
    *,
    duration: float,
    name: str = "",
    seed: int | None = None,
    faults: FaultsDescription | None = None,
    given: Collection[str] = (),
    watching: Watching | None = None,
) -> SimulationResult:
    """Run a system for `duration` simulated seconds, or until it ends or Ctrl-C; give what has come of it.

    The same entries, seed and faults give the same bytes. A `seed` that is given, here or in the faults, is that of
    the faults, of Python's and numpy's generators, and of every node with a parameter `seed` that has no other value.
    Failures are, beside programs that fail, parameters `given`, named as by `with_parameters`, that their nodes do not
    declare, and faults with a name that nobody ever had.
    Raises `DocumentError` for nodes that cannot share a process, and `NotFoundError` for a crash of an unknown node.
    """
    seed = faults.seed if seed is None and faults is not None else seed
    told = watching or Watching()
    with ExitStack() as stack:
        stack.enter_context(numpy_seeded(seed or 0))
        nodes = [each for each in processes(entries) if each.members]
        launched = [replace(each, env={**_SAME_EVERYWHERE, **each.env}) for each in nodes]
        errors = stack.enter_context(_console(told.log))
        run = _Run(launched, faults or FaultsDescription(), seed or 0, told)
        run.given = given
        run.host.wishes = {} if seed is None else {"seed": seed}
        stack.callback(run.host.close)
        result = run.result(duration)
    commands = [each.name for each in entries if each.source is None]
    warnings = [f"{each} is left out: a command knows no virtual time" for each in commands]
    return msgspec.structs.replace(result, file=name, errors=len(errors), warnings=[*warnings, *result.warnings])


@contextmanager
def _console(show: Callable[[Record], object]) -> Iterator[list[Record]]:
    """Have log lines shown by this function in place of the console; yield the errors among them, as they come."""
    errors: list[Record] = []

    def note(record: Record) -> None:
        if record.severity >= LoggingSeverity.ERROR:
            errors.append(record)
        show(record)

    before = output.console
    logging.set_console_handler(note)
    try:
        yield errors
    finally:
        logging.set_console_handler(before)


class _Session(FaultyTransport):
    """A program's session; what it publishes is noted."""

    def __init__(self, network: FaultyNetwork, program: str, trace: Trace) -> None:
        super().__init__(network, program)
        self._trace = trace

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        """Declare a publisher."""
        return self._trace.tapped(key, super().advertise(key, qos))


class _Run:
    """A system on its host."""

    def __init__(self, launched: Sequence[Launched], faults: FaultsDescription, seed: int, told: Watching) -> None:
        self.trace, self.seed, self._told = Trace(), seed, told
        self.host = Host(seed=seed, connect=self._session, clock=self._clock)
        self.supervision = Supervision(self.host, launched, say=told.say)
        self.injector = Injector(self.host.bus, cast(Timetable, self.host.time), self.supervision, seed=seed)
        for each in launched:
            self.injector.introduce(each.name, [entry.name for entry in each.entries])
        self.injector.have(faults)
        self._launched, self._interrupted = launched, False
        self.given: Collection[str] = ()
        """Parameters that nodes are to declare."""

    def _session(self, program: str) -> FaultyTransport:
        return _Session(self.injector.network, program, self.trace)

    def _clock(self, program: str, time: TimeBase) -> TimeBase:
        return self.injector.clock(program, time)

    def result(self, duration: float) -> SimulationResult:
        """Run it for so long, and end it in order; give what has come of it until then."""
        begin = time.perf_counter()
        seconds = self._pass(duration)
        real_seconds = time.perf_counter() - begin
        nodes = [node for program in self.host.programs.values() for node in program.nodes]
        network = self.injector.network
        result = SimulationResult(
            seed=self.seed,
            seconds=seconds,
            real_seconds=round(real_seconds, 3),
            messages=self.trace.messages,
            bytes=self.trace.bytes,
            robots=[_of_robot(name, robot) for name, robot in robots_of(nodes)],
            programs=[self._program(each) for each in self.host.programs.values()],
            faults=network.reports,
            warnings=self._warnings(seconds, duration),
            failures=[*self._wrong_names(), *self._undeclared()],
            interrupted=self._interrupted,
            hash=self.trace.hexdigest(),
        )
        self.supervision.end()
        real_time = [f"{program} {what} at {place}" for program, what, place in self.host.real_time_use]
        failures = [*self.supervision.failures, *result.failures]
        return msgspec.structs.replace(result, failures=failures, real_time=real_time)

    def _pass(self, duration: float) -> float:
        """Let time pass until the end, or until Ctrl-C; give its seconds."""
        try:
            self._go_on(round(duration * 1e9))
        except KeyboardInterrupt:
            self._interrupted = True
            return round(self.host.now, 3)
        ended_at = self.supervision.ended_at
        return duration if ended_at is None else ended_at

    def _go_on(self, left: int) -> None:
        self.supervision.begin()
        clock = self.host.time
        end, part = clock.now() + left, max(LEAST, left // PARTS)
        while left > 0 and not self.supervision.is_over:
            clock.sleep(min(left, part))
            left = end - clock.now()
            self._told.time(self.host.now)

    def _warnings(self, seconds: float, duration: float) -> list[str]:
        interrupted = [f"interrupted at {seconds:g} of {duration:g} s"] if self._interrupted else []
        failures = self._wrong_names()
        return [*interrupted, *(each.text for each in self.injector.unmet() if each.text not in failures)]

    def _wrong_names(self) -> list[str]:
        """Say which faults name what was never there; nothing of a run that was interrupted, as it might have come."""
        unmet = [] if self._interrupted else self.injector.unmet()
        return [each.text for each in unmet if each.why is Why.WRONG_NAME]

    def _undeclared(self) -> Iterator[str]:
        return iter(()) if self._interrupted else undeclared(self.given, self._launched, self.host)

    def _program(self, program: Program) -> ProgramResult:
        crashes = self.supervision.crashes[program.name]
        error = program.error
        text = "" if error is None else f"{type(error).__name__}: {error}".partition("\n")[0]
        return ProgramResult(program.name, program.state, crashes, max(0, program.lives - 1), text)


def _of_robot(name: str, robot: Robot) -> RobotResult:
    pose = robot.pose
    return RobotResult(name, robot.driven, robot.contacts, pose.x, pose.y, pose.theta, robot.area)
