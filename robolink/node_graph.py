"""What a node can be asked about the graph."""

from __future__ import annotations

from robolink.context import Context
from robolink.graph import NamesAndTypes, names_and_types
from robolink.wire import EndpointKind


class NodeGraph:
    """The part of a node that looks around. Names are resolved as the node's own are."""

    _context: Context

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Give the full name of a topic."""
        raise NotImplementedError

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Give the full name of a service."""
        raise NotImplementedError

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """All topics, each with its types such as ``std_msgs/msg/String``."""
        return names_and_types(self._context.graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION))

    def get_service_names_and_types(self) -> NamesAndTypes:
        """All services, each with its types."""
        return names_and_types(self._context.graph.endpoints(EndpointKind.SERVICE))

    def get_node_names(self) -> list[str]:
        """The names of all nodes, without namespaces."""
        return [each.node_name for each in self._context.graph.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """The names of all nodes."""
        return [f"{each.namespace.rstrip('/')}/{each.node_name}" for each in self._context.graph.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Name and namespace of each node."""
        return [(each.node_name, each.namespace) for each in self._context.graph.nodes()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Name, namespace and enclave of each node."""
        return [(each.node_name, each.namespace, each.enclave) for each in self._context.graph.nodes()]

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """What a node publishes."""
        return self._by_node(node_name, node_namespace, EndpointKind.PUBLISHER)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """What a node subscribes to."""
        return self._by_node(node_name, node_namespace, EndpointKind.SUBSCRIPTION)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """What a node serves."""
        return self._by_node(node_name, node_namespace, EndpointKind.SERVICE)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Which services a node calls."""
        return self._by_node(node_name, node_namespace, EndpointKind.CLIENT)

    def _by_node(self, node_name: str, namespace: str, kind: EndpointKind) -> NamesAndTypes:
        return names_and_types(self._context.graph.of_node(node_name, namespace, kind))

    def count_publishers(self, topic_name: str) -> int:
        """How many publishers a topic has."""
        return self._context.graph.count(EndpointKind.PUBLISHER, self.resolve_topic_name(topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        """How many subscriptions a topic has."""
        return self._context.graph.count(EndpointKind.SUBSCRIPTION, self.resolve_topic_name(topic_name))

    def count_services(self, service_name: str) -> int:
        """How many servers a service has."""
        return self._context.graph.count(EndpointKind.SERVICE, self.resolve_service_name(service_name))

    def count_clients(self, service_name: str) -> int:
        """How many clients a service has."""
        return self._context.graph.count(EndpointKind.CLIENT, self.resolve_service_name(service_name))

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait until a node is there; whether so within `timeout` seconds."""
        wanted = "/" + fully_qualified_node_name.lstrip("/")
        return self._context.graph.wait_for(lambda: wanted in self.get_fully_qualified_node_names(), timeout)
