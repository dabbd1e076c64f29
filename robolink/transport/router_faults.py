"""Faults of a router's connections: why it is not linked to a router that it was told to connect to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from robolink.networks import hosts
from robolink.transport.reach import Link, address_of, port_of

WITHIN = 1.0
"""Timeout of the answer of each of them, in seconds."""

_TRIED = "it is tried again and again"


def faults(connects: Sequence[str], own: str, links: Iterable[Link]) -> list[str]:
    """Return a line for each endpoint that has brought no link; none if all is well. It takes a second for each.

    Args:
        connects: Zenoh's endpoints to which a router connects.
        own: Its session id.
        links: Its connections.
    """
    linked = list(links)
    known: dict[str, str] = {}
    texts = ((each, _fault(each, own, linked, known)) for each in connects)
    return [f"{endpoint}: {text}" for endpoint, text in texts if text]


def _fault(endpoint: str, own: str, links: list[Link], known: dict[str, str]) -> str:
    """Return the fault of one endpoint, '' if there is none; `known` has the endpoints of the sessions met so far."""
    protocol, _, rest = address_of(endpoint).partition("/")
    host = hosts.parse(rest)
    if protocol != "tcp" or host is None:  # whose greeting cannot be read
        met = any(each.there.startswith(f"{protocol}/") and port_of(each.there) == port_of(endpoint) for each in links)
        return "" if met else f"nobody there has let this router in: is one on, with keys of this authority? {_TRIED}"
    try:
        port = hosts.seek(host, 0, WITHIN, WITHIN)
    except hosts.UnknownHostError:
        return f"no machine of this name is known; {_TRIED}"
    if port is None:
        return f"nobody answers there; {_TRIED}"
    if not port.speaks_zenoh:
        return f"what listens there does not answer as a router does; {_TRIED}"
    if port.session == own:
        return "that is this router itself: name another one's address"
    if port.session in known:
        return (
            f"is {known[port.session]} once more, by its id {port.session[:8]}: one of the two is enough; "
            "if they are two routers, give each an id of its own"
        )
    known[port.session] = endpoint
    return "" if any(each.session == port.session for each in links) else f"a {port.role} answers, but is not linked"
