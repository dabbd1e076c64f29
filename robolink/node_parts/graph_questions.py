"""Graph queries of a node: nodes, topics, services and their endpoints."""

from __future__ import annotations

from robolink.context import Context
from robolink.exceptions import NodeNameNonExistentError, nearest
from robolink.graph.graph import Graph, NamesAndTypes, names_and_types
from robolink.qos import resolved
from robolink.running.destroyable import Destroyable
from robolink.text.names import join
from robolink.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from robolink.type_hash import TypeHash
from robolink.wire import EndpointKind


class NodeGraph(Destroyable):
    """The part of a node that queries the graph. Names are resolved as the node's own are."""

    _context: Context

    @property
    def _graph_(self) -> Graph:
        """The graph as it is known now. Raises InvalidHandle once the node has been destroyed."""
        self._check_("node")
        return self._context.graph

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the fully qualified name of a `topic`; without remapping if `only_expand`."""
        raise NotImplementedError

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the fully qualified name of a `service`; without remapping if `only_expand`."""
        raise NotImplementedError

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """Return all topics, each with its types such as `std_msgs/msg/String`.

        `no_demangle` is rclpy's and changes nothing: names are not mangled on this wire.
        """
        return names_and_types(self._graph_.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION))

    def get_service_names_and_types(self) -> NamesAndTypes:
        """Return all services that are served or called, each with its types."""
        return names_and_types(self._graph_.endpoints(EndpointKind.SERVICE, EndpointKind.CLIENT))

    def get_node_names(self) -> list[str]:
        """Return the names of all nodes, without namespaces."""
        return [each.node_name for each in self._graph_.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the fully qualified names of all nodes."""
        return [each.full_node_name for each in self._graph_.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return name and namespace of each node."""
        return [(each.node_name, each.namespace) for each in self._graph_.nodes()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return name, namespace and enclave of each node."""
        return [(each.node_name, each.namespace, each.enclave) for each in self._graph_.nodes()]

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return the topics that a node publishes, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.
            no_demangle: rclpy's; changes nothing, since names are not mangled on this wire.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return self._by_node_(node_name, node_namespace, EndpointKind.PUBLISHER)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return the topics that a node subscribes to, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.
            no_demangle: rclpy's; changes nothing, since names are not mangled on this wire.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return self._by_node_(node_name, node_namespace, EndpointKind.SUBSCRIPTION)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the services that a node serves, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return self._by_node_(node_name, node_namespace, EndpointKind.SERVICE)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the services that a node calls, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return self._by_node_(node_name, node_namespace, EndpointKind.CLIENT)

    def _by_node_(self, node_name: str, namespace: str, kind: EndpointKind) -> NamesAndTypes:
        graph = self._graph_
        namespace = namespace or "/"
        if not graph.has_node(node_name, namespace):
            full = join(namespace, node_name)
            raise NodeNameNonExistentError(
                f"no node named '{full}'{nearest(full, self.get_fully_qualified_node_names())}"
            )
        return names_and_types(graph.of_node(node_name, namespace, kind))

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return all publishers of a topic, each with its node, type, hash, gid and profile.

        Args:
            topic_name: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            no_mangle: True takes the name as it stands.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
        """
        return self._info_(topic_name, no_mangle, EndpointKind.PUBLISHER, TopicEndpointTypeEnum.PUBLISHER)

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return all subscriptions of a topic, each with its node, type, hash, gid and profile.

        Args:
            topic_name: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            no_mangle: True takes the name as it stands.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
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
            for gid, each in self._graph_.gids(kind, name)
        ]

    def count_publishers(self, topic_name: str) -> int:
        """Return the number of publishers of the topic `topic_name`, of any type."""
        return self._graph_.count(EndpointKind.PUBLISHER, self.resolve_topic_name(topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        """Return the number of subscriptions of the topic `topic_name`, of any type."""
        return self._graph_.count(EndpointKind.SUBSCRIPTION, self.resolve_topic_name(topic_name))

    def count_services(self, service_name: str) -> int:
        """Return the number of servers of the service `service_name`, of any type."""
        return self._graph_.count(EndpointKind.SERVICE, self.resolve_service_name(service_name))

    def count_clients(self, service_name: str) -> int:
        """Return the number of clients of the service `service_name`, of any type."""
        return self._graph_.count(EndpointKind.CLIENT, self.resolve_service_name(service_name))

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait until a node is in the graph, or the context ends.

        Args:
            fully_qualified_node_name: Namespace and name of the node; a missing leading slash is added.
            timeout: Longest wait in seconds; negative waits for ever, 0 does not wait.

        Returns:
            True if the node is there.
        """
        namespace, _, name = ("/" + fully_qualified_node_name.lstrip("/")).rpartition("/")
        graph = self._graph_
        limit = None if timeout < 0 else timeout
        return self._context.wait_until(lambda: graph.has_node(name, namespace or "/"), limit)
