"""Uses of topics, services and actions by the nodes that were inspected."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal, NamedTuple, TypeAlias

from robolink.launch.looking.look import End, Look

Kind: TypeAlias = Literal["topic", "service", "action"]

_EVERY_NODE_HAS = ("rcl_interfaces/", "type_description_interfaces/")
"""Packages whose types belong to the built-in endpoints of every node: logs, parameters, types."""

_ENDS: dict[str, tuple[Kind, str, bool]] = {
    "MP": ("topic", "publishes", True),
    "MS": ("topic", "subscribes to", False),
    "SS": ("service", "serves", True),
    "SC": ("service", "calls", False),
}
_ACTION, _GOAL, _GOAL_TYPE = "/_action/", "/_action/send_goal", "_SendGoal"


class Use(NamedTuple):
    """One node's use of one topic, service or action."""

    node: str
    kind: Kind
    name: str
    type: str
    hash: str
    verb: str
    """Kind of use: publishes, subscribes to, serves, calls."""
    offers: bool
    """True if it publishes or serves."""


def uses_of(look: Look) -> Iterator[Use]:
    """Yield the uses of a node, without the built-in endpoints; an action, which is five endpoints, once."""
    for end in look.ends:
        use = _use(end)
        if use is not None and not end.type.startswith(_EVERY_NODE_HAS):
            yield use


def _use(end: End) -> Use | None:
    kind, verb, offers = _ENDS[end.kind]
    if end.name.endswith(_GOAL):
        name, type_name = end.name.removesuffix(_GOAL), end.type.removesuffix(_GOAL_TYPE)
        return Use(end.node, "action", name, type_name, end.hash, verb, offers)
    if _ACTION in end.name:
        return None
    return Use(end.node, kind, end.name, end.type, end.hash, verb, offers)
