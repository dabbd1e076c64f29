"""Has faults strike the programs of a system in this process: by the rules of the launch file that they are of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from os import PathLike
from typing import TYPE_CHECKING, cast

from robolink import logging
from robolink.faults import FaultReport, Injector, read_faults
from robolink.faults.description import ClockFault
from robolink.faults.injector import Fault
from robolink.faults.patterns import fits_any, is_pattern, listed

if TYPE_CHECKING:
    from robolink.oneprocess.host_time import HostTime
    from robolink.testing.one_process import OneProcess


class Strikes:
    """What a test's faults do on a stage: those of messages and clocks by an injector, which crashes programs by it."""

    def __init__(self, stage: OneProcess, seed: int) -> None:
        self._stage, self._host = stage, stage.host
        self._clocks: list[ClockFault] = []
        self.injector = Injector(self._host.bus, cast("HostTime", self._host.time), self, seed=seed)

    # What a test asks for

    def now(self) -> float:
        """Give the seconds of the run."""
        return self._host.now

    def add(self, fault: Fault) -> FaultReport | None:
        """Have a fault from now on."""
        if isinstance(fault, ClockFault):
            self._clocks.append(fault)
            self._tell_of_running(listed(fault.node))
        return self.injector.add(fault)

    def _tell_of_running(self, nodes: Sequence[str]) -> None:
        names = self.injector.network.programs
        for each in nodes:
            running = (name for name, program in self._host.programs.items() if program.state == "running")
            if not is_pattern(each) and any(fits_any((each,), names.get(name, ())) for name in running):
                told = f"{each} runs already: its clock is wrong once it is started anew"
                logging.get_logger("robolink.testing").warning(told)

    def tell_of_right_clock(self, program: str, node: str) -> None:
        """Warn when a clock was to be wrong, but the node's name was not known before it was made with a right one."""
        for each in self._clocks:
            if fits_any(listed(each.node), {node}) and not fits_any(listed(each.node), {program}):
                told = f"{node} has a right clock: its name was not known before; start it with name='{node}'"
                logging.get_logger("robolink.testing").warning(told)

    def read(self, path: str | PathLike[str]) -> None:
        """Have all that a file of faults says."""
        faults = read_faults(path).value
        self._clocks += faults.clocks
        self.injector.have(faults)

    def clear(self) -> None:
        """Have no faults of messages and connections any more."""
        self.injector.network.clear()

    # What the injector asks for

    def at(self, seconds: float, act: Callable[[], object]) -> None:
        """Call `act()` when the run is so old."""
        self._host.at(seconds, act)

    def crash(self, name: str, *, is_restarted: bool) -> bool:
        """End a program at once, and say whether it ran; its rules count unless the fault starts it again."""
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
