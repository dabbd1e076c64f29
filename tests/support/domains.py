"""Unused ROS domain ids, for tests that communicate over Zenoh or DDS."""

from __future__ import annotations

import contextlib
import random
import socket
from collections.abc import Iterator

from robolink.constants import LAST_DOMAIN
from robolink.networks.request import FIRST_PORT
from robolink.transport import port_sharing

_DOMAINS = range(102, LAST_DOMAIN + 1)
"""Those that nobody takes by hand while tests run: ROS 2 advises against them, since DDS has ports of others there."""

_DDS_DOMAINS = range(60, 80)
"""Those above 101 have ports that the system gives to others, too."""


def free_domain() -> contextlib.AbstractContextManager[int]:
    """Reserve a domain on which nobody is while a `with` lasts; not for DDS."""
    return port_sharing.free_domain(_DOMAINS)


@contextlib.contextmanager
def free_dds_domain() -> Iterator[int]:
    """Reserve a domain on which nobody is while a `with` lasts; the lock is that of `free_domain`."""
    for number in random.sample(_DDS_DOMAINS, len(_DDS_DOMAINS)):
        with contextlib.ExitStack() as stack:
            mark, probe = (stack.enter_context(socket.socket(type=socket.SOCK_DGRAM)) for _ in range(2))
            try:
                mark.bind(("127.0.0.1", FIRST_PORT + number))
                probe.bind(("", 7400 + 250 * number + 10))  # the first participant's
            except OSError:
                continue
            probe.close()
            yield number
            return
    raise RuntimeError("all domains for tests of DDS are in use")
