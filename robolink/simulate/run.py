"""Run of a launch file's system in a host, with faults, and with a trace of all that it publishes."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from robolink import logging
from robolink.faults import FaultsDescription, FaultyNetwork, FaultyTransport, Injector, Why
from robolink.host import Host, Program
from robolink.host.supervision import Supervision
from robolink.host.trace import Trace
from robolink.impl.log_output import output
from robolink.launch import Entry, Launched, processes
from robolink.logging import LoggingSeverity, Record
from robolink.qos import QoSProfile
from robolink.running.timebase import TimeBase
from robolink.simulate.nodes import robots_of, undeclared
from robolink.simulate.result import ProgramResult, RobotResult, SimulationResult
from robolink.simulate.settings import numpy_seeded
from robolink.transport.base import NumberingOutlet

if TYPE_CHECKING:
    from robolink.launch.entry import Direct
    from robolink.node import Node
    from robolink.sim import Robot
    from robolink.simulate.recording import SimulatedRecording

PARTS = 200
"""Number of parts of a run; after each its progress is reported."""

SHORTEST_PART = 10**9
"""Length of such a part at least, in ns."""

_SAME_EVERYWHERE = {"ROS_DOMAIN_ID": "0"}
"""Variables of a shell that no run may depend on: a publisher's identity is made of its domain, among others."""


class Watching(NamedTuple):
    """Callbacks during a run."""

    log: Callable[[Record], object] = lambda record: None
    """Called with each line of the log."""
    say: Callable[[str], object] = lambda text: None
    """Called with each line about starts and ends of programs."""
    time: Callable[[float], object] = lambda seconds: None
    """Called now and then with the simulated seconds that have passed."""


def simulate(
    entries: Sequence[Entry],
    *,
    duration: float,
    name: str = "",
    seed: int | None = None,
    faults: FaultsDescription | None = None,
    given: Collection[str] = (),
    watching: Watching | None = None,
    record: str | Path = "",
    direct: Direct | None = None,
) -> SimulationResult:
    """Run a system in virtual time; the same entries, seed and faults publish the same bytes.

    Args:
        entries: Entries of a launch file. Commands are left out: they know no virtual time.
        duration: Simulated seconds; the run ends earlier with the system, or by Ctrl-C.
        name: Name of the launch file, for the result.
        seed: Seed of the faults, of Python's and numpy's generators, and of every node with a parameter `seed` that has
            no other value. By default that of the faults; without one, generators begin with 0, and no node gets it.
        faults: Faults to be injected; none by default.
        given: Parameters that were set, named as by `with_parameters`. One that its node does not declare is a failure.
        watching: Callbacks during the run.
        record: Folder of a bag that gets all that is published, in virtual time; '' for none.
        direct: Maker of the director that starts and stops more while the system runs; None has none.

    Returns:
        The result. Its failures are programs that failed, such parameters, and faults with a name that nobody had.

    Raises:
        DocumentError: if nodes cannot share a process.
        NotFoundError: if a fault crashes an unknown node.
        BagError: (a ValueError) if the bag's folder is there already.
        OSError: if the bag cannot be written.
    """
    seed = faults.seed if seed is None and faults is not None else seed
    watch = watching or Watching()
    with ExitStack() as stack:
        stack.enter_context(numpy_seeded(seed or 0))
        launched = [replace(each, env={**_SAME_EVERYWHERE, **each.env}) for each in processes(entries)]
        errors = stack.enter_context(_console(watch.log))
        run = _Run(launched, faults or FaultsDescription(), seed or 0, watch, direct)
        run.given = given
        run.host.preferred_parameters = {} if seed is None else {"seed": seed}
        stack.callback(run.host.close)
        if record:
            stack.callback(run.record(record).close)
        result = run.result(duration)
    commands = [each.name for each in entries if each.source is None]
    warnings = [f"{each} is left out: a command knows no virtual time" for each in commands]
    return msgspec.structs.replace(result, file=name, errors=len(errors), warnings=[*warnings, *result.warnings])


@contextmanager
def _console(show: Callable[[Record], object]) -> Iterator[list[Record]]:
    """Show log lines by this function in place of the console; yield a list that gets the errors among them."""
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
    """Network session of a program, with a trace, and perhaps a bag, of what it publishes."""

    def __init__(
        self, network: FaultyNetwork, program: str, trace: Trace, recording: SimulatedRecording | None
    ) -> None:
        super().__init__(network, program)
        self._trace, self._recording = trace, recording

    def advertise(self, key: str, qos: QoSProfile) -> NumberingOutlet:
        """Declare a publisher."""
        outlet = super().advertise(key, qos)
        if self._recording is not None:
            outlet = self._recording.tapped(key, qos, outlet)
        return self._trace.tapped(key, outlet)


class _Run:
    """A system in its host."""

    def __init__(
        self,
        launched: Sequence[Launched],
        faults: FaultsDescription,
        seed: int,
        watch: Watching,
        direct: Direct | None,
    ) -> None:
        self.trace, self.seed, self._watch = Trace(), seed, watch
        self.host = Host(seed=seed, connect=self._session, clock=self._clock)
        self.supervision = Supervision(
            self.host, launched, say=watch.say, direct=direct, on_added=self._add, env=_SAME_EVERYWHERE
        )
        self.injector = Injector(self.host.bus, self.host.time, self.supervision, seed=seed)
        self._launched: list[Launched] = []
        for each in launched:
            if each.members:
                self._add(each)
        self.injector.add_all(faults)
        self._interrupted = False
        self.given: Collection[str] = ()
        """Parameters that nodes are to declare."""
        self._recording: SimulatedRecording | None = None

    def _add(self, launched: Launched) -> None:
        """Note a program, also one that is added while the system runs."""
        self._launched.append(launched)
        self.injector.register(launched.name, [entry.name for entry in launched.entries])

    def record(self, path: str | Path) -> SimulatedRecording:
        """Record what is published into a bag."""
        from robolink.simulate.recording import SimulatedRecording

        recording = self._recording = SimulatedRecording(path, self.host.time.now)
        recording.nodes = self._nodes
        return recording

    def _session(self, program: str) -> FaultyTransport:
        return _Session(self.injector.network, program, self.trace, self._recording)

    def _nodes(self) -> list[Node]:
        return [node for program in self.host.programs.values() for node in program.nodes]

    def _clock(self, program: str, time: TimeBase) -> TimeBase:
        return self.injector.clock(program, time)

    def result(self, duration: float) -> SimulationResult:
        """Run it for so long, return the result until then, and end it in order."""
        begin = time.perf_counter()
        seconds = self._pass(duration)
        real_seconds = time.perf_counter() - begin
        nodes = self._nodes()
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
        if self._recording is not None:
            self._recording.close()  # what nodes say when they are ended is not a part of the run
        self.supervision.end()
        real_time = [f"{program} {what} at {place}" for program, what, place in self.host.real_time_use]
        failures = [*self.supervision.failures, *result.failures]
        return msgspec.structs.replace(result, failures=failures, real_time=real_time)

    def _pass(self, duration: float) -> float:
        """Run until the end, or until Ctrl-C; return the simulated seconds."""
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
        end, part = clock.now() + left, max(SHORTEST_PART, left // PARTS)
        while left > 0 and not self.supervision.is_over:
            clock.sleep(min(left, part))
            left = end - clock.now()
            if self._recording is not None:
                self._recording.write()
            self._watch.time(self.host.now)

    def _warnings(self, seconds: float, duration: float) -> list[str]:
        interrupted = [f"interrupted at {seconds:g} of {duration:g} s"] if self._interrupted else []
        failures = self._wrong_names()
        return [*interrupted, *(each.text for each in self.injector.unmet() if each.text not in failures)]

    def _wrong_names(self) -> list[str]:
        """Return the faults that name what was never there; none of an interrupted run, in which it might have come."""
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
