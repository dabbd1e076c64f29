"""Watch of this machine's addresses and connections: a session must know when it has to be opened again.

Others find it by an address, which may change; and a connection may stand still though packets pass again.
"""

from __future__ import annotations

import contextlib
import json
import socket
import threading
import time
import weakref
from typing import TYPE_CHECKING, Protocol

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
