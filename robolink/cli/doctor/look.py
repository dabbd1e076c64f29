"""Look at a running system from outside: lists what is announced, and measures the offsets of its clocks."""

from __future__ import annotations

import collections
import contextlib
import queue
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from robolink.cli.doctor.facts import ClockOffset, Seen
from robolink.cli.shared.stop import stop_holds
from robolink.exceptions import RobolinkError, SecurityError, WireError
from robolink.system import clocks
from robolink.system.waits import get_within
from robolink.transport import connect
from robolink.wire import (
    BridgeToken,
    DataKey,
    EndpointKind,
    EndpointToken,
    NodeToken,
    bridge_pattern,
    format_key,
    format_token,
    gid_of,
    graph_pattern,
    pack_attachment,
    parse_bridge,
    parse_token,
    unpack_attachment,
)

if TYPE_CHECKING:
    from robolink.transport.base import Transport

LIST_WITHIN = 0.6
"""Timeout until two listings of what is announced agree, in seconds."""

CLOCKS_WITHIN = 0.25
"""Timeout of the answers with the time, in seconds."""

MOST_CLOCKS = 16
"""Upper bound of the processes whose clocks are measured."""

_QUESTIONS = ("rcl_interfaces/srv/GetParameters", "type_description_interfaces/srv/GetTypeDescription")
"""Services that nearly every node has and that change nothing; asked for nothing, they answer at once."""


def look(url: str, domain: int) -> Seen:
    """Join the network, list what is announced, measure the clocks, and leave; failures are in `error`."""
    try:
        transport = connect(url, domain)
    except RobolinkError as error:
        return Seen(error=str(error))
    try:
        return _seen(transport, domain)
    except RobolinkError as error:
        return Seen(session=transport.session_id, error=str(error))
    finally:
        transport.close()


def count_nodes(domain: int) -> int | None:
    """Return the number of nodes of a domain; None if it cannot be joined."""
    try:
        transport = connect("zenoh://", domain)
    except RobolinkError:
        return None
    try:
        return sum(text.split("/")[5:6] == ["NN"] for text in transport.tokens(graph_pattern(domain)))
    except RobolinkError:
        return None
    finally:
        transport.close()


def _seen(transport: Transport, domain: int) -> Seen:
    tokens: list[NodeToken | EndpointToken] = []
    malformed: list[str] = []
    others: collections.Counter[int] = collections.Counter()
    for text in _listed(transport, domain):
        try:
            token = parse_token(text)
        except WireError:
            malformed.append(text)
            continue
        if token.domain == domain:
            tokens.append(token)
        elif isinstance(token, NodeToken):
            others[token.domain] += 1
    clocks = _clocks(transport, tokens)
    return Seen(
        transport.session_id,
        tuple(tokens),
        tuple(malformed),
        others,
        clocks,
        tuple(transport.links()),
        tuple(_bridges(transport, domain)),
        stop_holds(transport, [each for each in tokens if isinstance(each, EndpointToken)]),
    )


def _bridges(transport: Transport, domain: int) -> Iterator[BridgeToken]:
    for text in transport.tokens(bridge_pattern(domain)):
        with contextlib.suppress(WireError):
            yield parse_bridge(text)


def _listed(transport: Transport, domain: int) -> list[str]:
    """Return the announced tokens, once two listings agree: on a busy machine the first may be incomplete."""

    def listing() -> list[str]:
        # Its own domain by name: with security nobody may ask for all domains at once, which others then refuse.
        return sorted({*transport.tokens(graph_pattern()), *transport.tokens(graph_pattern(domain))})

    deadline = clocks.monotonic() + LIST_WITHIN
    found = listing()
    while clocks.monotonic() < deadline:
        before, found = found, listing()
        if found == before:
            break
    return found


def _clocks(transport: Transport, tokens: list[NodeToken | EndpointToken]) -> tuple[ClockOffset, ...]:
    """Ask one node of each process for the time, all at once: a reply carries the time at which it was sent."""
    servers = one_server_of_each(tokens)[:MOST_CLOCKS]
    answers: queue.SimpleQueue[tuple[EndpointToken, int, int, Any]] = queue.SimpleQueue()
    calls = []
    for server in servers:
        sent = clocks.now()
        key = format_key(DataKey(server.domain, server.name, server.type_name, server.type_hash))
        attachment = pack_attachment(1, sent, gid_of(format_token(server)))

        def sink(arrived: Any, server: EndpointToken = server, sent: int = sent) -> None:
            answers.put((server, sent, clocks.now(), arrived))

        with contextlib.suppress(SecurityError):  # this enclave may not ask there: that clock remains unknown
            calls.append(transport.call(key, _nothing_requested(server.type_name), attachment, sink))
    found = _answered(transport, answers, len(calls))
    for call in calls:
        call.close()
    return found


def one_server_of_each(tokens: Sequence[NodeToken | EndpointToken]) -> list[EndpointToken]:
    """Return one service of each session that can be called without any effect."""
    chosen: dict[str, EndpointToken] = {}
    for question in reversed(_QUESTIONS):
        for token in tokens:
            if isinstance(token, EndpointToken) and token.kind is EndpointKind.SERVICE and token.type_name == question:
                chosen[token.session] = token
    return list(chosen.values())


def _nothing_requested(type_name: str) -> bytes:
    from robolink.interfaces import find
    from robolink.message import encode

    return encode(find(type_name, "srv").Request())


def _answered(
    transport: Transport, answers: queue.SimpleQueue[tuple[EndpointToken, int, int, Any]], calls: int
) -> tuple[ClockOffset, ...]:
    """Collect answers until each call has ended, or the timeout."""
    found: list[ClockOffset] = []
    deadline = clocks.monotonic() + CLOCKS_WITHIN
    while calls and (left := deadline - clocks.monotonic()) > 0:
        try:
            server, sent, received, arrived = get_within(answers, left)
        except queue.Empty:
            break
        if arrived is None:
            calls -= 1
            continue
        try:
            stamp = unpack_attachment(transport.read(arrived).attachment).timestamp
        except RobolinkError:  # no reply of a ROS 2 node: it says nothing of its clock
            continue
        found.append(ClockOffset(server.full_node_name, (stamp - (sent + received) / 2) / 1e9, (received - sent) / 2e9))
    return tuple(found)
