"""The graph of a domain for commands: names and types, QoS that fits, and the reason why a topic is silent."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from robolink.cli.shared.output import say, say_json, tell
from robolink.context import Context
from robolink.exceptions import RobolinkError, WireError, nearest
from robolink.graph.graph import NamesAndTypes, Token, names_and_types
from robolink.interfaces import is_named
from robolink.networks.request import FIRST_PORT, requested
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.system.terminal import shown
from robolink.wire import (
    NO_HASH,
    BridgeToken,
    EndpointKind,
    EndpointToken,
    NodeToken,
    bridge_pattern,
    graph_pattern,
    parse_bridge,
    parse_token,
)


def announced(context: Context) -> dict[str, Token]:
    """Return the tokens announced on the context's domain, each by its text on the wire.

    The number of those that cannot be parsed is written to standard error.
    """
    found, malformed = {}, 0
    for text in context.transport.tokens(graph_pattern(context.get_domain_id())):
        try:
            found[text] = parse_token(text)
        except WireError:
            malformed += 1
    if malformed:
        tell(f"robolink: {malformed} announcement{'s' if malformed > 1 else ''} could not be read")
    return found


def tokens(context: Context) -> list[Token]:
    """Return the tokens announced on the context's domain."""
    return list(announced(context).values())


def bridges(context: Context) -> dict[str, BridgeToken]:
    """Return the bridges to other networks, by their sessions: what is announced by one of these came through it."""
    found = {}
    for text in context.transport.tokens(bridge_pattern(context.get_domain_id())):
        with contextlib.suppress(WireError):
            bridge = parse_bridge(text)
            found[bridge.session] = bridge
    return found


def through(bridge: BridgeToken) -> str:
    """Return in words where what came through a bridge is.

    >>> through(BridgeToken(0, "ab", "dds", "robot"))
    'DDS, through the bridge on robot'
    """
    name = NETWORKS.get(bridge.network, bridge.network)
    return f"{name}, through the bridge on {shown(bridge.host)}"


def bridge_data(bridge: BridgeToken | None) -> dict[str, dict[str, str]]:
    """Return the same as data for JSON; nothing for what did not come through a bridge."""
    return {} if bridge is None else {"bridge": {"network": bridge.network, "host": bridge.host}}


NETWORKS = {"dds": "DDS", "zenoh": "Zenoh"}
"""Names of the networks that bridges join, as people write them."""


def nodes(context: Context) -> list[NodeToken]:
    """Return the tokens of the nodes."""
    return [token for token in tokens(context) if isinstance(token, NodeToken)]


def endpoints(context: Context, *kinds: EndpointKind) -> list[EndpointToken]:
    """Return the tokens of publishers, subscriptions, services and clients, or of some `kinds` only."""
    return [each for each in tokens(context) if isinstance(each, EndpointToken) and (not kinds or each.kind in kinds)]


def absolute(name: str) -> str:
    """Return a name with its leading slash: commands take names without it too."""
    return name if name.startswith("/") else f"/{name}"


def is_hidden(name: str) -> bool:
    """True if a part of the name begins with an underscore: such names are listed only on demand."""
    return any(part.startswith("_") for part in name.split("/"))


def sections_of(endpoints: Sequence[EndpointToken], hidden: bool) -> list[tuple[str, NamesAndTypes]]:
    """Return the six sections of `ros2 node info`: the title of each, with names and types."""
    from robolink.graph.action_names import actions

    of = {kind: names_and_types(each for each in endpoints if each.kind is kind) for kind in EndpointKind}
    titles = {
        "Subscribers": EndpointKind.SUBSCRIPTION,
        "Publishers": EndpointKind.PUBLISHER,
        "Service Servers": EndpointKind.SERVICE,
        "Service Clients": EndpointKind.CLIENT,
    }
    sections = [(title, of[kind]) for title, kind in titles.items()]
    sections += [
        ("Action Servers", actions(of[EndpointKind.SERVICE], of[EndpointKind.PUBLISHER])),
        ("Action Clients", actions(of[EndpointKind.CLIENT], of[EndpointKind.SUBSCRIPTION])),
    ]
    return [(title, [each for each in listed if hidden or not is_hidden(each[0])]) for title, listed in sections]


def show_names(found: Mapping[str, list[str]], *, types: bool = False, count: bool = False, json: bool = False) -> None:
    """Show a line for each name, with its types if requested, or how many there are."""
    if json:
        say_json(len(found) if count else found)
    elif count:
        say(str(len(found)))
    else:
        for name, known in found.items():
            say(f"{name} [{', '.join(known)}]" if types else name)


def show_types(types: list[str], *, json: bool) -> None:
    """Show the types of one name, a line for each."""
    say_json(types) if json else say("\n".join(types))


def show_of_type(found: Mapping[str, list[str]], type_: str, *, count: bool, json: bool) -> None:
    """Show the names that have a type: ``SetBool``, ``std_srvs/SetBool`` or ``std_srvs/srv/SetBool``."""
    names = [name for name, types in found.items() if any(is_named(each, type_) for each in types)]
    if json:
        say_json(len(names) if count else names)
    elif count:
        say(str(len(names)))
    elif names:
        say("\n".join(names))


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

    if not network.meets_at_port(requested(None, os.environ).value, os.environ):
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


DEEPEST = 10_000
"""Upper bound of the depth that is requested from a latched publisher, in messages."""


def matching_qos(context: Context, name: str) -> QoSProfile:
    """Return the QoS that the publishers of a topic offer: as deep as their history, if one of them is latched."""
    offered = [each.qos for each in context.graph.endpoints(EndpointKind.PUBLISHER, name=name)]
    latched = [each.depth for each in offered if each.durability is DurabilityPolicy.TRANSIENT_LOCAL]
    reliable = all(each.reliability is not ReliabilityPolicy.BEST_EFFORT for each in offered)
    return QoSProfile(
        depth=min(max([10, *latched]), DEEPEST),
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
    )


PATIENCE = 1.0
"""Time of silence until the reason is printed, in seconds."""


class Listening(NamedTuple):
    """Type and QoS that a command listens with; an empty type stands for any."""

    type_name: str = ""
    type_hash: str = ""
    qos: QoSProfile | None = None


def why_silent(context: Context, name: str, listening: Listening | None = None) -> str:
    """Return in one line why no message arrives on a topic, which is named in full."""
    listening = listening or Listening()
    publishers = context.graph.endpoints(EndpointKind.PUBLISHER, name=name)
    if not publishers:
        return _nobody(context, name)
    of_type = [each for each in publishers if listening.type_name in ("", each.type_name)]
    if not of_type:
        types = " and ".join(sorted({each.type_name for each in publishers}))
        return f"nothing will come: {name} is published as {types}, not as {listening.type_name}"
    same = [
        each for each in of_type if listening.type_hash in ("", NO_HASH, each.type_hash) or each.type_hash == NO_HASH
    ]
    if not same:
        return (
            f"nothing will come: {_names(of_type)} has another definition of {listening.type_name}"
            f" (its hash is {of_type[0].type_hash}, ours is {listening.type_hash})"
        )
    return f"waiting: {name} is published by {_names(same)}, {_what_it_sent(same, listening.qos)}"


def _what_it_sent(publishers: list[EndpointToken], qos: QoSProfile | None) -> str:
    keeps = any(each.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in publishers)
    is_late_joiner = qos is not None and qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    if keeps and is_late_joiner:
        return "which has sent nothing yet"
    if keeps:
        return (
            "which has sent nothing since this began; what it sent before was kept for those who ask for it"
            " (durability transient_local)"
        )
    if is_late_joiner:
        return "which has sent nothing since this began, and keeps nothing for late joiners (durability volatile)"
    return "which has sent nothing since this began"


def _nobody(context: Context, name: str) -> str:
    topics = sorted({each.name for each in context.graph.endpoints(EndpointKind.PUBLISHER)})
    where = f"domain {context.get_domain_id()}"
    other = hint(domains_with(context, name, EndpointKind.PUBLISHER))
    return f"waiting for a publisher of {shown(name)}: nobody publishes it on {where} yet{nearest(name, topics)}{other}"


def _names(publishers: Iterable[EndpointToken]) -> str:
    names = sorted({each.full_node_name for each in publishers})
    return names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more"
