"""What a node can be asked about the graph."""

from __future__ import annotations

from robolink.context import Context
from robolink.exceptions import NodeNameNonExistentError, nearest
from robolink.graph import NamesAndTypes, names_and_types
from robolink.names import join
from robolink.qos import resolved
from robolink.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from robolink.type_hash import TypeHash
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
        """All services that are served or called, each with its types."""
        return names_and_types(self._context.graph.endpoints(EndpointKind.SERVICE, EndpointKind.CLIENT))

    def get_node_names(self) -> list[str]:
        """The names of all nodes, without namespaces."""
        return [each.node_name for each in self._context.graph.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """The names of all nodes."""
        return [each.full_node_name for each in self._context.graph.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Name and namespace of each node."""
        return [(each.node_name, each.namespace) for each in self._context.graph.nodes()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Name, namespace and enclave of each node."""
        return [(each.node_name, each.namespace, each.enclave) for each in self._context.graph.nodes()]

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """What a node publishes. Raises NodeNameNonExistentError (a RuntimeError) when there is no such node."""
        return self._by_node_(node_name, node_namespace, EndpointKind.PUBLISHER)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """What a node subscribes to. Raises NodeNameNonExistentError (a RuntimeError) when there is no such node."""
        return self._by_node_(node_name, node_namespace, EndpointKind.SUBSCRIPTION)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """What a node serves. Raises NodeNameNonExistentError (a RuntimeError) when there is no such node."""
        return self._by_node_(node_name, node_namespace, EndpointKind.SERVICE)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Which services a node calls. Raises NodeNameNonExistentError (a RuntimeError) when there is no such node."""
        return self._by_node_(node_name, node_namespace, EndpointKind.CLIENT)

    def _by_node_(self, node_name: str, namespace: str, kind: EndpointKind) -> NamesAndTypes:
        graph = self._context.graph
        if not graph.has_node(node_name, namespace):
            full = join(namespace, node_name)
            raise NodeNameNonExistentError(
                f"no node named '{full}'{nearest(full, self.get_fully_qualified_node_names())}"
            )
        return names_and_types(graph.of_node(node_name, namespace, kind))

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """All publishers of a topic, each with its node, type, hash, gid and profile.

        Raises InvalidTopicNameException (a ValueError), unless `no_mangle` asks for the name as it stands.
        """
        return self._info_(topic_name, no_mangle, EndpointKind.PUBLISHER, TopicEndpointTypeEnum.PUBLISHER)

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """All subscriptions of a topic, each with its node, type, hash, gid and profile.

        Raises InvalidTopicNameException (a ValueError), unless `no_mangle` asks for the name as it stands.
        """
        return self._info_(topic_name, no_mangle, EndpointKind.SUBSCRIPTION, TopicEndpointTypeEnum.SUBSCRIPTION)

    def _info_(
        self, topic_name: str, no_mangle: bool, kind: EndpointKind, end: TopicEndpointTypeEnum
    ) -> list[TopicEndpointInfo]:
        name = topic_name if no_mangle else self.resolve_topic_name(topic_name)
        return [
            TopicEndpointInfo(
                node_name=each.node_name,
                node_namespace=each.namespace,
                topic_type=each.type_name,
                topic_type_hash=TypeHash.from_text(each.type_hash),
                endpoint_type=end,
                endpoint_gid=list(gid),
                qos_profile=resolved(each.qos),  # a copy, for the caller to change
            )
            for gid, each in self._context.graph.gids(kind, name)
        ]

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
        """Wait until a node is there; whether so within `timeout` seconds, or before the context ends if negative."""
        namespace, _, name = ("/" + fully_qualified_node_name.lstrip("/")).rpartition("/")
        graph = self._context.graph
        limit = None if timeout < 0 else timeout
        return self._context.wait_until(lambda: graph.has_node(name, namespace or "/"), limit)
