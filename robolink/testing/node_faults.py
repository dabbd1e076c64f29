"""Fault injection into the programs of a system in this process, by the rules of the launch file that started them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Protocol

from robolink import logging
from robolink.faults import FaultReport, Injector, read_faults
from robolink.faults.description import ClockFault
from robolink.faults.injector import Fault
from robolink.faults.patterns import fits_any, is_pattern, listed

if TYPE_CHECKING:
    from robolink.host import Host
    from robolink.host.supervision import Supervision


class Runner(Protocol):
    """Protocol of what runs the programs in this process."""

    host: Host
    expected: set[str]
    """Names of the programs that are to end."""

    def supervision_of(self, program: str) -> Supervision | None:
        """Return the supervision of a program that a launch file started; None of another."""


class ProgramFaults:
    """The faults of a test: an injector applies those of messages and clocks, and crashes programs by this."""

    def __init__(self, stage: Runner, seed: int) -> None:
        self._stage, self._host = stage, stage.host
        self._clocks: list[ClockFault] = []
        self.injector = Injector(self._host.bus, self._host.time, self, seed=seed)

    # Called by tests

    def now(self) -> float:
        """Return the time of the run in seconds."""
        return self._host.now

    def add(self, fault: Fault) -> FaultReport | None:
        """Apply a fault from now on."""
        if isinstance(fault, ClockFault):
            self._clocks.append(fault)
            self._warn_of_running(listed(fault.node))
        return self.injector.add(fault)

    def _warn_of_running(self, nodes: Sequence[str]) -> None:
        names = self.injector.network.programs
        for each in nodes:
            running = (name for name, program in self._host.programs.items() if program.state == "running")
            if not is_pattern(each) and any(fits_any((each,), names.get(name, ())) for name in running):
                told = f"{each} runs already: its clock is wrong once it is started anew"
                logging.get_logger("robolink.testing").warning(told)

    def warn_of_right_clock(self, program: str, node: str) -> None:
        """Warn if a clock was to be wrong, but the node's name was not known before it was made with a right one."""
        for each in self._clocks:
            if fits_any(listed(each.node), {node}) and not fits_any(listed(each.node), {program}):
                told = f"{node} has a right clock: its name was not known before; start it with name='{node}'"
                logging.get_logger("robolink.testing").warning(told)

    def read(self, path: str | PathLike[str]) -> None:
        """Apply all faults of a file."""
        faults = read_faults(path).value
        self._clocks += faults.clocks
        self.injector.add_all(faults)

    def clear(self) -> None:
        """Remove all faults of messages and connections."""
        self.injector.network.clear()

    # Called by the injector

    def at(self, seconds: float, act: Callable[[], object]) -> None:
        """Call `act()` at a time of the run in seconds."""
        self._host.at(seconds, act)

    def crash(self, name: str, *, is_restarted: bool) -> bool:
        """End a program at once; True if it ran. Its rules count unless the fault starts it again."""
        runs = self._host.program(name).state == "running"
        self._stage.expected.add(name)
        supervision = self._stage.supervision_of(name)
        if supervision is None:
            self._host.crash(name)
        else:
            supervision.crash(name, is_restarted=is_restarted)
        self._stage.expected.discard(name)
        return runs

    def restart(self, name: str) -> None:
        """Start a program anew."""
        supervision = self._stage.supervision_of(name)
        (self._host if supervision is None else supervision).restart(name)
