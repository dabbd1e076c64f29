"""Makes faults happen to the programs of one process: on their sessions, to their clocks, and to themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.faults.description import ClockFault, Crash, FaultsDescription, MessageFault, Partition
from robolink.faults.network import FaultyNetwork, Timetable, spelled
from robolink.faults.patterns import fits_any, has_pattern, listed
from robolink.faults.report import FaultReport, Unmet, Why
from robolink.faults.transport import FaultyTransport
from robolink.timebase import SkewedTime, TimeBase
from robolink.transport.memory import Bus

Fault: TypeAlias = "MessageFault | Partition | Crash | ClockFault"


class FaultError(RobolinkError, ValueError):
    """A fault that cannot happen here."""


class Programs(Protocol):
    """What runs the programs: `robolink.oneprocess.supervision`."""

    def at(self, seconds: float, act: Callable[[], object]) -> object:
        """Call `act()` when the run is so old."""

    def crash(self, name: str, *, is_restarted: bool) -> bool:
        """End a program at once, which will be asked to start again if it `is_restarted`; whether it ran."""

    def restart(self, name: str) -> object:
        """Start a program again."""


@dataclass
class _Strike:
    """A crash that is planned, and what has come of it."""

    crash: Crash
    has_come: bool = False
    has_struck: bool = False

    def unmet(self) -> Unmet:
        why, told = (
            (Why.IN_VAIN, "the node did not run then") if self.has_come else (Why.TOO_EARLY, "the run ended before")
        )
        return Unmet(f"{spelled(self.crash)} did not happen: {told}", why)


class Injector:
    """Has faults strike the programs of a host; its methods `connect` and `clock` are made for one.

    `seed` decides all that is drawn.
    """

    def __init__(self, bus: Bus, time: Timetable, programs: Programs, *, seed: int = 0) -> None:
        self.network = FaultyNetwork(bus, time, seed=seed)
        self._programs = programs
        self._clocks: list[ClockFault] = []
        self._times: dict[str, tuple[list[ClockFault], TimeBase]] = {}
        self._met_clocks: list[ClockFault] = []
        self._strikes: list[_Strike] = []

    def connect(self, program: str) -> FaultyTransport:
        """Open a program's session."""
        return FaultyTransport(self.network, program)

    def clock(self, program: str, time: TimeBase) -> TimeBase:
        """Give a program's time: the host's, unless its clock is wrong. Several faults of a clock add up.

        A program that starts anew has the clock that it had, whose drift goes on, unless a fault was added since.
        Raises `FaultError` for a clock that is so far behind that it would show a time before 0.
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

    def introduce(self, program: str, nodes: Iterable[str]) -> None:
        """Say by which nodes' names faults may call a program, before it has any."""
        self.network.programs.setdefault(program, {program}).update(each.lstrip("/") for each in nodes)

    def have(self, faults: FaultsDescription) -> None:
        """Have all that a faults file says; its programs are to be introduced before."""
        every: list[Fault] = [*faults.messages, *faults.partitions, *faults.clocks, *faults.crashes]
        for fault in every:
            self.add(fault)

    def add(self, fault: Fault) -> FaultReport | None:
        """Have one fault, its times those of the run; give what tells what it does to messages, if it is of such.

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
        planned = _Strike(crash)

        def strike() -> None:
            planned.has_come = True
            planned.has_struck = self._programs.crash(program, is_restarted=crash.restart_after is not None)
            if planned.has_struck and crash.restart_after is not None:
                self._programs.at(crash.at + crash.restart_after, lambda: self._programs.restart(program))

        self._strikes.append(planned)
        self._programs.at(crash.at, strike)

    def unmet(self) -> list[Unmet]:
        """Say of each fault that has done nothing so far, or that names what was never there, why that may be."""
        strikes = [each.unmet() for each in self._strikes if not each.has_struck]
        wrong_clocks = (each for each in self._clocks if each.offset or each.drift)
        return [*self.network.unmet(), *filter(None, map(self._unmet, wrong_clocks)), *strikes]

    def _unmet(self, clock: ClockFault) -> Unmet | None:
        wrong, is_met = self.network.wrong_node(clock.node), clock in self._met_clocks
        said = f"{spelled(clock)} {'met something, but' if is_met else 'met nothing:'} "
        if wrong:
            return Unmet(said + wrong, Why.WRONG_NAME)
        vain = Unmet(said + "no such node was started with this clock", Why.IN_VAIN)
        return None if is_met else vain._replace(why=Why.WILD) if has_pattern(clock.node) else vain

    def program_of(self, node: str) -> str:
        """Give the program in which a node runs. Raises `NotFoundError` with the nearest name."""
        wanted = node.lstrip("/")
        for program, names in self.network.programs.items():
            if wanted in names:
                return program
        known = sorted({name for names in self.network.programs.values() for name in names})
        raise NotFoundError("node", node, known)
