"""Actions in the graph, as a node sees it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.graph.graph import NamesAndTypes
    from robolink.node import BaseNode


def get_action_client_names_and_types_by_node(
    node: BaseNode, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions of which a node is a client, each with its types.

    Args:
        node: BaseNode that asks.
        remote_node_name: Name of the node in question.
        remote_node_namespace: Its namespace.

    Raises:
        NodeNameNonExistentError: (a RuntimeError) if there is no such node.
    """
    return node.get_action_client_names_and_types_by_node(remote_node_name, remote_node_namespace)


def get_action_server_names_and_types_by_node(
    node: BaseNode, remote_node_name: str, remote_node_namespace: str
) -> NamesAndTypes:
    """Return the actions that a node serves, each with its types.

    Args:
        node: BaseNode that asks.
        remote_node_name: Name of the node in question.
        remote_node_namespace: Its namespace.

    Raises:
        NodeNameNonExistentError: (a RuntimeError) if there is no such node.
    """
    return node.get_action_server_names_and_types_by_node(remote_node_name, remote_node_namespace)


def get_action_names_and_types(node: BaseNode) -> NamesAndTypes:
    """Return all actions that have a server or a client, each with its types, as `node` sees the graph."""
    return node.get_action_names_and_types()
