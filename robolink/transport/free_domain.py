"""Allocation of ROS domain ids that are unused on this machine, for systems that run over Zenoh side by side."""

from __future__ import annotations

import random
import socket
from collections.abc import Iterator
from contextlib import contextmanager

from robolink.constants import LAST_DOMAIN
from robolink.exceptions import TransportError
from robolink.networks.asked import FIRST_PORT
from robolink.transport.port_sharing import is_taken


@contextmanager
def free_domain() -> Iterator[int]:
    """Reserve an unused domain id while a `with` lasts. Raises TransportError when none is free.

    A UDP socket with the number of its port is the lock, so that tests which run side by side take different ones.
    """
    for domain in random.sample(range(1, LAST_DOMAIN + 1), LAST_DOMAIN):
        with socket.socket(type=socket.SOCK_DGRAM) as mark:
            try:
                mark.bind(("127.0.0.1", FIRST_PORT + domain))
            except OSError:
                continue
            if is_free(FIRST_PORT + domain):
                yield domain
                return
    raise TransportError(f"all domains from 1 to {LAST_DOMAIN} are in use on this machine")


def is_free(port: int) -> bool:
    """True if nobody listens on a port of this machine; connections that have ended do not count."""
    return not is_taken(f"tcp/127.0.0.1:{port}")
