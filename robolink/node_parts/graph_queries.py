"""Queries of the graph that a node answers: names and types of another node, endpoints of a topic or service."""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.exceptions import NodeNameNonExistentError, nearest
from robolink.graph.graph import Graph, NamesAndTypes, names_and_types
from robolink.qos import resolved
from robolink.text.names import join
from robolink.wire import EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.endpoint_info import ServiceEndpointInfo, TopicEndpointInfo


def of_node(graph: Graph, name: str, namespace: str, kind: EndpointKind) -> NamesAndTypes:
    """Return the names and types of a node's endpoints. Raises NodeNameNonExistentError if there is no such node."""
    namespace = namespace or "/"
    if not graph.has_node(name, namespace):
        full = join(namespace, name)
        known = [each.full_node_name for each in graph.nodes()]
        raise NodeNameNonExistentError(f"no node named '{full}'{nearest(full, known)}")
    return names_and_types(graph.of_node(name, namespace, kind))


def endpoints_of_topic(graph: Graph, topic: str, kind: EndpointKind) -> list[TopicEndpointInfo]:
    """Return the publishers or the subscriptions of a topic, given by its full name."""
    from robolink.endpoint_info import EndpointTypeEnum, TopicEndpointInfo  # late: few nodes ask
    from robolink.type_hash import TypeHash

    return [
        TopicEndpointInfo(
            node_name=each.node_name,
            node_namespace=each.namespace,
            topic_type=each.type_name,
            topic_type_hash=TypeHash.from_text(each.type_hash),
            endpoint_type=EndpointTypeEnum[_ENDS[kind]],
            endpoint_gid=list(gid),
            qos_profile=resolved(each.qos),  # a copy, for the caller to change
        )
        for gid, each in graph.gids(kind, topic)
    ]


def endpoints_of_service(graph: Graph, service: str, kind: EndpointKind) -> list[ServiceEndpointInfo]:
    """Return the servers or the clients of a service, given by its full name."""
    return [service_endpoint(gid, each) for gid, each in graph.gids(kind, service)]


def service_endpoint(gid: bytes, token: EndpointToken) -> ServiceEndpointInfo:
    """Return the description of a server or client."""
    from robolink.endpoint_info import EndpointTypeEnum, ServiceEndpointInfo
    from robolink.type_hash import TypeHash

    return ServiceEndpointInfo(
        node_name=token.node_name,
        node_namespace=token.namespace,
        service_type=token.type_name,
        service_type_hash=TypeHash.from_text(token.type_hash),
        qos_profiles=[resolved(token.qos)],
        endpoint_gids=[list(gid)],
        endpoint_type=EndpointTypeEnum[_ENDS[token.kind]],
        endpoint_count=1,
    )


_ENDS = {
    EndpointKind.PUBLISHER: "PUBLISHER",
    EndpointKind.SUBSCRIPTION: "SUBSCRIPTION",
    EndpointKind.CLIENT: "CLIENT",
    EndpointKind.SERVICE: "SERVER",
}
