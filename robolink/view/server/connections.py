"""Connection graph for clients: which node publishes, subscribes to and serves what, and what has changed of it."""

from __future__ import annotations

from typing import Any, NamedTuple

from robolink.graph.graph import Graph
from robolink.qos import HistoryPolicy, QoSProfile
from robolink.view.protocol import answers
from robolink.view.server.outbox import Listener
from robolink.view.sources.live import LiveSource
from robolink.wire import EndpointKind

Place = tuple[str, str]
"""Name of a topic or service, and its type."""


Ends = dict[str, str]
"""Quality of service of each node's end of a topic or service, as a text."""


class Picture(NamedTuple):
    """The graph at a moment: the nodes at each end of each topic and service, and all nodes."""

    published: dict[Place, Ends]
    subscribed: dict[Place, Ends]
    served: dict[Place, Ends]
    nodes: list[str]


NOTHING = Picture({}, {}, {}, [])


def picture_of(graph: Graph, own: str) -> Picture:
    """Return the ends and nodes of a graph; subscriptions of the node `own` are left out: it is the viewer."""
    ends: dict[EndpointKind, dict[Place, Ends]] = {kind: {} for kind in EndpointKind}
    for each in graph.endpoints(*EndpointKind):
        if each.full_node_name != own or each.kind is EndpointKind.PUBLISHER:
            ends[each.kind].setdefault((each.name, each.type_name), {})[each.full_node_name] = _text(each.qos)
    sides = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION, EndpointKind.SERVICE)
    published, subscribed, served = (
        {place: dict(sorted(of.items())) for place, of in ends[side].items()} for side in sides
    )
    nodes = sorted({each.full_node_name for each in graph.nodes()} - {own})
    return Picture(published, subscribed, served, nodes)


def _text(qos: QoSProfile) -> str:
    """Return the policies that decide who hears whom, and what late ones get, by ROS 2's names."""
    depth = "keep_all" if qos.history == HistoryPolicy.KEEP_ALL else f"depth {qos.depth or '?'}"  # DDS need not tell it
    return f"{qos.reliability.short_key} {qos.durability.short_key} {depth}"


def change(before: Picture, now: Picture, *, all_of_it: bool) -> dict[str, Any] | None:
    """Return the fields of `connectionGraphUpdate` that lead from one picture to another; None if nothing changed.

    With `all_of_it` they have the types, the nodes, and the quality of service of each end, which are robolink's own.
    """
    if before == now:
        return None
    gone = (before.published.keys() | before.subscribed.keys()) - now.published.keys() - now.subscribed.keys()
    left = {name for name, _ in now.published} | {name for name, _ in now.subscribed}
    fields: dict[str, Any] = {
        "publishedTopics": _changed(before.published, now.published, "publisherIds", all_of_it),
        "subscribedTopics": _changed(before.subscribed, now.subscribed, "subscriberIds", all_of_it),
        "advertisedServices": _changed(before.served, now.served, "providerIds", all_of_it),
        "removedTopics": sorted({name for name, _ in gone} - left),
        "removedServices": sorted({name for name, _ in before.served.keys() - now.served.keys()}),
    }
    return fields | {"nodes": now.nodes} if all_of_it else fields


def _changed(before: dict[Place, Ends], now: dict[Place, Ends], key: str, all_of_it: bool) -> list[dict[str, Any]]:
    """Return the entries that differ; one whose last node has gone stays, with none."""
    changed: dict[Place, Ends] = {place: {} for place in before if place not in now}
    changed |= {place: ends for place, ends in now.items() if before.get(place) != ends}
    return [
        {"name": name, key: list(ends)} | ({"type": kind, "qos": list(ends.values())} if all_of_it else {})
        for (name, kind), ends in changed.items()
    ]


class Connections:
    """The graph for all clients that want it.

    Args:
        system: System whose graph it is.
    """

    def __init__(self, system: LiveSource) -> None:
        self._system = system
        self._followers: dict[Listener, Picture] = {}
        system.followers.append(self._look)

    def follow(self, client: Listener) -> None:
        """Send a client the graph, and its changes from now on."""
        self._followers[client] = NOTHING
        self._tell(client, self._picture())

    def part(self, client: Listener) -> None:
        """Send a client no more of it."""
        self._followers.pop(client, None)

    def _look(self) -> None:
        if self._followers:
            picture = self._picture()
            for client in list(self._followers):
                self._tell(client, picture)

    def _picture(self) -> Picture:
        return picture_of(self._system.context.graph, self._system.node.get_fully_qualified_name())

    def _tell(self, client: Listener, picture: Picture) -> None:
        fields = change(self._followers[client], picture, all_of_it=client.is_page)
        self._followers[client] = picture
        if fields is not None:
            client.say(answers.text("connectionGraphUpdate", **fields))
