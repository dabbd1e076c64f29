"""TCP connections that wait for their next retransmission although packets pass again, as Linux tells of them.

TCP doubles its pauses: after 15 s without an acknowledgement it is silent for another 10 s, whatever happens meanwhile.
Other systems tell nothing of it; there a link comes back when TCP tries again, or ends after Zenoh's lease.
"""

from __future__ import annotations

import contextlib
import errno
import ipaddress
import select
import socket
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

PAUSE = 2.0
"""Pause of TCP in seconds that is taken for granted: opening a session again takes as long."""

LEAST_TRIES = 3
"""Retransmissions without an answer before a connection is looked at."""

PROBE_LASTS = 1.0
"""Time in seconds after which a probe is given up: its own packet may have been lost, too."""

MOST_PROBES = 16
"""Most addresses that are probed at a time."""

_TABLES = Path("/proc/net/tcp"), Path("/proc/net/tcp6")
_ESTABLISHED, _RETRANSMITS, _TICKS = "01", "01", 100
_UNDER_WAY = 0, errno.EINPROGRESS, errno.ECONNREFUSED

Place = tuple[str, int]
"""Address and port."""


class Waiting(NamedTuple):
    """A connection that waits for its next retransmission."""

    here: Place
    there: Place
    pause: float
    """Seconds until then."""


def waiting() -> list[Waiting]:
    """Return this machine's connections that have been sent for LEAST_TRIES times in vain; none but on Linux."""
    found = []
    for table in _TABLES if sys.platform == "linux" else ():
        with contextlib.suppress(OSError, ValueError):
            found += parsed(table.read_text("ascii"))
    return found


def parsed(table: str) -> list[Waiting]:
    """Return the connections of /proc/net/tcp or tcp6 that have been sent for LEAST_TRIES times in vain."""
    found = []
    for line in table.splitlines()[1:]:
        _, here, there, state, _, timer, tries, *_ = line.split()
        kind, _, when = timer.partition(":")
        if state == _ESTABLISHED and kind == _RETRANSMITS and int(tries, 16) >= LEAST_TRIES:
            found.append(Waiting(_place(here), _place(there), int(when, 16) / _TICKS))
    return found


def _place(text: str) -> Place:
    """Return the address and port that the kernel writes, in words of this machine's order."""
    address, _, port = text.partition(":")
    words = [int(address[at : at + 8], 16).to_bytes(4, sys.byteorder) for at in range(0, len(address), 8)]
    found = ipaddress.ip_address(b"".join(words))
    mapped = found.ipv4_mapped if isinstance(found, ipaddress.IPv6Address) else None
    return str(mapped or found), int(port, 16)


class Probes:
    """Attempts to reach the other ends of connections that wait: an answer of any kind says that packets pass again."""

    def __init__(self) -> None:
        self._begun: dict[Place, tuple[socket.socket, float]] = {}

    def passes(self, stuck: Iterable[Waiting]) -> bool:
        """True if another machine answers while its connection waits for longer than PAUSE; never waits itself."""
        wanted = {each.there: each.pause for each in stuck}
        for place in [each for each in self._begun if each not in wanted]:
            self._end(place)
        for place in [*wanted][:MOST_PROBES]:
            if self._answers(place) and wanted[place] > PAUSE:
                self.close()
                return True
        return False

    def _answers(self, place: Place) -> bool:
        if place in self._begun:
            probe, begun = self._begun[place]
            if select.select([], [probe], [], 0)[1]:
                code = probe.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
                self._end(place)
                return code in (0, errno.ECONNREFUSED)
            if time.monotonic() - begun < PROBE_LASTS:
                return False
            self._end(place)
        probe = socket.socket(socket.AF_INET6 if ":" in place[0] else socket.AF_INET, socket.SOCK_STREAM)
        probe.setblocking(False)
        if probe.connect_ex(place) in _UNDER_WAY:  # else there is no way at all, as where a cable is out
            self._begun[place] = probe, time.monotonic()
        else:
            probe.close()
        return False

    def _end(self, place: Place) -> None:
        self._begun.pop(place)[0].close()

    def close(self) -> None:
        """End all attempts."""
        for place in list(self._begun):
            self._end(place)
