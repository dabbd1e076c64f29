"""Profiles of a player's publishers: those that were recorded, as far as one publisher can offer them."""

from __future__ import annotations

from robolink.bag.topic import BagTopic
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

DEPTH = 10
MOST_KEPT = 1000
"""Bound of the messages that a latched topic keeps for late subscriptions."""
TF_STATIC = "/tf_static"


def is_latched(topic: BagTopic) -> bool:
    """True if a publisher of the topic kept messages for late subscriptions (TRANSIENT_LOCAL).

    A bag without any profile for `/tf_static` (of ROS 1, or another writer) latched it all the same.
    """
    if not topic.offered_qos:
        return topic.name.endswith(TF_STATIC)
    return any(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in topic.offered_qos)


def kept_of(topic: BagTopic) -> int:
    """Return how many of its messages a latched topic keeps: those of all its publishers."""
    if not topic.offered_qos:
        return MOST_KEPT
    latching = [each for each in topic.offered_qos if each.durability is DurabilityPolicy.TRANSIENT_LOCAL]
    if any(each.history is HistoryPolicy.KEEP_ALL for each in latching):
        return MOST_KEPT
    return min(MOST_KEPT, sum(max(1, each.depth) for each in latching))


def offered(topic: BagTopic) -> QoSProfile:
    """Return the profile of the publisher that stands for all publishers of a recorded topic.

    It offers the most that any of them did in reliability and durability, so that whoever could hear one of them
    hears it. Deadlines and the like are kept if all offered the same.
    """
    recorded = topic.offered_qos
    durable = is_latched(topic)
    depth = kept_of(topic) if durable else max(DEPTH, *(each.depth for each in recorded)) if recorded else DEPTH
    reliable = not recorded or any(each.reliability is not ReliabilityPolicy.BEST_EFFORT for each in recorded)
    profile = QoSProfile(
        depth=min(depth, MOST_KEPT),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if durable else DurabilityPolicy.VOLATILE,
    )
    if recorded:
        first = recorded[0]
        for name in ("deadline", "lifespan", "liveliness_lease_duration"):
            if len({getattr(each, name).nanoseconds for each in recorded}) == 1:
                setattr(profile, name, getattr(first, name))
    return profile
