"""TCP connections that wait for their next retransmission although packets pass again, as Linux tells of them.

TCP doubles its pauses: after 15 s without an acknowledgement it is silent for another 10 s, whatever happens meanwhile.
Other systems tell nothing of it; there a link comes back when TCP tries again, or ends after Zenoh's lease.
"""

from __future__ import annotations

import errno
import socket
import struct
import sys
from collections.abc import Collection, Iterable
from typing import NamedTuple

from robolink.system import clocks

PAUSE = 2.0
"""Pause of TCP in seconds that is taken for granted: opening a session again takes as long."""

LEAST_TRIES = 3
"""Retransmissions without an answer before a connection is looked at."""

PROBE_LASTS = 1.0
"""Time in seconds after which a probe is given up: its own packet may have been lost, too."""

MOST_PROBES = 16
"""Most addresses that are probed at a time."""

ANSWERS_WITHIN = 0.1
"""Timeout of a question to the kernel in seconds."""

LONGEST_ANSWER = 4096
"""Size in bytes of the kernel's longest answer to one question."""

_SOCK_DIAG, _BY_FAMILY, _IS_REQUEST = 4, 20, 1  # netlink's protocol, type of message and flag
_ANY_STATE, _ANY_COOKIE = 0xFFFFFFFF, 0xFFFFFFFF
_HEADER = struct.Struct("=IHHII")  # nlmsghdr: length, type, flags, number, port
_WANTED = struct.Struct("=BBxxI")  # inet_diag_req_v2: family, protocol, states
_FOUND = struct.Struct("=BBBB48xI")  # inet_diag_msg: family, state, timer, retransmissions; milliseconds left
_ESTABLISHED, _RETRANSMITS, _PROBES = 1, 1, 4
_UNDER_WAY = 0, errno.EINPROGRESS, errno.ECONNREFUSED
_WAITS = errno.EINPROGRESS, errno.EALREADY
_ANSWERED = 0, errno.EISCONN, errno.ECONNREFUSED

Place = tuple[str, int]
"""Address and port."""


class Waiting(NamedTuple):
    """A connection that waits for its next retransmission."""

    here: Place
    there: Place
    pause: float
    """Seconds until then."""


def waiting(connections: Collection[tuple[Place, Place]]) -> list[Waiting]:
    """Return those of this machine's connections that have been sent for LEAST_TRIES times in vain; none but on Linux.

    The kernel finds each by its two ends, in some 10 us; its whole table in /proc/net/tcp takes it milliseconds.
    """
    if sys.platform != "linux" or not connections:
        return []
    try:
        kernel = socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, _SOCK_DIAG)
    except OSError:  # a container may refuse it
        return []
    with kernel:
        kernel.settimeout(ANSWERS_WITHIN)
        pauses = [(here, there, _pause(kernel, here, there)) for here, there in connections]
    return [Waiting(here, there, pause) for here, there, pause in pauses if pause is not None]


def _pause(kernel: socket.socket, here: Place, there: Place) -> float | None:
    try:
        kernel.send(question(here, there))
        return pause_of(kernel.recv(LONGEST_ANSWER))
    except OSError:  # no address, or it is not told
        return None


def question(here: Place, there: Place) -> bytes:
    """Return netlink's question for one connection."""
    family = socket.AF_INET6 if ":" in here[0] else socket.AF_INET
    ends = b"".join(socket.inet_pton(family, each[0]).ljust(16, b"\0") for each in (here, there))
    ports, rest = struct.pack("!HH", here[1], there[1]), struct.pack("=III", 0, _ANY_COOKIE, _ANY_COOKIE)
    content = _WANTED.pack(family, socket.IPPROTO_TCP, _ANY_STATE) + ports + ends + rest
    return _HEADER.pack(_HEADER.size + len(content), _BY_FAMILY, _IS_REQUEST, 0, 0) + content


def pause_of(answer: bytes) -> float | None:
    """Return the seconds until the next retransmission or probe by netlink's answer; None before LEAST_TRIES."""
    if len(answer) < _HEADER.size + _FOUND.size or _HEADER.unpack_from(answer)[1] != _BY_FAMILY:
        return None
    _, state, timer, tries, left = _FOUND.unpack_from(answer, _HEADER.size)
    # Who stands still answers probes of its full window. Unanswered ones are lost: nothing was under way that could be
    # sent again, as when the cable is out of this machine.
    waits = state == _ESTABLISHED and timer in (_RETRANSMITS, _PROBES) and tries >= LEAST_TRIES
    return left / 1000 if waits else None


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
            code = probe.connect_ex(place)  # not select, which knows no more than 1024 open files
            if code in _WAITS and clocks.monotonic() - begun < PROBE_LASTS:
                return False
            self._end(place)
            if code not in _WAITS:
                return code in _ANSWERED
        probe = socket.socket(socket.AF_INET6 if ":" in place[0] else socket.AF_INET, socket.SOCK_STREAM)
        probe.setblocking(False)
        if probe.connect_ex(place) in _UNDER_WAY:  # else there is no way at all, as where a cable is out
            self._begun[place] = probe, clocks.monotonic()
        else:
            probe.close()
        return False

    def _end(self, place: Place) -> None:
        self._begun.pop(place)[0].close()

    def close(self) -> None:
        """End all attempts."""
        for place in list(self._begun):
            self._end(place)
