"""Search on other domains for a topic or service that a command waits for, for a hint at ROS_DOMAIN_ID."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from robolink.cli.shared.announced import is_hidden
from robolink.exceptions import RobolinkError, nearest
from robolink.networks.asked import FIRST_PORT, wanted
from robolink.system.terminal import shown
from robolink.wire import EndpointKind, EndpointToken, graph_pattern, parse_token

if TYPE_CHECKING:
    from robolink.context import Context

MOST = 8
"""Upper bound of the other domains of this machine that are joined: each takes some 0.1 s."""

PORTS_WITHIN = 0.5
"""Timeout of a rendezvous port's answer, in seconds; it takes 2 ms, and longer on a busy machine."""


def domains_with(context: Context, name: str, *kinds: EndpointKind) -> list[int]:
    """Return the other domains on which a topic or service of this name has an endpoint of these kinds.

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
    """Return the end of a sentence that names the domains; an empty text without any.

    >>> hint([5])
    '; it is on domain 5: set ROS_DOMAIN_ID=5'
    """
    if not domains:
        return ""
    listed = " and ".join(map(str, domains[:MOST]))
    return f"; it is on domain {listed}: set ROS_DOMAIN_ID={domains[0]}"


def no_such_node(context: Context, name: str, service: str, known: Iterable[str]) -> str:
    """Return the error for a node that is not there: with the domains that have its `service`, or the nearest name."""
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
    from robolink.constants import LAST_DOMAIN
    from robolink.networks.port_probe import listening
    from robolink.transport import network

    if not network.meets_at_port(wanted(None, os.environ).value, os.environ):
        return []
    ports = (FIRST_PORT + each for each in range(LAST_DOMAIN + 1) if each != own)
    with contextlib.suppress(OSError):
        there = listening(ports, PORTS_WITHIN)
        return [number - FIRST_PORT for number in sorted(there) if there[number].speaks_zenoh][:MOST]
    return []


def _tokens_of(domain: int) -> list[str]:
    from robolink.transport import connect

    session = connect("zenoh://", domain)
    try:
        return session.tokens(graph_pattern(domain))
    finally:
        session.close()
