"""Watch of this machine's addresses and connections: a session must know when it has to be opened again.

Others find it by an address, which may change; and a connection may stand still though packets pass again.
"""

from __future__ import annotations

import contextlib
import errno
import json
import socket
import struct
import sys
import threading
import time
import weakref
from collections.abc import Collection, Iterable
from typing import TYPE_CHECKING, NamedTuple, Protocol

from robolink.system import clocks
from robolink.transport.lifetime import all_of
from robolink.transport.reach import host_of, mode_of, port_of, read

if TYPE_CHECKING:
    import zenoh

LOOKS_EVERY = 0.5
"""Interval of the looks at the addresses, in seconds; a look takes 0.1 to 0.4 ms."""

SETTLES = 0.2
"""Time in seconds after which a change is acted upon."""

_WILDCARDS = ("0.0.0.0", "::")
_watched: weakref.WeakSet[Movable] = weakref.WeakSet()
_lock = threading.Lock()
_thread: threading.Thread | None = None


class Movable(Protocol):
    """A session that can go on from other addresses."""

    def move(self, addresses: frozenset[str]) -> object:
        """Go on from these addresses, if any of them is new; must not block for long."""

    def unstick(self) -> object:
        """Go on by other connections, if some stand still though packets pass; must not block for long."""


def current() -> frozenset[str]:
    """Return this machine's IPv4 addresses but for loopback's: Zenoh's discovery uses no others."""
    import psutil  # late: only sessions that leave the machine need it

    found = (each for some in psutil.net_if_addrs().values() for each in some)
    named = (each.address for each in found if each.family == socket.AF_INET)
    return frozenset(each for each in named if not each.startswith("127."))


def watch(session: Movable) -> None:
    """Call `session.move` and `session.unstick` again and again, on a background thread, for as long as it exists."""
    global _thread
    with _lock:
        _watched.add(session)
        if _thread is None or not _thread.is_alive():
            _thread = threading.Thread(target=_look, name="robolink addresses", daemon=True)
            with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
                _thread.start()


def forget(session: Movable) -> None:
    """Watch for a session no longer."""
    _watched.discard(session)


def _look() -> None:
    global _thread
    known: frozenset[str] | None = None
    while True:
        with _lock:
            sessions = all_of(_watched)
            if not sessions:
                _thread = None
                return
        with contextlib.suppress(OSError):  # interfaces that come and go just now: the next look sees them
            now = current()
            if known is not None and now != known:
                time.sleep(SETTLES)  # routes come a little after their address, and it may be one of several
                now = current()
            known = now
            for session in sessions:
                session.move(now)
        for session in sessions:
            with contextlib.suppress(OSError):  # too many open files: the next look may have one
                session.unstick()
        del sessions  # not kept alive while this sleeps
        time.sleep(LOOKS_EVERY)


def named(config: zenoh.Config, addresses: frozenset[str]) -> zenoh.Config:
    """Name these addresses in a configuration where it listens and searches on all: Zenoh knows only the first ones.

    It reads the interfaces once for each process. Ports that are fixed stay open on all addresses.
    """
    if not addresses or mode_of(config) == "client":
        return config
    listens = [
        endpoint
        for each in read(config, "listen/endpoints") or ()
        for endpoint in (_on_each(each, addresses) if _is_everywhere(each) else [each])
    ]
    config.insert_json5("listen/endpoints", json.dumps(listens))
    if read(config, "scouting/multicast/enabled") is not False:
        config.insert_json5("scouting/multicast/interface", json.dumps(",".join(sorted(addresses))))
    return config


def _is_everywhere(endpoint: str) -> bool:
    return port_of(endpoint) == 0 and host_of(endpoint) in _WILDCARDS


def _on_each(endpoint: str, addresses: frozenset[str]) -> list[str]:
    protocol = endpoint.partition("/")[0]
    return [f"{protocol}/{each}:0" for each in ("127.0.0.1", *sorted(addresses))]


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
_DIAGNOSIS = struct.Struct("=BBxxI")  # inet_diag_req_v2: family, protocol, states
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

    TCP doubles its pauses: after 15 s without an acknowledgement it is silent for another 10 s, whatever happens
    meanwhile. Other systems tell nothing of it; there a link comes back when TCP tries again, or ends after Zenoh's
    lease.

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
    content = _DIAGNOSIS.pack(family, socket.IPPROTO_TCP, _ANY_STATE) + ports + ends + rest
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
        pauses = {each.there: each.pause for each in stuck}
        for place in [each for each in self._begun if each not in pauses]:
            self._end(place)
        for place in [*pauses][:MOST_PROBES]:
            if self._answers(place) and pauses[place] > PAUSE:
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
