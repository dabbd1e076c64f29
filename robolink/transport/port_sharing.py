"""Port sharing: of processes with one configuration, the first listens on its ports, the others connect to it.

So one file with `listen` serves all processes of a machine, as the rendezvous port does where there is no file.
"""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Collection, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from robolink.constants import LAST_DOMAIN
from robolink.exceptions import TransportError
from robolink.networks.request import FIRST_PORT
from robolink.system import clocks
from robolink.transport.reach import address_of, as_json, host_of, mode_of, port_of, read

if TYPE_CHECKING:
    import zenoh

_STREAMS = ("tcp", "tls", "ws")
_IN_USE = {errno.EADDRINUSE} | ({errno.EACCES} if sys.platform == "win32" else set())
"""Error numbers of a port that is in use."""
LISTENS_WITHIN = 10.0
"""Time in seconds in which a process listens on the port that it has claimed; it takes a few milliseconds."""

_DELETE_ON_CLOSE: int = getattr(os, "O_TEMPORARY", 0)  # Windows has it
_ANYWHERE = {"0.0.0.0": "127.0.0.1", "::": "[::1]", "*": "127.0.0.1"}


def fixed_listeners(config: zenoh.Config) -> list[str]:
    """Return the fixed endpoints on which a peer with this configuration listens; not those of port 0."""
    if mode_of(config) != "peer":
        return []
    listed = read(config, "listen/endpoints") or ()
    return [each for each in listed if each.partition("/")[0] in _STREAMS and port_of(each) > 0]


def is_taken(endpoint: str) -> bool:
    """True if somebody listens at an endpoint of this machine already."""
    import socket  # late: it takes a node's start 3 ms, and none looks at a port

    try:
        found = socket.getaddrinfo(host_of(endpoint), port_of(endpoint), type=socket.SOCK_STREAM)
    except (OSError, UnicodeError):
        return False
    family, *_, address = found[0]
    with socket.socket(family) as probe:
        if sys.platform == "win32":  # whose SO_REUSEADDR would let the port be bound twice
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_EXCLUSIVEADDRUSE, 1)
        else:  # else connections that have ended keep it for a minute
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if family == socket.AF_INET6:
            with contextlib.suppress(OSError):
                probe.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
        try:
            probe.bind(address)  # and no more: who just looks shall keep nobody away
        except OSError as error:
            return error.errno in _IN_USE
    return False


def step_aside(config: zenoh.Config, taken: Collection[str], retry: str) -> list[str]:
    """Change a configuration to listen on free ports instead of those that are taken, and to connect to their holders.

    `retry` are the retry settings of Zenoh's endpoints. Returns the endpoints to which it will connect.
    """
    listed = read(config, "listen/endpoints")
    free = [free for each in listed for free in (_instead(each) if each in taken else [each])]
    holders = [_from_here(each) for each in taken]
    sought = [*(f"{each}#{retry}" for each in holders), *(read(config, "connect/endpoints") or ())]
    config.insert_json5("listen/endpoints", as_json(list(dict.fromkeys(free))))
    config.insert_json5("connect/endpoints", as_json(sought))
    return holders


def _instead(endpoint: str) -> list[str]:
    """Return the endpoints to listen on instead: the loopback too, since certificates name 127.0.0.1 at best."""
    address = address_of(endpoint)
    wildcard = host_of(endpoint) in _ANYWHERE
    places = [address, _from_here(endpoint)] if wildcard else [address]
    return [f"{each.rpartition(':')[0]}:0{endpoint[len(address) :]}" for each in places]


def _from_here(endpoint: str) -> str:
    """Return the address by which this machine reaches the listener of an endpoint."""
    host = host_of(endpoint)
    protocol = endpoint.partition("/")[0]
    return f"{protocol}/{_ANYWHERE.get(host, f'[{host}]' if ':' in host else host)}:{port_of(endpoint)}"


class PortClaim:
    """Claim of a port: `granted` is True if this session may listen on it.

    Zenoh sets SO_REUSEADDR, with which Windows lets two processes bind one port. So there a lock file that only one
    process can create stands for the port, and disappears with its process. Elsewhere the second bind fails.
    """

    def __init__(self, port: int, platform: str = sys.platform, folder: str | None = None) -> None:
        self._file = -1
        self.granted = platform != "win32" or self._create(port, folder)

    def _create(self, port: int, folder: str | None) -> bool:
        import tempfile  # late: it costs every node's start a few ms, and only Windows wants it
        from pathlib import Path

        self.path = Path(folder or tempfile.gettempdir()) / f"robolink-{port}.lock"
        self._open()
        if self._file < 0 and self._is_left_behind(port):
            with contextlib.suppress(OSError):
                self.path.unlink()
            self._open()
        return self._file >= 0

    def _open(self) -> None:
        with contextlib.suppress(OSError):
            self._file = os.open(self.path, os.O_CREAT | os.O_EXCL | os.O_RDWR | _DELETE_ON_CLOSE)

    def _is_left_behind(self, port: int) -> bool:
        """True if the lock has outlived its process, as after a power cut: nobody listens, and none is about to."""
        try:
            age = clocks.time_of_day() - self.path.stat().st_mtime
        except OSError:
            return False
        return not 0.0 <= age < LISTENS_WITHIN and not any(
            is_taken(f"tcp/{each}:{port}") for each in _ANYWHERE.values()
        )

    def release(self) -> None:
        """Release the port for another session. Safe to call twice."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1
            if not _DELETE_ON_CLOSE:
                self.path.unlink(missing_ok=True)


@contextmanager
def free_domain(domains: range = range(1, LAST_DOMAIN + 1)) -> Iterator[int]:
    """Reserve an unused one of some domain ids while a `with` lasts. Raises TransportError when none is free.

    A UDP socket with the number of its port is the lock, so that tests which run side by side take different ones.
    """
    import random  # late: only tests and benchmarks look for a domain
    import socket

    for domain in random.sample(domains, len(domains)):
        with socket.socket(type=socket.SOCK_DGRAM) as mark:
            try:
                mark.bind(("127.0.0.1", FIRST_PORT + domain))
            except OSError:
                continue
            if is_free(FIRST_PORT + domain):
                yield domain
                return
    raise TransportError(f"all domains from {domains[0]} to {domains[-1]} are in use on this machine")


def is_free(port: int) -> bool:
    """True if nobody listens on a port of this machine; connections that have ended do not count."""
    return not is_taken(f"tcp/127.0.0.1:{port}")
