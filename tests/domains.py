"""Domains that nobody else on this machine uses now, for tests that talk over Zenoh."""

from __future__ import annotations

import os
import random
import socket
from collections.abc import Iterator
from contextlib import contextmanager

from robolink.transport.network import FIRST_PORT


@contextmanager
def free_domain() -> Iterator[int]:
    """A domain for oneself: a UDP socket on its port's number stands for it as long as this lasts."""
    for candidate in random.sample(range(1, 233), 232):
        with socket.socket(type=socket.SOCK_DGRAM) as mark, socket.socket() as probe:
            try:
                mark.bind(("127.0.0.1", FIRST_PORT + candidate))
                if os.name != "nt":  # else connections that have ended keep the port for a minute
                    probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                probe.bind(("127.0.0.1", FIRST_PORT + candidate))
            except OSError:
                continue
            probe.close()
            yield candidate
            return
    raise AssertionError("no domain is free")
