"""QoS profile of a subscription that fits whatever publishers a topic has."""

from __future__ import annotations

from robolink.context import Context
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.wire import EndpointKind

MOST_KEPT = 10_000
"""Upper bound of the depth that is asked of a latched publisher, in messages."""


def matching_qos(context: Context, name: str) -> QoSProfile:
    """Return the QoS that the publishers of a topic offer: with what they kept, if one of them is latched."""
    offered = [each.qos for each in context.graph.endpoints(EndpointKind.PUBLISHER, name=name)]
    latched = [each.depth for each in offered if each.durability is DurabilityPolicy.TRANSIENT_LOCAL]
    reliable = all(each.reliability is not ReliabilityPolicy.BEST_EFFORT for each in offered)
    return QoSProfile(
        depth=min(max([10, *latched]), MOST_KEPT),
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
    )
