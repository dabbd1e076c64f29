"""Diagnosis of a silent topic: the reason, as the graph shows it, that waiting commands print after a second."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from robolink.cli.shared import other_domains
from robolink.context import Context
from robolink.exceptions import nearest
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.system.terminal import shown
from robolink.wire import NO_HASH, EndpointKind, EndpointToken

PATIENCE = 1.0
"""Time of silence until the reason is printed, in seconds."""


class Wanted(NamedTuple):
    """Type and QoS that a command listens with; an empty type stands for any."""

    type_name: str = ""
    type_hash: str = ""
    qos: QoSProfile | None = None


def why_silent(context: Context, name: str, wanted: Wanted | None = None) -> str:
    """Return in one line why no message arrives on a topic, which is named in full."""
    wanted = wanted or Wanted()
    publishers = context.graph.endpoints(EndpointKind.PUBLISHER, name=name)
    if not publishers:
        return _nobody(context, name)
    of_type = [each for each in publishers if wanted.type_name in ("", each.type_name)]
    if not of_type:
        types = " and ".join(sorted({each.type_name for each in publishers}))
        return f"nothing will come: {name} is published as {types}, not as {wanted.type_name}"
    same = [each for each in of_type if wanted.type_hash in ("", NO_HASH, each.type_hash) or each.type_hash == NO_HASH]
    if not same:
        return (
            f"nothing will come: {_names(of_type)} has another definition of {wanted.type_name}"
            f" (its hash is {of_type[0].type_hash}, ours is {wanted.type_hash})"
        )
    return f"waiting: {name} is published by {_names(same)}, {_what_it_sent(same, wanted.qos)}"


def _what_it_sent(publishers: list[EndpointToken], qos: QoSProfile | None) -> str:
    keeps = any(each.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in publishers)
    asked = qos is not None and qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    if keeps and asked:
        return "which has sent nothing yet"
    if keeps:
        return (
            "which has sent nothing since this began; what it sent before was kept for those who ask for it"
            " (durability transient_local)"
        )
    if asked:
        return "which has sent nothing since this began, and keeps nothing for late joiners (durability volatile)"
    return "which has sent nothing since this began"


def _nobody(context: Context, name: str) -> str:
    topics = sorted({each.name for each in context.graph.endpoints(EndpointKind.PUBLISHER)})
    where = f"domain {context.get_domain_id()}"
    other = other_domains.hint(other_domains.domains_with(context, name, EndpointKind.PUBLISHER))
    return f"waiting for a publisher of {shown(name)}: nobody publishes it on {where} yet{nearest(name, topics)}{other}"


def _names(publishers: Iterable[EndpointToken]) -> str:
    names = sorted({each.full_node_name for each in publishers})
    return names[0] if len(names) == 1 else f"{names[0]} and {len(names) - 1} more"
