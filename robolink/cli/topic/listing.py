"""Listings of topics as they are announced: `robolink topic list`, `info`, `type` and `find`."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared.graph import (
    absolute,
    announced,
    bridge_data,
    bridges,
    endpoints,
    is_hidden,
    show_names,
    show_of_type,
    show_types,
    through,
)
from robolink.cli.shared.output import say, say_json, tell
from robolink.cli.shared.session import ReportedLosses, looking
from robolink.duration import Infinite
from robolink.endpoint_info import qos_lines
from robolink.exceptions import MessageError, NotFoundError, nearest
from robolink.graph.graph import names_and_types
from robolink.interfaces import is_named
from robolink.qos import QoSProfile
from robolink.system.terminal import shown
from robolink.validate_full_topic_name import validate_full_topic_name
from robolink.wire import BridgeToken, EndpointKind, EndpointToken, gid_of

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node_parts.losses import Losses

LOSSES_WITHIN = 0.3
"""Longest wait for the reports of nodes that lose messages, in seconds; there is none where nobody reports."""

End = tuple[bytes, EndpointToken]
"""Publisher or subscription, with the gid from its announcement."""

_TYPE = re.compile(r"(?:[A-Za-z]\w*[/.])?(?:msg[/.])?[A-Za-z]\w*", re.ASCII)


def list_topics(
    *, types: bool = False, count: bool = False, verbose: bool = False, hidden: bool = False, json: bool = False
) -> None:
    """List the topics that have publishers or subscriptions."""
    with looking() as context:
        found = [each for each in _ends(context) if hidden or not is_hidden(each.name)]
        stopped = _stopped(context, found) if verbose and not count else ""
    topics = names_and_types(found)
    if count or not (verbose and topics):
        show_names(dict(topics), types=types, count=count, json=json)
    elif json:
        say_json(_details(found))
    else:
        say(_section("Published", "publisher", found, EndpointKind.PUBLISHER))
        say(_section("Subscribed", "subscriber", found, EndpointKind.SUBSCRIPTION))
    if stopped:
        tell(stopped)


def _stopped(context: Context, ends: list[EndpointToken]) -> str:
    """Return a line if STOP holds."""
    from robolink.cli.shared.stop import HOLDS, stop_holds

    return HOLDS if stop_holds(context.transport, ends) else ""


def show_info(topic: str, *, verbose: bool, json: bool) -> None:
    """Show the type of a topic and its endpoints."""
    with looking() as context:
        name, found = _of_topic(context, topic)
        more = _More(_losses(context), bridges(context)) if verbose or json else _More()
    types = sorted({each.type_name for _, each in found})
    ends = {kind: [each for each in found if each[1].kind is kind] for kind in _KINDS}
    if json:
        counts = {f"{_KINDS[kind].lower()}_count": len(each) for kind, each in ends.items()}
        lists = {
            f"{_KINDS[kind].lower()}s": [_endpoint_data(*one, more) for one in each] for kind, each in ends.items()
        }
        say_json({"name": name, "types": types, **counts, **lists})
        return
    gap = "\n" if verbose else ""
    say(f"Type: {types[0] if len(types) == 1 else types}{gap}")
    for kind, each in ends.items():
        say(f"{_KINDS[kind].capitalize()} count: {len(each)}{gap}")
        for one in each if verbose else []:
            say(f"{_endpoint_text(*one, more)}\n")


def show_type(topic: str, *, json: bool) -> None:
    """Show the type of a topic: a line for each, if there are several."""
    with looking() as context:
        _, found = _of_topic(context, topic)
    show_types(sorted({each.type_name for _, each in found}), json=json)


def find_topics(type_: str, *, count: bool, hidden: bool, json: bool) -> None:
    """List the topics of a type: ``Twist``, ``geometry_msgs/Twist`` or ``geometry_msgs/msg/Twist``."""
    if _TYPE.fullmatch(type_) is None:
        raise MessageError(
            f"'{shown(type_, 80)}' is not a type name; it should look like Twist, geometry_msgs/Twist or"
            " geometry_msgs/msg/Twist"
        )
    with looking() as context:
        ends = [each for each in _ends(context) if hidden or not is_hidden(each.name)]
    show_of_type(dict(names_and_types(ends)), type_, count=count, json=json)
    if not (count or json or any(is_named(each.type_name, type_) for each in ends)):
        tell(f"no topic is of type {shown(type_)}{nearest(type_, _spellings(ends))}")


_KINDS = {EndpointKind.PUBLISHER: "Publisher", EndpointKind.SUBSCRIPTION: "Subscription"}


def _ends(context: Context) -> list[EndpointToken]:
    return endpoints(context, *_KINDS)


def _of_topic(context: Context, topic: str) -> tuple[str, list[End]]:
    """Return a topic's full name and its endpoints. Raises NotFoundError if it has none."""
    name = absolute(topic)
    validate_full_topic_name(name)
    ends = {
        text: token
        for text, token in announced(context).items()
        if isinstance(token, EndpointToken) and token.kind in _KINDS
    }
    found = sorted(((gid_of(text), each) for text, each in ends.items() if each.name == name), key=_by_node)
    if not found:
        known = {each.name for each in ends.values()}
        raise NotFoundError("topic", shown(name), known, f"domain {context.get_domain_id()}")
    return name, found


def _by_node(end: End) -> tuple[str, str, str, int, str]:
    token = end[1]
    return token.namespace, token.node_name, token.session, len(token.endpoint_id), token.endpoint_id  # 10 after 9


def _spellings(ends: list[EndpointToken]) -> set[str]:
    full = {each.type_name for each in ends}
    return full | {each.rpartition("/")[2] for each in full}


def _section(title: str, noun: str, ends: list[EndpointToken], kind: EndpointKind) -> str:
    """Return a section of `topic list -v`, with an empty line at the end; the types are those of all endpoints."""
    lines = [f"{title} topics:"]
    for name, types in names_and_types(ends):
        number = sum(each.name == name and each.kind is kind for each in ends)
        if number:
            lines.append(f" * {name} [{', '.join(types)}] {number} {noun}{'s' if number > 1 else ''}")
    return "\n".join([*lines, ""])


def _details(ends: list[EndpointToken]) -> dict[str, Any]:
    return {
        name: {
            "types": types,
            **{f"{_KINDS[kind].lower()}s": sum(e.name == name and e.kind is kind for e in ends) for kind in _KINDS},
        }
        for name, types in names_and_types(ends)
    }


def _losses(context: Context) -> dict[bytes, Losses]:
    """Return the losses of subscriptions, as far as their nodes report them."""
    with contextlib.closing(ReportedLosses(context)) as reported:
        return reported.look(LOSSES_WITHIN)


class _More(NamedTuple):
    """Facts about endpoints that robolink shows in addition to ros2's."""

    lost: Mapping[bytes, Losses] = {}
    """Losses of subscriptions, by their gids."""
    bridges: Mapping[str, BridgeToken] = {}
    """Bridges, by their sessions."""


def _endpoint_text(gid: bytes, end: EndpointToken, more: _More) -> str:
    """Return one endpoint as text, like `ros2 topic info -v`, with what it has lost and which bridge it is behind."""
    return "\n".join(
        [
            f"Node name: {end.node_name}",
            f"Node namespace: {end.namespace}",
            f"Topic type: {end.type_name}",
            f"Topic type hash: {end.type_hash}",
            f"Endpoint type: {_KINDS[end.kind].upper()}",
            f"GID: {gid.hex('.')}",
            *qos_lines(end.qos),
            *_loss_lines(more.lost.get(gid)),
            *_bridge_lines(more.bridges.get(end.session)),
        ]
    )


def _loss_lines(losses: Losses | None) -> list[str]:
    if losses is None:
        return []
    return [f"Messages lost: {losses.lost} on the way, {losses.dropped} dropped for newer ones"]


def _bridge_lines(bridge: BridgeToken | None) -> list[str]:
    return [] if bridge is None else [f"Network: {through(bridge)}"]


def _endpoint_data(gid: bytes, end: EndpointToken, more: _More) -> dict[str, Any]:
    return {
        "node_name": end.node_name,
        "node_namespace": end.namespace,
        "topic_type": end.type_name,
        "topic_type_hash": end.type_hash,
        "endpoint_type": _KINDS[end.kind].upper(),
        "gid": gid.hex("."),
        "qos_profile": _qos_data(end.qos),
        **({"messages_lost": more.lost[gid]._asdict()} if gid in more.lost else {}),
        **bridge_data(more.bridges.get(end.session)),
    }


def _qos_data(qos: QoSProfile) -> dict[str, Any]:
    """Return a QoS profile as data for JSON: policies by name, durations in seconds, null for ever."""
    policies = ("reliability", "history", "durability", "liveliness")
    spans = ("lifespan", "deadline", "liveliness_lease_duration")
    return (
        {name: getattr(qos, name).name for name in policies}
        | {"depth": qos.depth}
        | {name: None if (span := getattr(qos, name)) == Infinite else span.nanoseconds / 1e9 for name in spans}
    )
