"""Type mismatches: warnings of another type at the other end of a node's topic or service.

On this wire the type is a part of where messages are sent: two ends that differ in it never meet, in silence.
"""

from __future__ import annotations

from robolink.logging import get_logger
from robolink.wire import EndpointKind, EndpointToken

MOST_TOLD = 10
"""Most warnings for one topic of a node; a system in which all is wrong must not drown in them."""

_ACTS = {
    EndpointKind.PUBLISHER: "publishes it",
    EndpointKind.SUBSCRIPTION: "subscribes to it",
    EndpointKind.SERVICE: "serves it",
    EndpointKind.CLIENT: "calls it",
}
_SHOWN = len("RIHS01_") + 8


class Disagreements:
    """Warnings that one node has logged: of each other node and type one, under the name of a topic or service.

    Only the graph's followers call it: one at a time.
    """

    def __init__(self, logger_name: str) -> None:
        self._logger_name = logger_name
        self._told: dict[str, set[tuple[str, frozenset[str]]]] = {}

    def tell(self, own: EndpointToken, other: EndpointToken) -> None:
        """Log one warning about an end that will never meet this one, unless that has been done."""
        told = self._told.setdefault(own.name, set())
        pair = (other.full_node_name, frozenset((own.type_name + own.type_hash, other.type_name + other.type_hash)))
        if pair in told or len(told) >= MOST_TOLD:
            return
        told.add(pair)
        end = "" if len(told) < MOST_TOLD else " (no more of these are told)"
        get_logger(self._logger_name).warning(_explained(own, other) + end)


def _explained(own: EndpointToken, other: EndpointToken) -> str:
    same_node = (own.session, own.node_id) == (other.session, other.node_id)
    node = "it also" if same_node else other.full_node_name
    here, there = _ACTS[own.kind], _ACTS[other.kind]
    if own.type_name != other.type_name:
        return (
            f"{own.name}: this node {here} as {own.type_name}, but {node} {there} as {other.type_name}:"
            " nothing gets from one to the other; give both the same type, or one of them another name"
        )
    package = own.type_name.partition("/")[0]
    return (
        f"{own.name}: this node {here} as {own.type_name}, and so {node} {there}, but the two definitions of that"
        f" type differ ({own.type_hash[:_SHOWN]}… here, {other.type_hash[:_SHOWN]}… there): nothing gets from one"
        f" to the other; bring both to the same version of {package}"
    )
