"""Network of launch tests: a domain of their own on this machine's loopback, unless the user has chosen another."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from robolink.transport.port_sharing import free_domain

NETWORK = "localhost"
"""Network of the processes and of the test, unless one is asked for: this machine's loopback alone."""


@contextmanager
def own_network() -> Iterator[int]:
    """Set the environment for tests and processes within the block, and yield their domain id."""
    with ExitStack() as stack:
        text = os.environ.get("ROS_DOMAIN_ID", "")
        domain = int(text) if text.isascii() and text.isdecimal() else stack.enter_context(free_domain())
        changed = {"ROS_DOMAIN_ID": str(domain), "ROBOLINK_TRANSPORT": "zenoh"}
        changed["ROBOLINK_NETWORK"] = os.environ.get("ROBOLINK_NETWORK") or NETWORK
        before = {name: os.environ.get(name) for name in changed}
        os.environ.update(changed)
        try:
            yield domain
        finally:
            for name, value in before.items():
                if value is None:
                    os.environ.pop(name, None)
                else:
                    os.environ[name] = value
