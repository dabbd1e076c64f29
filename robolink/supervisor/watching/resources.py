"""What processes use of the machine: CPU and memory, of each process group together."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple, TypeAlias

import psutil

from robolink.supervisor.events import Status
from robolink.supervisor.watching.repeating import Repeating

_SHOWN = 6
"""So many processes are named in a line of figures."""
_FIRST = 2.0
"""Seconds from the start to the first line of figures."""


class Usage(NamedTuple):
    """What a process group uses.

    `cpu` is in percent of one core since the look before, or None at the first; `memory` is in bytes, resident: what
    processes share counts for each. `processes` is how many there are.
    """

    cpu: float | None
    memory: int
    processes: int


class Taken(NamedTuple):
    """What one process has used of a processor since it began, in seconds, and has of the memory, in bytes."""

    seconds: float
    memory: int


Identity: TypeAlias = tuple[int, float]
"""A process's number and when it began: numbers are used again."""
Look: TypeAlias = Mapping[int, Mapping[Identity, Taken]]
"""What the processes of each group have taken."""


class Meter:
    """Tells what each group uses, from one `measure` to the next; costs nothing between them."""

    def __init__(
        self,
        look: Callable[[Iterable[int]], Look] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._look = look or look_at_groups
        self._clock = clock
        self._before: dict[Identity, float] = {}
        self._looked: float | None = None

    def measure(self, groups: Iterable[int]) -> dict[int, Usage]:
        """Give what these process groups use; one that has ended is left out."""
        found, now = self._look(groups), self._clock()
        passed = None if self._looked is None else max(now - self._looked, 1e-3)
        usage = {group: self._usage(each, passed) for group, each in found.items() if each}
        self._before = {who: taken.seconds for each in found.values() for who, taken in each.items()}
        self._looked = now
        return usage

    def _usage(self, group: Mapping[Identity, Taken], passed: float | None) -> Usage:
        """Put a group together; a process that was not there before has done all of its work since."""
        worked = sum(max(0.0, taken.seconds - self._before.get(who, 0.0)) for who, taken in group.items())
        memory = sum(taken.memory for taken in group.values())
        return Usage(None if passed is None else 100 * worked / passed, memory, len(group))


def look_at_groups(groups: Iterable[int]) -> Look:
    """Look at the processes of groups; where there are no groups (Windows), at a process and all that it started."""
    found: dict[int, dict[Identity, Taken]] = {}
    for group, pids in _members(set(groups)).items():
        found[group] = dict(each for pid in pids if (each := _taken(pid)) is not None)
    return found


def _members(groups: set[int]) -> dict[int, list[int]]:
    """Give the processes of each group."""
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
    """Ask for one process; None when it has ended."""
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


class Figures(Repeating):
    """Says every so many seconds, inside a `with`, what the processes of a launcher use: for `launch FILE --top`."""

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
        """Say what all use since the look before."""
        self._say(line_of_figures(self.measured()))

    def measured(self) -> dict[str, Usage]:
        """Give what each process uses since the look before, by name."""
        return measured(self._meter, self._status())


def measured(meter: Meter, nodes: Sequence[Status]) -> dict[str, Usage]:
    """Give what the processes that run use, by name."""
    groups = {each.name: each.pid for each in nodes if each.pid is not None}
    usage = meter.measure(groups.values())
    return {name: usage[group] for name, group in groups.items() if group in usage}


def line_of_figures(usage: Mapping[str, Usage]) -> str:
    """Write what all use, then each, the busiest first, as far as a line goes.

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
    """Write percents of one core; a dash before they are known."""
    return "-" if cpu is None else f"{cpu:.0f} %"


def shown_memory(memory: int) -> str:
    """Write bytes as MB, or GB from 10 on."""
    return f"{memory / 1e6:.0f} MB" if memory < 1e10 else f"{memory / 1e9:.1f} GB"
