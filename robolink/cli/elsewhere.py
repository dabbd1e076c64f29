"""Where else what a command waits for is announced: on which other domains that can be reached from here."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robolink.cli.announced import is_hidden
from robolink.exceptions import RobolinkError, nearest, shown
from robolink.wire import EndpointKind, EndpointToken, graph_pattern, parse_token

if TYPE_CHECKING:
    from robolink.context import Context

MOST = 8
"""So many other domains of this machine are joined for a look: each takes some 0.1 s."""

PORTS_WITHIN = 0.5
"""Seconds in which a rendezvous port has to answer; it takes 2 ms, and longer on a busy machine."""


def domains_with(context: Context, name: str, *kinds: EndpointKind) -> list[int]:
    """List the other domains on which a topic or service of this name has such an endpoint.

    These are the domains of the same network, where it carries several, as a router does, and those that meet on
    this machine's loopback interface. What cannot be joined is left out.
    """
    own = context.get_domain_id()
    found = set(_announced(context.transport.tokens(graph_pattern()), name, kinds))
    if context.transport.url.startswith("zenoh"):
        for domain in _met_on_this_machine(own):
            with contextlib.suppress(RobolinkError):
                found.update(_announced(_tokens_of(domain), name, kinds))
    return sorted(found - {own})


def hint(domains: list[int]) -> str:
    """Say it in words, for the end of a sentence; nothing where there are none.

    >>> hint([5])
    '; it is on domain 5: set ROS_DOMAIN_ID=5'
    """
    if not domains:
        return ""
    listed = " and ".join(map(str, domains[:MOST]))
    return f"; it is on domain {listed}: set ROS_DOMAIN_ID={domains[0]}"


def no_such_node(context: Context, name: str, service: str, known: Iterable[str]) -> str:
    """Say that there is no node of this full name: on which domains its `service` is, else which known one is near."""
    near = hint(domains_with(context, service, EndpointKind.SERVICE)) or nearest(
        name, [each for each in known if not is_hidden(each)]
    )
    return f"no node named '{shown(name)}' in domain {context.get_domain_id()}{near}"


def _announced(texts: Iterable[str], name: str, kinds: tuple[EndpointKind, ...]) -> Iterator[int]:
    for text in texts:
        with contextlib.suppress(RobolinkError):
            token = parse_token(text)
            if isinstance(token, EndpointToken) and token.kind in kinds and token.name == name:
                yield token.domain


def _met_on_this_machine(own: int) -> list[int]:
    from robolink.cli.doctor.probes import listening
    from robolink.context import LAST_DOMAIN
    from robolink.transport import network

    if not network.meets_at_port(network.wanted(None, os.environ).value, os.environ):
        return []
    ports = (network.FIRST_PORT + each for each in range(LAST_DOMAIN + 1) if each != own)
    with contextlib.suppress(OSError):
        there = listening(ports, PORTS_WITHIN)
        return [number - network.FIRST_PORT for number in sorted(there) if there[number].speaks_zenoh][:MOST]
    return []


def _tokens_of(domain: int) -> list[str]:
    from robolink.transport import connect

    session = connect("zenoh://", domain)
    try:
        return session.tokens(graph_pattern(domain))
    finally:
        session.close()
