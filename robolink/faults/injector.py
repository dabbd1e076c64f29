"""Makes faults happen to the programs of one process: on their sessions, to their clocks, and to themselves."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Protocol, TypeAlias

from robolink.exceptions import NotFoundError
from robolink.faults.description import ClockFault, Crash, FaultsDescription, MessageFault, Partition
from robolink.faults.network import FaultyNetwork, Timetable
from robolink.faults.patterns import fits_any, listed
from robolink.faults.report import FaultReport
from robolink.faults.transport import FaultyTransport
from robolink.timebase import SkewedTime, TimeBase
from robolink.transport.memory import Bus

Fault: TypeAlias = "MessageFault | Partition | Crash | ClockFault"


class Programs(Protocol):
    """What runs the programs: `robolink.oneprocess.supervision`."""

    def at(self, seconds: float, act: Callable[[], object]) -> object:
        """Call `act()` when the run is so old."""

    def crash(self, name: str, *, is_restarted: bool) -> object:
        """End a program at once; whether it will be asked to start it again."""

    def restart(self, name: str) -> object:
        """Start a program again."""


class Injector:
    """Has faults strike the programs of a host; its methods `connect` and `clock` are made for one.

    `seed` decides all that is drawn.
    """

    def __init__(self, bus: Bus, time: Timetable, programs: Programs, *, seed: int = 0) -> None:
        self.network = FaultyNetwork(bus, time, seed=seed)
        self._programs = programs
        self._clocks: list[ClockFault] = []

    def connect(self, program: str) -> FaultyTransport:
        """Open a program's session."""
        return FaultyTransport(self.network, program)

    def clock(self, program: str, time: TimeBase) -> TimeBase:
        """Give a program's time: the host's, unless its clock is wrong. Several faults of a clock add up."""
        names = self.network.programs.get(program, {program})
        wrong = [each for each in self._clocks if fits_any(listed(each.node), names)]
        if not wrong:
            return time
        ahead, drift = sum(each.offset for each in wrong), sum(each.drift for each in wrong)
        return SkewedTime(time, ahead=round(ahead * 1e9), drift=drift)

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

        def strike() -> None:
            self._programs.crash(program, is_restarted=crash.restart_after is not None)
            if crash.restart_after is not None:
                self._programs.at(crash.at + crash.restart_after, lambda: self._programs.restart(program))

        self._programs.at(crash.at, strike)

    def program_of(self, node: str) -> str:
        """Give the program in which a node runs. Raises `NotFoundError` with the nearest name."""
        wanted = node.lstrip("/")
        for program, names in self.network.programs.items():
            if wanted in names:
                return program
        known = sorted({name for names in self.network.programs.values() for name in names})
        raise NotFoundError("node", node, known)
