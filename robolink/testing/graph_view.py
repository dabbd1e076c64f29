"""The graph of a system under test: nodes, topics and services as they are announced, without the test's own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.testing.expectations import Ends
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.node import Node

EVERYBODYS_TOPICS = ("/parameter_events", "/rosout")
"""Topics that every node has."""
EVERYBODYS_SERVICES = ("rcl_interfaces/", "type_description_interfaces/")
"""Prefixes of the types of services that every node has."""


class GraphView:
    """The graph as one node sees it, without that node and without what every node has."""

    def __init__(self, own: Node) -> None:
        self._own, self._graph = own, own.context.graph
        self.own_name = own.get_fully_qualified_name()

    def nodes(self) -> list[str]:
        """Return the full names of all nodes, sorted."""
        return sorted({each.full_node_name for each in self._graph.nodes()} - {self.own_name})

    def topics(self) -> dict[str, str]:
        """Return the types of all topics by name; several types of one topic are separated by a comma."""
        named = {name: (self.ends(name), types) for name, types in self._own.get_topic_names_and_types()}
        return {
            name: ", ".join(types)
            for name, (ends, types) in named.items()
            if (ends.publishers or ends.subscribers) and name not in EVERYBODYS_TOPICS
        }

    def services(self) -> dict[str, str]:
        """Return the types of all services by name."""
        return {
            each.name: each.type_name
            for each in self._graph.endpoints(EndpointKind.SERVICE)
            if each.full_node_name != self.own_name and not each.type_name.startswith(EVERYBODYS_SERVICES)
        }

    def ends(self, name: str) -> Ends:
        """Return the nodes that publish a topic and those that subscribe to it."""
        publishers = self._graph.endpoints(EndpointKind.PUBLISHER, name=name)
        subscriptions = self._graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)
        return Ends(
            tuple(sorted({each.full_node_name for each in publishers} - {self.own_name})),
            tuple(sorted({each.full_node_name for each in subscriptions} - {self.own_name})),
            tuple(sorted({each.type_name for each in (*publishers, *subscriptions)})),
        )

    def heard_by_publishers_of(self, name: str) -> list[str]:
        """Return the topics to which the publishers of a topic subscribe: the inputs that it is made of."""
        publishers = set(self.ends(name).publishers)
        subscriptions = self._graph.endpoints(EndpointKind.SUBSCRIPTION)
        return sorted({each.name for each in subscriptions if each.full_node_name in publishers} - {*EVERYBODYS_TOPICS})
