"""Carries bytes between nodes: inside one process or over Zenoh, behind one seam."""

from __future__ import annotations

from robolink.exceptions import TransportError, nearest
from robolink.transport.base import Handle, Outlet, Query, Sample, Sink, Transport

__all__ = ["Handle", "Outlet", "Query", "Sample", "Sink", "Transport", "connect"]


def connect(url: str | Transport = "zenoh://", domain: int = 0, *, network: str | None = None) -> Transport:
    """Open a session: `memory://NAME` inside this process, `zenoh://` between processes; a Transport is given back.

    `domain` and `network` (one of `robolink.transport.network.NAMES`, a router's endpoint or a file) are Zenoh's.
    Raises TransportError, also where the settings of the environment are at fault.
    """
    if isinstance(url, Transport):
        return url
    scheme, _, name = url.partition("://")
    match scheme:
        case "memory":
            from robolink.transport.memory import MemoryTransport

            return MemoryTransport(name)
        case "zenoh" if not name:
            from robolink.transport.zenoh import ZenohTransport

            return ZenohTransport(domain, network)
    raise TransportError(
        f"no transport '{url[:200]}'{nearest(scheme[:200], ('memory', 'zenoh'))}: expected memory://NAME or zenoh://"
    )
