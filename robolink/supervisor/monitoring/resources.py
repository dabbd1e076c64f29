"""Resource monitoring: CPU and memory use of each process group."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple, TypeAlias

import psutil

from robolink.supervisor.events import Status
from robolink.supervisor.monitoring.periodic import PeriodicThread
from robolink.system import clocks

_SHOWN = 6
"""Most processes that are named in a line of figures."""
_FIRST = 2.0
"""Time from the start to the first line of figures, in seconds."""


class Usage(NamedTuple):
    """Resource use of a process group.

    `cpu` is in percent of one core since the last measurement, None at the first; `memory` is resident, in bytes:
    shared memory counts for each process. `processes` is their number.
    """

    cpu: float | None
    memory: int
    processes: int


class Taken(NamedTuple):
    """CPU time of one process since it began, in seconds, and its resident memory, in bytes."""

    seconds: float
    memory: int


Identity: TypeAlias = tuple[int, float]
"""Identity of a process: id and start time, since ids are reused."""
Look: TypeAlias = Mapping[int, Mapping[Identity, Taken]]
"""Figures of the processes of each group."""


class Meter:
    """Measures the resource use of process groups, from one `measure` to the next; costs nothing between them."""

    def __init__(
        self,
        look: Callable[[Iterable[int]], Look] | None = None,
        clock: Callable[[], float] = clocks.monotonic,
    ) -> None:
        self._look = look or look_at_groups
        self._clock = clock
        self._before: dict[Identity, float] = {}
        self._looked: float | None = None

    def measure(self, groups: Iterable[int]) -> dict[int, Usage]:
        """Return the resource use of these process groups; one that has ended is left out."""
        found, now = self._look(groups), self._clock()
        passed = None if self._looked is None else max(now - self._looked, 1e-3)
        usage = {group: self._usage(each, passed) for group, each in found.items() if each}
        self._before = {who: taken.seconds for each in found.values() for who, taken in each.items()}
        self._looked = now
        return usage

    def _usage(self, group: Mapping[Identity, Taken], passed: float | None) -> Usage:
        """Return the sum of a group; all CPU time of a process that is new counts as used since the last time."""
        worked = sum(max(0.0, taken.seconds - self._before.get(who, 0.0)) for who, taken in group.items())
        memory = sum(taken.memory for taken in group.values())
        return Usage(None if passed is None else 100 * worked / passed, memory, len(group))


def look_at_groups(groups: Iterable[int]) -> Look:
    """Return the figures of process groups; without groups (Windows), of a process and all its descendants."""
    found: dict[int, dict[Identity, Taken]] = {}
    for group, pids in _members(set(groups)).items():
        found[group] = dict(each for pid in pids if (each := _taken(pid)) is not None)
    return found


def _members(groups: set[int]) -> dict[int, list[int]]:
    """Return the process ids of each group."""
    if sys.platform == "win32":
        return {group: _family(group) for group in groups}
    members: dict[int, list[int]] = {group: [] for group in groups}
    for pid in psutil.pids():
        try:
            group = os.getpgid(pid)
        except OSError:  # it has ended, or is none of ours
            continue
        if group in members:
            members[group].append(pid)
    return members


def _family(pid: int) -> list[int]:
    try:
        return [pid, *(each.pid for each in psutil.Process(pid).children(recursive=True))]
    except psutil.Error:
        return []


def _taken(pid: int) -> tuple[Identity, Taken] | None:
    """Return the figures of one process; None if it has ended."""
    try:
        process = psutil.Process(pid)
        with process.oneshot():
            if process.status() == psutil.STATUS_ZOMBIE:
                return None
            times = process.cpu_times()
            taken = Taken(times.user + times.system, process.memory_info().rss)
            return (pid, process.create_time()), taken
    except (psutil.Error, OSError):
        return None


class Figures(PeriodicThread):
    """Periodic thread that prints the resource use of a launcher's processes: `launch FILE --top`."""

    def __init__(
        self, status: Callable[[], Sequence[Status]], say: Callable[[str], object], *, every: float = 5.0
    ) -> None:
        self._status, self._say = status, say
        self._meter = Meter()
        super().__init__("figures", every, first=min(every, _FIRST))

    def __enter__(self) -> Figures:
        self.measured()  # CPU is counted from here on
        return super().__enter__()

    def look(self) -> None:
        """Print the use since the last period."""
        self._say(line_of_figures(self.measured()))

    def measured(self) -> dict[str, Usage]:
        """Return the use of each process since the last measurement, by name."""
        return measured(self._meter, self._status())


def measured(meter: Meter, nodes: Sequence[Status]) -> dict[str, Usage]:
    """Return the use of the processes that run, by name."""
    groups = {each.name: each.pid for each in nodes if each.pid is not None}
    usage = meter.measure(groups.values())
    return {name: usage[group] for name, group in groups.items() if group in usage}


def line_of_figures(usage: Mapping[str, Usage]) -> str:
    """Format the total use, then that of each process, the busiest first, on one line.

    A line, since a table that is refreshed in its place would fight with the nodes' own lines.

    >>> line_of_figures({"talker": Usage(2.5, 46_000_000, 1)})
    '2 % of a core, 46 MB: talker 2 % 46 MB'
    """
    busiest = sorted(usage.items(), key=lambda each: (-(each[1].cpu or 0.0), -each[1].memory))
    named = [f"{name} {shown_cpu(each.cpu)} {shown_memory(each.memory)}" for name, each in busiest[:_SHOWN]]
    more = [f"{len(busiest) - _SHOWN} more"] if len(busiest) > _SHOWN else []
    cpu = sum(each.cpu or 0.0 for each in usage.values())
    memory = sum(each.memory for each in usage.values())
    return f"{shown_cpu(cpu)} of a core, {shown_memory(memory)}: {', '.join(named + more)}"


def shown_cpu(cpu: float | None) -> str:
    """Format percents of one core; a dash before they are known."""
    return "-" if cpu is None else f"{cpu:.0f} %"


def shown_memory(memory: int) -> str:
    """Format bytes as MB, or as GB from 10 GB on."""
    return f"{memory / 1e6:.0f} MB" if memory < 1e10 else f"{memory / 1e9:.1f} GB"
