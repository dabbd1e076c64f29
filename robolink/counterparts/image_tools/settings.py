"""Quality of service of the programs of image_tools, by their parameters."""

from __future__ import annotations

from typing import TypeVar

from robolink.counterparts.program import UsageError
from robolink.exceptions import nearest
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy

T = TypeVar("T")

RELIABILITIES = {"reliable": ReliabilityPolicy.RELIABLE, "best_effort": ReliabilityPolicy.BEST_EFFORT}
HISTORIES = {"keep_last": HistoryPolicy.KEEP_LAST, "keep_all": HistoryPolicy.KEEP_ALL}


def declared_qos(node: Node) -> QoSProfile:
    """Declare the parameters depth, reliability and history; return the profile. Raises UsageError."""
    depth = node.declare_parameter("depth", 10, described("messages that are kept", 1, 100_000)).value
    return QoSProfile(
        depth=depth,
        reliability=_chosen(node, "reliability", "reliable", RELIABILITIES),
        history=_chosen(node, "history", "keep_last", HISTORIES),
    )


def _chosen(node: Node, name: str, default: str, known: dict[str, T]) -> T:
    value = node.declare_parameter(name, default, described(" or ".join(known))).value
    if value not in known:
        raise UsageError(f"{name}: expected {' or '.join(known)}, got '{value}'{nearest(value, known)}")
    return known[value]
