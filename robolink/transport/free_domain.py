"""Domains that nobody else on this machine uses now, for systems that talk over Zenoh beside others."""

from __future__ import annotations

import os
import random
import socket
from collections.abc import Iterator
from contextlib import contextmanager

from robolink.exceptions import TransportError
from robolink.transport.network import FIRST_PORT

HIGHEST = 232


@contextmanager
def free_domain() -> Iterator[int]:
    """Give a domain for oneself for as long as a `with` lasts. Raises TransportError when none is free.

    A UDP socket on the number of its port stands for it, so that tests which run side by side take different ones.
    """
    for domain in random.sample(range(1, HIGHEST + 1), HIGHEST):
        with socket.socket(type=socket.SOCK_DGRAM) as mark:
            try:
                mark.bind(("127.0.0.1", FIRST_PORT + domain))
            except OSError:
                continue
            if is_free(FIRST_PORT + domain):
                yield domain
                return
    raise TransportError(f"all domains from 1 to {HIGHEST} are in use on this machine")


def is_free(port: int) -> bool:
    """Whether nobody listens on a port of this machine; connections that have ended do not count."""
    with socket.socket() as probe:
        if os.name != "nt":  # there it would let two listen
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except OSError:
            return False
        return True
