"""Sessions beside each other: of processes with one configuration, the first listens on its ports, the others join it.

So one file with `listen` serves all processes of a machine, as the rendezvous port does where there is no file.
"""

from __future__ import annotations

import contextlib
import errno
import json
import sys
from collections.abc import Collection
from typing import TYPE_CHECKING

from robolink.transport.reach import address_of, host_of, mode_of, port_of, read

if TYPE_CHECKING:
    import zenoh

_STREAMS = ("tcp", "tls", "ws")
_IN_USE = {errno.EADDRINUSE} | ({errno.EACCES} if sys.platform == "win32" else set())
"""What a system says of a port that is taken."""
_ANYWHERE = {"0.0.0.0": "127.0.0.1", "::": "[::1]", "*": "127.0.0.1"}


def fixed_listeners(config: zenoh.Config) -> list[str]:
    """List the endpoints on which a peer with this configuration listens and others may rely; not those of port 0."""
    if mode_of(config) != "peer":
        return []
    listed = read(config, "listen/endpoints") or ()
    return [each for each in listed if each.partition("/")[0] in _STREAMS and port_of(each) > 0]


def is_taken(endpoint: str) -> bool:
    """Return whether somebody listens there already; not so for what is no address of this machine."""
    import socket  # late: it costs every node's start 2 ms

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
    """Have a session listen on free ports instead of those that are taken, and connect to who has them.

    `retry` is what Zenoh's endpoints say of how often to try again. Gives the endpoints that it will connect to.
    """
    listed = read(config, "listen/endpoints")
    free = [free for each in listed for free in (_instead(each) if each in taken else [each])]
    holders = [_from_here(each) for each in taken]
    sought = [*(f"{each}#{retry}" for each in holders), *(read(config, "connect/endpoints") or ())]
    config.insert_json5("listen/endpoints", json.dumps(list(dict.fromkeys(free))))
    config.insert_json5("connect/endpoints", json.dumps(sought))
    return holders


def _instead(endpoint: str) -> list[str]:
    """Return where to listen instead: on the loopback too, since certificates name 127.0.0.1 at best."""
    address = address_of(endpoint)
    wildcard = host_of(endpoint) in _ANYWHERE
    places = [address, _from_here(endpoint)] if wildcard else [address]
    return [f"{each.rpartition(':')[0]}:0{endpoint[len(address) :]}" for each in places]


def _from_here(endpoint: str) -> str:
    """Return the address by which this machine reaches whoever listens at an endpoint."""
    host = host_of(endpoint)
    protocol = endpoint.partition("/")[0]
    return f"{protocol}/{_ANYWHERE.get(host, f'[{host}]' if ':' in host else host)}:{port_of(endpoint)}"
