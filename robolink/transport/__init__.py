"""Transport layer: carries bytes between nodes, in memory or over Zenoh, behind one interface."""

from __future__ import annotations

import functools
import os
from collections.abc import Mapping

from robolink.exceptions import TransportError, nearest
from robolink.transport.base import Handle, Outlet, Query, Sample, Sink, Transport

__all__ = ["Handle", "Outlet", "Query", "Sample", "Sink", "Transport", "connect", "open_network", "open_zenoh"]


def connect(
    url: str | Transport = "zenoh://", domain: int = 0, *, network: str | None = None, enclave: str | None = None
) -> Transport:
    """Open a session.

    Args:
        url: `memory://NAME` inside this process, `zenoh://` between processes; a Transport is returned as it is.
        domain: ROS domain id, 0 to 232; not for memory.
        network: `localhost`, `lan`, `off`, HOST[:PORT], tls/HOST[:PORT], a name of networks.yaml or a file of Zenoh's,
            or `dds`, whatever the URL says; None asks the environment. Not for memory.
        enclave: Enclave whose keys and rights it has, where the environment asks for security; None is `/`.

    Raises:
        TransportError: if the session cannot be opened, or settings of the environment are wrong; SecurityError if
            keys or rights are missing.
    """
    if isinstance(url, Transport):
        return url
    scheme, _, name = url.partition("://")
    match scheme:
        case "memory":
            from robolink.transport.memory import MemoryTransport

            return MemoryTransport(name)
        case "zenoh" if not name:
            return open_network(domain, network, enclave=enclave)
    raise TransportError(
        f"no transport '{url[:200]}'{nearest(scheme[:200], ('memory', 'zenoh'))}: expected memory://NAME or zenoh://"
    )


def open_network(domain: int = 0, network: str | None = None, *, enclave: str | None = None) -> Transport:
    """Open a session on the requested network, of Zenoh or of another kind, as `connect` does.

    Args:
        domain: ROS domain id.
        network: As for `connect`.
        enclave: As for `connect`.

    Raises:
        TransportError: as `connect` does.
    """
    from robolink.networks.kinds import requested_kind

    kind = requested_kind(network, os.environ)
    if kind is None:
        return open_zenoh(domain, network, enclave=enclave)
    opened: Transport = kind.open(domain, os.environ, enclave)
    return opened


def open_zenoh(
    domain: int = 0,
    network: str | None = None,
    environ: Mapping[str, str] | None = None,
    *,
    enclave: str | None = None,
) -> Transport:
    """Open a session on a Zenoh network, as `connect` does: one that roams where it leaves the machine or has keys.

    Args:
        domain: ROS domain id.
        network: As for `connect`.
        environ: Environment; None is the process's own.
        enclave: As for `connect`.

    Raises:
        TransportError: as `connect` does.
    """
    from robolink.transport.zenoh import ZenohTransport

    given = dict(os.environ if environ is None else environ)
    if given.get("ROS_SECURITY_ENABLE", "false") != "false":
        from robolink.transport.secured import open_secured

        if (secured := open_secured(domain, network, given, enclave)) is not None:
            return secured
        given["ROS_SECURITY_ENABLE"] = "false"
    open_plain = functools.partial(ZenohTransport, domain, network, given)
    plain = open_plain()
    if not plain.leaves_machine:
        return plain
    from robolink.transport.roaming import RoamingTransport  # late: few sessions leave the machine

    return RoamingTransport(open_plain, domain, plain)
