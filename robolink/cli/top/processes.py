"""Processes of a system that run on this machine: found by the connections that their sessions have with ours.

A connection between two sessions of one machine has two ends here. Ours is known from the transport, and the process
that holds the other is known to the system, if it is the user's own. Nodes behind a router have no connection with us:
those that a launcher has started are known by name.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import psutil

from robolink.system import clocks

if TYPE_CHECKING:
    from robolink.transport.reach import Link

LOOK_AGAIN = 2.0
"""Least interval between two looks at the system's connections, in seconds: one takes some ten milliseconds."""

ANSWER_WITHIN = 0.2
"""Longest wait for a launcher's answer, in seconds."""

Ends = tuple[str, str]
"""Address and port, as `HOST:PORT`, of both ends of a connection, the holder's first."""


class Usage(NamedTuple):
    """Resource use of a process: CPU in percent of one core since the last look, None at the first; memory in bytes."""

    pid: int
    cpu: float | None
    memory: int


def sessions_here(links: Iterable[Link], holders: Mapping[Ends, int]) -> dict[str, int]:
    """Return the process id of each session that has a connection with us on this machine.

    Args:
        links: Our connections.
        holders: Process ids of the connections of this machine, by their ends.
    """
    found = {}
    for link in links:
        pid = holders.get((_place(link.there), _place(link.here)))
        if pid is not None:
            found[link.session] = pid
    return found


def _place(locator: str) -> str:
    """Return `HOST:PORT` of a locator of Zenoh's, such as `tcp/127.0.0.1:7447?rel=1`."""
    return locator.partition("/")[2].partition("?")[0].replace("[", "").replace("]", "").replace("::ffff:", "")


def holders_of_connections() -> dict[Ends, int]:
    """Return the holders of this machine's TCP connections, as far as the user may know them."""
    found: dict[Ends, int] = {}
    for each, pid in _connections():
        if pid and each.raddr:
            here, there = (f"{host}:{port}".replace("::ffff:", "") for host, port in (each.laddr, each.raddr))
            found[here, there] = pid
    return found


def _connections() -> Iterable[tuple[Any, int | None]]:
    try:
        return [(each, each.pid) for each in psutil.net_connections("tcp")]
    except psutil.Error:  # macOS lists all to root only: each process is asked, and others' refuse
        found: list[tuple[Any, int | None]] = []
        for process in psutil.process_iter():
            with contextlib.suppress(psutil.Error, OSError):
                found += [(each, process.pid) for each in process.net_connections("tcp")]
        return found


def launched_here() -> dict[str, int]:
    """Return the process ids of the nodes that launchers of this user have started, by name."""
    from robolink.supervisor.control.client import LauncherError, running

    found = {}
    for launcher in running():
        with contextlib.suppress(LauncherError):
            found.update({each.name: each.pid for each in launcher.status(ANSWER_WITHIN).nodes if each.pid})
    return found


class Processes:
    """Look-up of sessions' processes, and of what these use, from one look to the next.

    Args:
        links: Function that returns our connections.
    """

    def __init__(self, links: Callable[[], Iterable[Link]]) -> None:
        self._links = links
        self._pids: dict[str, int] = {}
        self._seen: frozenset[str] = frozenset()
        self._looked = -LOOK_AGAIN
        self._processes: dict[int, psutil.Process] = {}

    def look(self, sessions: Mapping[str, Sequence[str]]) -> dict[str, Usage]:
        """Return what the sessions of this machine use, by session.

        Args:
            sessions: Full names of the nodes of each session.
        """
        here = frozenset(sessions)
        missing, now = here - self._pids.keys(), clocks.monotonic()
        if missing and (here != self._seen or now - self._looked > LOOK_AGAIN):
            self._seen, self._looked = here, now
            self._pids = self._found(sessions)
        pids = {session: self._pids[session] for session in sessions if session in self._pids}
        used = {pid: usage for pid in set(pids.values()) if (usage := self._used(pid)) is not None}
        return {session: used[pid] for session, pid in pids.items() if pid in used}

    def _found(self, sessions: Mapping[str, Sequence[str]]) -> dict[str, int]:
        found = sessions_here(self._links(), holders_of_connections())
        launched = launched_here() if sessions.keys() - found.keys() else {}
        for session in sessions.keys() - found.keys():
            names = (name for full in sessions[session] for name in (full, full.rpartition("/")[2]))
            pid = next((launched[name] for name in names if name in launched), None)
            if pid is not None:
                found[session] = pid
        return found

    def _used(self, pid: int) -> Usage | None:
        """Return what a process uses; None if it has ended."""
        try:
            process = self._processes.get(pid)
            if process is None:
                process = self._processes[pid] = psutil.Process(pid)
                process.cpu_percent()  # counts from here on
                return Usage(pid, None, process.memory_info().rss)
            return Usage(pid, process.cpu_percent(), process.memory_info().rss)
        except (psutil.Error, OSError):
            self._processes.pop(pid, None)
            return None
