"""Fault injector for the programs of one process: on their sessions, to their clocks, and to themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.faults.description import (
    ClockFault,
    Crash,
    FaultReport,
    FaultsDescription,
    MessageFault,
    Partition,
    Unmet,
    Why,
    fits_any,
    has_pattern,
    listed,
)
from robolink.faults.network import FaultyNetwork, Scheduler, spelled
from robolink.faults.transport import FaultyTransport
from robolink.running.timebase import SkewedTime, TimeBase
from robolink.transport.memory import Bus

Fault: TypeAlias = "MessageFault | Partition | Crash | ClockFault"


class FaultError(RobolinkError, ValueError):
    """A fault that cannot happen here."""


class Programs(Protocol):
    """Protocol of what runs the programs: `robolink.host.supervision`."""

    def at(self, seconds: float, act: Callable[[], object]) -> object:
        """Call `act()` at a time of the run in seconds."""

    def crash(self, name: str, *, is_restarted: bool) -> bool:
        """End a program at once; True if it ran. If it `is_restarted`, `restart` will be called later."""

    def restart(self, name: str) -> object:
        """Start a program again."""


@dataclass
class _PlannedCrash:
    """A planned crash, and its outcome."""

    crash: Crash
    is_over: bool = False
    has_happened: bool = False

    def unmet(self) -> Unmet:
        why, reported = (
            (Why.IN_VAIN, "the node did not run then") if self.is_over else (Why.TOO_EARLY, "the run ended before")
        )
        return Unmet(f"{spelled(self.crash)} did not happen: {reported}", why)


class Injector:
    """Injector of faults into the programs of a host; its methods `connect` and `clock` are made for one.

    Args:
        bus: Network of the programs.
        time: Scheduler on the time of the run.
        programs: Runner of the programs, which crashes and restarts them.
        seed: Seed of all random numbers.
    """

    def __init__(self, bus: Bus, time: Scheduler, programs: Programs, *, seed: int = 0) -> None:
        self.network = FaultyNetwork(bus, time, seed=seed)
        self._programs = programs
        self._clocks: list[ClockFault] = []
        self._times: dict[str, tuple[list[ClockFault], TimeBase]] = {}
        self._met_clocks: list[ClockFault] = []
        self._crashes: list[_PlannedCrash] = []

    def connect(self, program: str) -> FaultyTransport:
        """Open a session for `program`."""
        return FaultyTransport(self.network, program)

    def clock(self, program: str, time: TimeBase) -> TimeBase:
        """Return a program's time: the host's, unless its clock is wrong. Several faults of a clock add up.

        A program that starts anew has the clock that it had, whose drift goes on, unless a fault was added since.

        Args:
            program: Name of the program.
            time: Time of the host.

        Raises:
            FaultError: if the clock is so far behind that it would show a time before 0.
        """
        names = self.network.programs.get(program, {program})
        wrong = [each for each in self._clocks if fits_any(listed(each.node), names)]
        self._met_clocks += wrong
        if program in self._times and self._times[program][0] == wrong:
            return self._times[program][1]
        self._times[program] = wrong, self._skewed(program, time, wrong) if wrong else time
        return self._times[program][1]

    def _skewed(self, program: str, time: TimeBase, wrong: Sequence[ClockFault]) -> TimeBase:
        ahead, drift = sum(each.offset for each in wrong), sum(each.drift for each in wrong)
        shown = SkewedTime(time, ahead=round(ahead * 1e9), drift=drift)
        if shown.now() <= 0:
            behind, now = f"{-ahead:g} s behind", f"{time.now() / 1e9:g} s"
            raise FaultError(f"the clock of {program} cannot be {behind}: it is {now} now, and no time is before 0")
        return shown

    def register(self, program: str, nodes: Iterable[str]) -> None:
        """Register the names of `nodes` by which faults may call `program`, before it has any."""
        self.network.programs.setdefault(program, {program}).update(each.lstrip("/") for each in nodes)

    def add_all(self, faults: FaultsDescription) -> None:
        """Add all `faults` of a file; its programs are to be registered before."""
        every: list[Fault] = [*faults.messages, *faults.partitions, *faults.clocks, *faults.crashes]
        for fault in every:
            self.add(fault)

    def add(self, fault: Fault) -> FaultReport | None:
        """Add one `fault`, its times those of the run; return the report of its effects if it is one of messages.

        A fault of a clock is for programs that start from now on. Raises `NotFoundError` for a crash of a node that no
        program has.
        """
        if isinstance(fault, ClockFault):
            self._clocks.append(fault)
        elif isinstance(fault, Crash):
            self._plan(fault)
        else:
            return self.network.add(fault)
        return None

    def _plan(self, crash: Crash) -> None:
        program = self.program_of(crash.node)
        planned = _PlannedCrash(crash)

        def crash_now() -> None:
            planned.is_over = True
            planned.has_happened = self._programs.crash(program, is_restarted=crash.restart_after is not None)
            if planned.has_happened and crash.restart_after is not None:
                self._programs.at(crash.at + crash.restart_after, lambda: self._programs.restart(program))

        self._crashes.append(planned)
        self._programs.at(crash.at, crash_now)

    def unmet(self) -> list[Unmet]:
        """Return the faults that had no effect so far, or that name what was never there, each with the reason."""
        crashes = [each.unmet() for each in self._crashes if not each.has_happened]
        wrong_clocks = (each for each in self._clocks if each.offset or each.drift)
        return [*self.network.unmet(), *filter(None, map(self._unmet, wrong_clocks)), *crashes]

    def _unmet(self, clock: ClockFault) -> Unmet | None:
        wrong, is_met = self.network.wrong_node(clock.node), clock in self._met_clocks
        said = f"{spelled(clock)} {'met something, but' if is_met else 'met nothing:'} "
        if wrong:
            return Unmet(said + wrong, Why.WRONG_NAME)
        vain = Unmet(said + "no such node was started with this clock", Why.IN_VAIN)
        return None if is_met else vain._replace(why=Why.WILD) if has_pattern(clock.node) else vain

    def program_of(self, node: str) -> str:
        """Return the program in which `node` runs. Raises `NotFoundError` with the nearest name."""
        expected = node.lstrip("/")
        for program, names in self.network.programs.items():
            if expected in names:
                return program
        known = sorted({name for names in self.network.programs.values() for name in names})
        raise NotFoundError("node", node, known)
